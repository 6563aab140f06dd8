# SPDX-License-Identifier: LGPL-2.1-or-later
"""Form, profile, orientation and position: how wide a zone has to be that holds a feature (ISO 1101).

All are one: the narrowest zone over the motions that are left to the feature. A form has all of them, an orientation
those that its datums leave and all shifts, a profile and a position those that its datums leave.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import InputError
from ..registration.arrays import Array, Index
from .blocks import FEWEST_SECTION, block_of, joined
from .datums import DatumFrame, on_datums
from .features import InspectedFeature
from .fits import fit_circle
from .frames import FREE, SHIFTS, Frame
from .plan import FORMS, ORIENTATIONS
from .zones import free_part, least_tube, least_zone

_STEPS = 8
_STILL = 1e-9
"""A zone has settled when it changes by less, in mm."""


@dataclass(frozen=True)
class ZoneValue:
    """The width of a zone in mm.

    Attributes
    ----------
    least : of the minimum zone
    squares : of the zone about what lies there by least squares
    draws : (d,) how errors change the latter
    floor : (d,) what errors alone would show of a feature without any deviation
    """

    least: float
    squares: float
    draws: Array
    floor: Array


@dataclass(frozen=True)
class Errors:
    """Draws (d, n, 3) for each feature, the motions (d, 6) that errors of the datums make, and whether they are to be
    looked at without the deviations of the part itself."""

    drawn: Sequence[Array]
    shifts: Array
    alone: bool


def zone_value(kind: str, features: Sequence[InspectedFeature], datums: Sequence[InspectedFeature], start: Frame,
               count: int, random: np.random.Generator) -> ZoneValue:
    """A characteristic of features against datums.

    Parameters
    ----------
    kind : of `plan.ZONES`
    features, datums : as-built
    start : where the part lies
    count : draws of the errors
    random : for them

    Raises
    ------
    InputError : the characteristic is none of such a feature
    """
    _check(kind, features)
    held = on_datums(start, datums)
    free = FREE if kind in FORMS else held.free
    if kind in ORIENTATIONS:
        free = np.hstack([free, SHIFTS])
    if kind == "roundness" and features[0].sections:
        return _roundness(features[0], held.frame, count, random)
    mode = _mode(kind, features[0])
    frame = held.frame
    least, frame = _least(kind, features, frame, free, mode)
    thin = [feature.thinned(_MOST_THIN) for feature in features]
    few = [datum.thinned(_MOST_THIN) for datum in datums]
    held = DatumFrame(held.frame, held.free, on_datums(start, few).stations) if datums else held
    drawn = [feature.errors.draws(count, random) for feature in thin]
    shifts = held.follow([datum.errors.draws(count, random) for datum in few]) if datums else np.zeros((count, 6))
    squares = _by_squares(kind, features, held.frame, free, mode)
    plain = _by_squares(kind, thin, held.frame, free, mode)
    moved, floor = (_by_squares(kind, thin, held.frame, free, mode, Errors(drawn, shifts, alone))
                    for alone in (False, True))
    return ZoneValue(least, float(squares[0]), moved - plain[0], floor)


_MOST_THIN = 400
"""Points of a feature whose errors are drawn."""


def _check(kind: str, features: Sequence[InspectedFeature]) -> None:
    wanted = {"flatness": ("plane",), "straightness": ("line",), "roundness": ("cylinder", "circle"),
              "cylindricity": ("cylinder",), "profile_line": ("line", "circle", "curve"),
              "profile_surface": ("plane", "cylinder", "surface"), "position": ("plane", "cylinder", "circle", "line"),
              }.get(kind, ("plane", "cylinder", "line"))
    for feature in features:
        if feature.kind not in wanted:
            raise InputError(f"{feature.name} is a {feature.kind}: {kind} is of a {' or '.join(wanted)}.")


def _mode(kind: str, feature: InspectedFeature) -> str:
    if feature.is_edge and not (kind == "roundness"):
        return "tube"
    if feature.kind == "cylinder" and kind in ("position", *ORIENTATIONS):
        return "tube"
    return "symmetric" if kind in ("profile_surface", "position") else "width"


def _least(kind: str, features: Sequence[InspectedFeature], frame: Frame, free: Array, mode: str
           ) -> tuple[float, Frame]:
    """The minimum zone; motions are finite, so that the linear problem is solved anew where the last answer lies."""
    width = np.inf
    for _ in range(_STEPS):
        block = joined([block_of(kind, feature, frame) for feature in features])
        if mode == "tube":
            new, motion = least_tube(block.residual, block.jacobian @ free)
        else:
            new, motion = least_zone(block.residual, block.jacobian @ free, mode)  # type: ignore[arg-type]
        frame = frame.moved(free @ motion)
        if abs(new - width) <= _STILL:
            break
        width = new
    return float(new), frame


def _by_squares(kind: str, features: Sequence[InspectedFeature], frame: Frame, free: Array, mode: str,
                added: Errors | None = None) -> Array:
    """Widths (d,) of the zones about what lies there by least squares; (1,) without draws."""
    blocks = [block_of(kind, feature, frame) for feature in features]
    block = joined(blocks)
    count = len(block.residual)
    residual = block.residual.reshape(1, -1)
    jacobian = block.jacobian.reshape(residual.shape[1], 6)
    if added is not None:
        parts = [own.errors(errors).reshape(len(errors), -1) for own, errors in zip(blocks, added.drawn, strict=True)]
        residual = (0.0 if added.alone else residual) + np.concatenate(parts, axis=1) + added.shifts @ jacobian.T
    rows = jacobian @ free
    if mode == "width":
        rows = np.hstack([rows, np.ones((len(rows), 1))])
    per_point = residual.shape[1] // count
    left = free_part(residual, rows, np.repeat(block.even, per_point))
    if mode == "tube":
        return np.asarray(2.0 * np.linalg.norm(left.reshape(len(left), count, 3), axis=2).max(axis=1))
    if mode == "symmetric":
        return np.asarray(2.0 * np.abs(left).max(axis=1))
    return np.asarray(np.ptp(left, axis=1))


def _roundness(feature: InspectedFeature, frame: Frame, count: int, random: np.random.Generator) -> ZoneValue:
    """The roundness of the worst section of a cylinder."""
    thin = feature.thinned(_MOST_THIN)
    drawn = thin.errors.draws(count, random)
    found: list[tuple[Any, ...]] = []
    none = np.zeros((count, 6))
    for section, few in zip(feature.sections, thin.sections, strict=True):
        if len(section) < FEWEST_SECTION:
            continue
        whole, part = (_section(item, rows) for item, rows in ((feature, section), (thin, few)))
        around = [_by_squares("roundness", [item], frame, SHIFTS, "width")[0] for item in (whole, part)]
        moved = [_by_squares("roundness", [part], frame, SHIFTS, "width", Errors([drawn[:, few]], none, alone))
                 for alone in (False, True)]
        found.append((_circle_zone(whole, frame), *around, *moved))
    if not found:
        raise InputError(f"{feature.name} has no sections across its axis: it is too small for its roundness.")
    least, squares, plain, shown, floor = (np.max(column, axis=0) for column in zip(*found, strict=True))
    return ZoneValue(float(least), float(squares), shown - plain, floor)


def _section(feature: InspectedFeature, rows: Index) -> InspectedFeature:
    return replace(feature, kind="circle", points=feature.points[rows], heights=None, sections=(),
                   errors=feature.errors.part(rows), normals=feature.normals[rows], even=len(rows))


def _circle_zone(feature: InspectedFeature, frame: Frame) -> float:
    """Minimum zone of a circle: the centre is moved, and the distances from it are taken anew."""
    moved = frame(feature.points)
    centre, _ = fit_circle(moved, feature.axis)
    width = np.inf
    for _ in range(_STEPS):
        flat = (moved - centre) - ((moved - centre) @ feature.axis)[:, None] * feature.axis
        distance = np.linalg.norm(flat, axis=1)
        new, shift = least_zone(distance - distance.mean(), -flat / distance[:, None], "width")
        centre = centre + shift
        if abs(new - width) <= _STILL:
            break
        width = new
    return float(new)
