# SPDX-License-Identifier: LGPL-2.1-or-later
"""What of a feature has to lie in a zone: heights of faces, offsets of edges, centres of circles and axes."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..registration.arrays import Array, Index
from .datums import height_rows
from .features import InspectedFeature
from .fits import fit_circle
from .frames import Frame
from .plan import ORIENTATIONS

FEWEST_SECTION = 8
"""Points of a section, for a circle through it."""


@dataclass(frozen=True)
class Block:
    """What has to lie in one zone, for a part where it lies now.

    Attributes
    ----------
    residual : (n,) distances, or (n, 3) vectors from an axis or a curve, in mm
    jacobian : (n, 6) or (n, 3, 6) their change with a motion
    errors : ``(d, n', 3) -> (d, n)`` or ``(d, n, 3)``: their change with errors of the feature's points
    even : (n,) which of them are spread evenly, for least squares
    """

    residual: Array
    jacobian: Array
    errors: Callable[[Array], Array]
    even: NDArray[np.bool_]


def block_of(kind: str, feature: InspectedFeature, frame: Frame) -> Block:
    """What of a feature has to lie in the zone of a characteristic of `plan.ZONES`, where the part lies in a frame."""
    if kind == "roundness":
        return _circle_block(feature, frame)
    if feature.kind == "cylinder" and kind in ("position", *ORIENTATIONS):
        return _axis_block(feature, frame)
    if feature.kind == "circle" and kind == "position":
        return _centre_block(feature, frame)
    if feature.is_edge:
        return _curve_block(feature, frame)
    residual, normals, jacobian = height_rows(feature, frame)
    return Block(residual, jacobian, lambda errors: np.einsum("dnx,nx->dn", errors @ frame.rotation.T, normals),
                 _even(feature))


def _curve_block(feature: InspectedFeature, frame: Frame) -> Block:
    assert feature.offsets is not None
    moved = frame(feature.points)
    residual, tangents = feature.offsets(moved)
    across = np.eye(3) - tangents[:, :, None] * tangents[:, None, :]
    return Block(residual, frame.vector_jacobian(moved, across),
                 lambda errors: np.einsum("nxy,dny->dnx", across, errors @ frame.rotation.T), _even(feature))


def _axis_block(feature: InspectedFeature, frame: Frame) -> Block:
    """The centres of the sections of a cylinder, from its nominal axis."""
    moved = frame(feature.points)
    sections = [section for section in feature.sections if len(section) >= FEWEST_SECTION]
    if not sections:
        raise InputError(f"{feature.name} has no sections across its axis: it is too small for its axis to be found.")
    centres = np.stack([fit_circle(moved[section], feature.axis)[0] for section in sections])
    rows = [_centre_rows(moved[own], feature.axis) for own in sections]
    return _points_block(centres, feature, frame, rows, sections)


def _centre_block(feature: InspectedFeature, frame: Frame) -> Block:
    moved = frame(feature.points)
    everything = np.arange(len(moved))
    centre = fit_circle(moved, feature.axis)[0]
    return _points_block(centre[None, :], feature, frame, [_centre_rows(moved, feature.axis)], [everything])


def _points_block(centres: Array, feature: InspectedFeature, frame: Frame, rows: Sequence[Array],
                  sections: Sequence[Index]) -> Block:
    across = np.eye(3) - np.outer(feature.axis, feature.axis)
    projections = np.repeat(across[None], len(centres), axis=0)

    def errors(drawn: Array) -> Array:
        turned = drawn @ frame.rotation.T
        return np.stack([np.einsum("xny,dny->dx", row, turned[:, section]) for row, section in zip(
            rows, sections, strict=True)], axis=1)

    return Block((centres - feature.place) @ across, frame.vector_jacobian(centres, projections), errors,
                 np.ones(len(centres), dtype=bool))


def _centre_rows(points: Array, axis: Array) -> Array:
    """Change (3, n, 3) of a circle's centre with its points (n, 3), by least squares."""
    centre, _ = fit_circle(points, axis)
    flat = (points - centre) - ((points - centre) @ axis)[:, None] * axis
    unit = flat / np.linalg.norm(flat, axis=1, keepdims=True)
    rows = np.linalg.pinv(np.column_stack([unit, np.ones(len(unit))]), rcond=1e-9)[:3]
    return np.asarray(rows[:, :, None] * unit[None, :, :])


def _circle_block(feature: InspectedFeature, frame: Frame) -> Block:
    """Distances from the centre of a circle."""
    moved = frame(feature.points)
    centre, radius = fit_circle(moved, feature.axis)
    flat = (moved - centre) - ((moved - centre) @ feature.axis)[:, None] * feature.axis
    distance = np.linalg.norm(flat, axis=1)
    unit = flat / distance[:, None]
    return Block(distance - radius, frame.jacobian(moved, unit),
                 lambda errors: np.einsum("dnx,nx->dn", errors @ frame.rotation.T, unit), _even(feature))


def _even(feature: InspectedFeature) -> NDArray[np.bool_]:
    return np.arange(len(feature.points)) < feature.even


def joined(blocks: Sequence[Block]) -> Block:
    """Blocks of several features in one zone; errors are those of the first."""
    if len(blocks) == 1:
        return blocks[0]
    return Block(np.concatenate([block.residual for block in blocks]),
                 np.concatenate([block.jacobian for block in blocks]), blocks[0].errors,
                 np.concatenate([block.even for block in blocks]))
