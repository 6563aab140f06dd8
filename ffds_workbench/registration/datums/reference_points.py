# SPDX-License-Identifier: LGPL-2.1-or-later
"""A pose by reference points (RPS): each holds the scan at its place along its own direction, to its tolerance."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..arrays import Array, Index
from ..motions import apply, twist_motion, twist_rows
from .datum_pose import DatumFit, DatumPose, free_twists, singular, step_length

_RADIUS = 0.03
"""Of the part's size: scan points this near to a reference point may tell where the surface is there (unit)."""
_POINTS = 6, 40
"""Fewest and most points around a reference point that its plane is fitted to (theory: three, and as many again for
their noise; unit: the nearest few)."""
_STEPS = 15
"""Gauss-Newton steps, each with the points found anew (unit: three to five do)."""
_SETTLED = 1e-9
"""Size of a step in mm that is none (unit: rounding)."""
_TOLD = 1e-3
"""Singular values, over the largest, below which the points tell nothing (unit: noise)."""


@dataclass(frozen=True)
class ReferencePoint:
    """A place (3,) on the nominal part, the unit direction (3,) in which it holds, and its tolerance in mm."""

    place: Array
    direction: Array
    tolerance: float = 1.0


def align_on_points(references: Sequence[ReferencePoint], points: Array, start: Array, size: float,
                    locked: Sequence[str] = ()) -> DatumPose:
    """The pose that meets reference points best, each weighed by its tolerance.

    Parameters
    ----------
    references : the reference points
    points : (n, 3) of the scan in mm
    start : (4, 4) T_model_scan to start from
    size : of the part in mm
    locked : of `FREEDOMS`, in the frame of the model: they stay as they are in ``start``
    """
    pose, basis, tree = start, free_twists(locked, size), cKDTree(points)
    place = np.array([reference.place for reference in references])
    along = np.array([reference.direction for reference in references])
    weight = 1.0 / np.array([reference.tolerance for reference in references])
    heights, told, seen = np.zeros(len(place)), 0, np.zeros(len(place), dtype=np.intp)
    for _ in range(_STEPS):
        heights, seen = _heights(place, along, points, tree, pose, _RADIUS * size)
        used = seen > 0
        rows = (weight[:, None] * (twist_rows(place, along) @ basis))[used]
        values, turned = singular(rows)
        which = values > _TOLD * values.max(initial=1e-12)
        told = int(which.sum())
        if not told:
            break
        moves = basis @ turned[which].T
        step = moves @ np.linalg.lstsq(rows @ turned[which].T, -(weight * heights)[used], rcond=None)[0]
        pose = twist_motion(step, np.zeros(3)) @ pose
        if step_length(step, size) < _SETTLED:
            break
    fits = tuple(DatumFit(int(count), abs(float(height)), float(height), 1 if count else 0)
                 for count, height in zip(seen, heights, strict=True))
    return DatumPose(pose, fits, basis.shape[1] - told)


def _heights(place: Array, along: Array, points: Array, tree: cKDTree, pose: Array, radius: float
             ) -> tuple[Array, Index]:
    """How far the scan lies off each reference point along its direction, in mm, and how many points tell it."""
    back = np.linalg.inv(pose)
    near = tree.query_ball_point(apply(back, place), radius)
    heights, seen = np.zeros(len(place)), np.zeros(len(place), dtype=np.intp)
    for number, found in enumerate(near):
        if len(found) < _POINTS[0]:
            continue
        offset = apply(pose, points[found]) - place[number]
        height = offset @ along[number]
        beside = offset - np.outer(height, along[number])
        kept = np.argsort(np.linalg.norm(beside, axis=1), kind="stable")[: _POINTS[1]]
        rows = np.column_stack([np.ones(len(kept)), beside[kept]])
        heights[number] = np.linalg.lstsq(rows, height[kept], rcond=1e-6)[0][0]
        seen[number] = len(kept)
    return heights, seen
