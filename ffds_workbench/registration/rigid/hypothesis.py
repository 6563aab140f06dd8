# SPDX-License-Identifier: LGPL-2.1-or-later
"""A pose refined against the side of the part that the scan shows, with what speaks for it."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..motions import angle, apply, shift
from ..scan_sketch import Plane, Sketch
from .deformation import Rounds
from .evidence import Evidence, facing_normals, hides_sides, weigh_pose
from .model import Target
from .polish import is_deformed
from .refine import refine

_ON_PART = 0.008
"""A normal is flipped if the point is farther from the part than this share of its size as it is, and nearer with the
normal flipped."""
MOST_STRAY_NORMALS = 0.15
"""Largest share of the normals that may be flipped one by one."""
SCORE_MARGIN = 0.06
"""Two poses fit equally well if their scores differ by less than this share of what the better one leaves
unexplained."""
SAME_TURN, SAME_SHIFT = 0.07, 0.03
"""Poses closer than this (rad, share of the part's size) are one."""
_PROMISING_MARGIN = 0.1
"""A pose whose score on few points is lower than the best by more than this cannot be the best on many points."""
_SETTLED_TURN, _SETTLED_SHIFT = 0.01, 0.005
"""Poses closer than this (rad, share of the part's size) have converged to the same place."""
_NEARER_BY = 0.005
"""A pose counts as nearer than another if it is nearer by this share of the part's size, which is less than the
thickness of a sheet."""


@dataclass(frozen=True)
class Hypothesis:
    """A refined pose with what speaks for it and the outward normals it gives the sketch."""

    pose: Array
    evidence: Evidence
    normals: Array
    reason: str = "found"


def hypothesis_of(target: Target, sketch: Sketch, table: Plane | None, pose: Array, signs: Array,
                  rounds: Rounds) -> Hypothesis:
    """The pose refined against the side of the part that the scan shows, and what speaks for it, a smooth deformation
    allowed for that is fitted in these rounds."""
    pose, normals = refine_on_side(target, sketch, pose, signs)
    if not hides_sides(target, sketch):
        near = max(_ON_PART * target.size, 4.0 * sketch.noise)
        patched, turned = flip_stray_normals(target, sketch, pose, normals, near)
        if 0.0 < turned < MOST_STRAY_NORMALS:
            closer = refine(target.coarse, sketch.points, pose, (0.04 * target.size,), 8, patched @ pose[:3, :3])
            patched = patched @ pose[:3, :3] @ closer[:3, :3].T
            # of a deformed sheet some points lie nearer to the far side
            if not is_deformed(target, sketch, closer, patched):
                pose, normals = closer, patched
    return Hypothesis(pose, weigh_pose(target.coarse, sketch, pose, normals, table, rounds), normals)


def refine_on_side(target: Target, sketch: Sketch, pose: Array, signs: Array) -> tuple[Array, Array]:
    """The pose after a few steps, and the outward normals of the sketch in the model's frame."""
    light, gate = target.coarse, 0.08 * target.size
    if hides_sides(target, sketch):
        pose = refine(light, sketch.points, pose, (1.5 * gate, gate, 0.5 * gate), 8)
        return pose, facing_normals(light, apply(pose, sketch.points))
    normals = outward_normals(sketch, signs)
    pose = refine(light, sketch.points, pose, (gate,), 12, normals)
    return pose, normals @ pose[:3, :3].T


def outward_normals(sketch: Sketch, signs: Array) -> Array:
    """Normals of the sketch, scan coordinates, with the signs (p,) of the largest pieces; (n, 3)."""
    return signs[np.where(sketch.piece < len(signs), sketch.piece, 0)][:, None] * sketch.normals


def flip_stray_normals(target: Target, sketch: Sketch, pose: Array, normals: Array, near: float) -> tuple[Array, float]:
    """Normals turned round one by one where the point then lies ``near`` (mm) the part, and the share of those."""
    moved = apply(pose, sketch.points)
    off = np.flatnonzero(_heights(target.coarse, moved, normals) > near)
    turned = np.zeros(len(moved), dtype=bool)
    turned[off] = _heights(target.coarse, moved[off], -normals[off]) < near
    return np.where(turned[:, None], -normals, normals), float(turned.mean())


def _heights(target: Target, points: Array, normals: Array) -> Array:
    """Distances in mm from the faces that face the same way, infinite where there are none nearby; (n,)."""
    distance, nearest = target.nearest(points, normals, 0.05 * target.size)
    return np.where(np.isfinite(distance), np.abs(target.heights(points, nearest)[0]), np.inf)


def rotate_normals(found: Hypothesis, pose: Array) -> Array:
    """The outward normals in the model's frame after the pose has moved on a little."""
    return found.normals @ found.pose[:3, :3] @ pose[:3, :3].T


def best_hypothesis(verified: Sequence[Hypothesis], mode: str, target: Target, sketch: Sketch) -> Hypothesis:
    """The pose that scores best; of those that fit alike, a fine alignment takes the one that turns and moves least."""
    good = equally_good(verified)
    if mode != "global":
        turned = [float(angle(v.pose, np.eye(4))) for v in good]
        good = [v for v, turn in zip(good, turned, strict=True) if turn < min(turned) + SAME_TURN]
        place = sketch.points.mean(axis=0)
        moved = [float(shift(v.pose, np.eye(4), place)) for v in good]
        good = [v for v, move in zip(good, moved, strict=True) if move < min(moved) + _NEARER_BY * target.size]
    return max(good, key=lambda v: v.evidence.score)


def promising(verified: Sequence[Hypothesis], target: Target) -> list[tuple[int, Hypothesis]]:
    """Poses that may turn out the best, with their numbers; each but once."""
    best = max(v.evidence.score for v in verified)
    kept: list[tuple[int, Hypothesis]] = []
    for k in sorted(range(len(verified)), key=lambda k: -verified[k].evidence.score):
        one = verified[k]
        known = any(angle(one.pose, v.pose) < _SETTLED_TURN
                    and shift(one.pose, v.pose, target.centre) < _SETTLED_SHIFT * target.size for _, v in kept)
        if one.evidence.score > best - _PROMISING_MARGIN and not known:
            kept.append((k, one))
    return kept


def equally_good(verified: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The poses that fit as well as the best one."""
    best = max(v.evidence.score for v in verified)
    return [v for v in verified if v.evidence.score >= best - SCORE_MARGIN * (1.0 - best)]


def nearest_hypothesis(verified: Sequence[Hypothesis], place: Array) -> Hypothesis:
    """Of the poses that fit alike, the one that moves ``place`` least: a start by hand says which side is meant."""
    return min(equally_good(verified), key=lambda v: float(shift(v.pose, np.eye(4), place)))
