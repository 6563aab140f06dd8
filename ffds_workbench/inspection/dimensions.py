# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances, diameters, angles, thickness, gap and flush of as-built features."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..errors import InputError
from ..registration.arrays import Array
from .features import InspectedFeature
from .fits import fit_circle, fit_cylinder, fit_line, fit_plane

Evaluate = Callable[[Sequence[Array]], Array]
"""Points of the features to (3,): the value, its lowest and its highest local one."""
_MOST_THIN = 400


@dataclass(frozen=True)
class DimensionValue:
    """A dimension in mm or degrees: its value and the lowest and highest local one, (3,), and changes (d, 3) of all
    with errors."""

    values: Array
    draws: Array


def dimension_value(kind: str, features: Sequence[InspectedFeature], count: int, random: np.random.Generator
                    ) -> DimensionValue:
    """A dimension of one or two features.

    Parameters
    ----------
    kind : of `plan.DIMENSIONS`
    features : as-built
    count : draws of the errors
    random : for them

    Raises
    ------
    InputError : the dimension is none of such features
    """
    values = _evaluator(kind, features)([feature.points for feature in features])
    thin = [feature.thinned(_MOST_THIN) for feature in features]
    evaluate = _evaluator(kind, thin)
    plain = evaluate([feature.points for feature in thin])
    if not any(feature.errors.sigma.any() for feature in thin):
        return DimensionValue(values, np.zeros((count, 3)))
    drawn = [feature.points + feature.errors.draws(count, random) for feature in thin]
    moved = np.stack([evaluate([points[number] for points in drawn]) for number in range(count)])
    return DimensionValue(values, moved - plain)


def nominal_dimension(kind: str, features: Sequence[InspectedFeature], nominal: Sequence[Array]) -> float:
    """The same of the nominal points of the features."""
    return float(_evaluator(kind, features)(nominal)[0])


def _evaluator(kind: str, features: Sequence[InspectedFeature]) -> Evaluate:
    if kind == "diameter":
        return _diameter(features[0])
    if kind == "distance":
        return _distance(*features)
    if kind == "angle":
        return _angle(*features)
    if kind == "thickness":
        return _thickness(*features)
    return _gap(kind, *features)


def _diameter(feature: InspectedFeature) -> Evaluate:
    if feature.kind not in ("cylinder", "circle"):
        raise InputError(f"{feature.name} is a {feature.kind}: a diameter is of a cylinder or a circle.")

    def evaluate(points: Sequence[Array]) -> Array:
        if feature.kind == "cylinder":
            return np.full(3, 2.0 * fit_cylinder(points[0][: feature.even], feature.axis)[2])
        return np.full(3, 2.0 * fit_circle(points[0][: feature.even], feature.axis)[1])

    return evaluate


def _located(feature: InspectedFeature, points: Array) -> tuple[Array, Array]:
    """A point and the direction of a feature: the normal of a plane, an axis, or the direction of a line."""
    points = points[: feature.even]
    if feature.kind == "plane":
        return fit_plane(points, feature.axis)
    if feature.kind == "cylinder":
        middle, direction, _ = fit_cylinder(points, feature.axis)
        return middle, direction
    if feature.kind == "circle":
        return fit_circle(points, feature.axis)[0], feature.axis
    if feature.kind == "line":
        return fit_line(points, feature.axis)
    raise InputError(f"{feature.name} is a {feature.kind}: it has neither a place nor a direction; use a plane, a "
                     f"cylinder, a straight edge or a circle.")


def _distance(first: InspectedFeature, second: InspectedFeature) -> Evaluate:
    planes = [feature for feature in (first, second) if feature.kind == "plane"]

    def evaluate(points: Sequence[Array]) -> Array:
        (a, along), (b, other) = (_located(feature, own) for feature, own in zip((first, second), points, strict=True))
        between = b - a
        if planes:
            value = abs(float(between @ (along if first.kind == "plane" else other)))
        elif "circle" in (first.kind, second.kind):
            value = float(np.linalg.norm(between))
        else:
            value = float(np.linalg.norm(between - (between @ along) * along))
        return np.full(3, value)

    return evaluate


def _angle(first: InspectedFeature, second: InspectedFeature) -> Evaluate:
    mixed = (first.kind == "plane") != (second.kind == "plane")

    def evaluate(points: Sequence[Array]) -> Array:
        one, two = (_located(feature, own)[1] for feature, own in zip((first, second), points, strict=True))
        if mixed:  # of a line and a plane, the angle between them and not the one to the normal
            return np.full(3, float(np.degrees(np.arcsin(min(1.0, abs(float(one @ two)))))))
        return np.full(3, float(np.degrees(np.arctan2(np.linalg.norm(np.cross(one, two)), one @ two))))

    return evaluate


def _thickness(first: InspectedFeature, second: InspectedFeature) -> Evaluate:
    """Distances of the points of one face from the other one, along the latter's tangent planes at its nearest points.

    Only points that lie over the other face count: those that see it within a step of its points along it.
    """
    for feature in (first, second):
        if feature.is_edge:
            raise InputError(f"{feature.name} is an edge: a thickness is between two faces.")

    def evaluate(points: Sequence[Array]) -> Array:
        one, two = points
        tree = cKDTree(two)
        assert second.heights is not None
        normals = second.heights(two)[1]
        distance, nearest = tree.query(one)
        height = np.abs(np.einsum("nx,nx->n", one - two[nearest], normals[nearest]))
        along = np.sqrt(np.maximum(distance**2 - height**2, 0.0))
        spacing = np.median(tree.query(two, 2)[0][:, 1])
        over = along <= 2.0 * spacing
        if not over.any():
            raise InputError(f"{first.name} and {second.name} do not lie over each other: there is no thickness.")
        return np.array([height[over].mean(), height[over].min(), height[over].max()])

    return evaluate


def _gap(kind: str, first: InspectedFeature, second: InspectedFeature) -> Evaluate:
    """From the points of an edge to the other edge: along the surface (gap), or across it (flush, positive where the
    second one is higher)."""
    for feature in (first, second):
        if not feature.is_edge:
            raise InputError(f"{feature.name} is a face: {kind} is between two edges.")

    def evaluate(points: Sequence[Array]) -> Array:
        one, two = points
        steps = cKDTree(two).query(one)[1]
        between = _nearest_on_line(one, two, steps) - one
        across = np.einsum("nx,nx->n", between, first.normals)
        if kind == "gap":
            local = np.linalg.norm(between - across[:, None] * first.normals, axis=1)
        else:
            local = across
        return np.array([local.mean(), local.min(), local.max()])

    return evaluate


def _nearest_on_line(points: Array, line: Array, nearest: Array) -> Array:
    """Nearest points on the polyline through ``line`` (m, 3), near its corners ``nearest``."""
    best, least = line[nearest], np.linalg.norm(points - line[nearest], axis=1)
    for step in (-1, 0):
        start = np.clip(nearest + step, 0, len(line) - 2)
        a, along = line[start], line[start + 1] - line[start]
        share = np.clip(np.einsum("nx,nx->n", points - a, along) / np.maximum((along**2).sum(axis=1), 1e-300), 0, 1)
        place = a + share[:, None] * along
        distance = np.linalg.norm(points - place, axis=1)
        nearer = distance < least
        best, least = np.where(nearer[:, None], place, best), np.where(nearer, distance, least)
    return np.asarray(best)
