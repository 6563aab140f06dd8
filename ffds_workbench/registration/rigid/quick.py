# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pose of a clean scan that lies nearby: few points, few starts, no doubt allowed."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..motions import motion
from ..scan_sketch import Plane, Sketch, find_table, sketch_of
from .alignment_result import Alignment
from .deformation import (NO_DEFORMATION_ROUNDS, SOFT_DEFORMATION_ROUNDS, STIFF_DEFORMATION_ROUNDS, DisplacementField,
                          Match)
from .evidence import hides_sides, match_sketch, misfit_of, weigh_match, weigh_pose
from .hypothesis import (MOST_STRAY_NORMALS, Hypothesis, best_hypothesis, flip_stray_normals, outward_normals,
                         rotate_normals)
from .model import Target
from .polish import is_deformed, polish_deformed, polish_rigid
from .refine import refine
from .search import QUICK_SEARCH, propose, turns_up_to
from .verdict import LEAST_CERTAINTY, alignment_of

_LEAST_POINTS = 50
_START_TURNS, _LARGEST_START_TURN = 12, 0.5
"""Number of turns to start from, and the largest in rad: from these the search finds poses turned by somewhat more than
30°."""
_POOL_SIZE, _SKETCH_POINTS, _MATCH_STRIDE = 24_000, 1_500, 3
"""Number of scan points that are used, of points that the sides are found on, and the stride of those that are
matched."""
_BESIDE_PART = 0.75
"""A scan point farther than this share of the part's size from the scan's centroid cannot lie on the part: there may be
a table."""
_FACE_GATE, _REFINE_STEPS = 0.08, 5
"""Gate as a share of the part's size, and number of steps."""
_STIFF_ROUNDS, _SOFT_ROUNDS = STIFF_DEFORMATION_ROUNDS[:2], SOFT_DEFORMATION_ROUNDS[2:4]
"""Rounds of the deformation by which the two sides are compared: the second ones follow where the first ones do not
decide."""
_LEAST_EXPLAINED = 0.90
"""Share of explained points from which a quick answer is accepted. Of a sheet matched with its far side up to 0.95 is
explained, but more of a sheet matched with the right one."""
_MISFIT_RATIO = 0.65
"""A side is clearly better if its misfit, after a smooth deformation, is below this factor times the other side's."""


def align_quickly(target: Target, scan: Array, scale: float, generator: np.random.Generator) -> Alignment | None:
    """The pose of a clean scan that lies within some 30° of it; None if none is clearly right."""
    whole = sketch_of(scan, generator, _SKETCH_POINTS, _POOL_SIZE, 1)
    table = None
    if np.linalg.norm(whole.points - whole.points.mean(axis=0), axis=1).max() > _BESIDE_PART * target.size:
        table = find_table(whole, target.largest_projection, generator)
    if table is not None:
        whole = sketch_of(scan[table.heights(scan) > table.tolerance], generator, _SKETCH_POINTS, _POOL_SIZE, 1)
    sketch = whole.every(_MATCH_STRIDE)
    if len(sketch.points) < _LEAST_POINTS or hides_sides(target, sketch):
        return None
    centre = sketch.points.mean(axis=0)
    rotations = turns_up_to(_LARGEST_START_TURN, _START_TURNS)
    candidates = propose(target, sketch, motion(rotations, target.centre - rotations @ centre), QUICK_SEARCH, generator)
    # a sheet is seen from one side, and only its rims tell which
    sides = [_refined_side(target, sketch, candidates.poses[0], signs)
             for signs in (candidates.signs[0], -candidates.signs[0])]
    return (_align_undeformed(target, sketch, table, sides, scale)
            or _align_deformed(target, sketch, table, sides, scale, whole))


@dataclass(frozen=True)
class _Side:
    """A pose (4, 4), the signs (p,) of the pieces' normals, and the outward normals (n, 3) in the model's frame."""

    pose: Array
    signs: Array
    normals: Array


def _refined_side(target: Target, sketch: Sketch, pose: Array, signs: Array) -> _Side:
    """The pose after a few steps towards the side that the signs say."""
    normals = outward_normals(sketch, signs)
    pose = refine(target.coarse, sketch.points[::2], pose, (_FACE_GATE * target.size,), _REFINE_STEPS, normals[::2])
    return _Side(pose, signs, normals @ pose[:3, :3].T)


def _align_undeformed(target: Target, sketch: Sketch, table: Plane | None, sides: Sequence[_Side], scale: float,
                      ) -> Alignment | None:
    """The alignment, if the scan lies on the part without any deformation."""
    clear: list[Hypothesis] = []
    for side in sides:
        if is_deformed(target.coarse, sketch, side.pose, side.normals):
            continue
        normals, turned = flip_stray_normals(target, sketch, side.pose, side.normals, 4.0 * sketch.noise)
        if turned >= MOST_STRAY_NORMALS:
            continue
        evidence = weigh_pose(target.coarse, sketch, side.pose, normals, table, NO_DEFORMATION_ROUNDS)
        if evidence.explained > _LEAST_EXPLAINED and evidence.certainty > LEAST_CERTAINTY:
            clear.append(Hypothesis(side.pose, evidence, normals))
    if not clear:
        return None
    best = best_hypothesis(clear, "fine", target, sketch)
    pose = polish_rigid(target, sketch, best.pose)
    return alignment_of(target, sketch, table, Hypothesis(pose, best.evidence, rotate_normals(best, pose)), clear,
                        scale)


def _align_deformed(target: Target, sketch: Sketch, table: Plane | None, sides: Sequence[_Side], scale: float,
                    whole: Sketch) -> Alignment | None:
    """The alignment, if the scan lies on the part after a smooth deformation, and clearly on one side of it.

    ``whole`` is the sketch before it was thinned: all of its points count for the pose.
    """
    fits = [match_sketch(target.coarse, sketch, side.pose, side.normals, _STIFF_ROUNDS) for side in sides]
    better = _clearly_better(target, sketch, sides, fits)
    if better is None:
        fits = [match_sketch(target.coarse, sketch, side.pose, side.normals, _SOFT_ROUNDS, deformation)
                for side, (_, deformation) in zip(sides, fits, strict=True)]
        better = _clearly_better(target, sketch, sides, fits)
    if better is None:
        return None
    side = sides[better]
    normals = outward_normals(whole, side.signs) @ side.pose[:3, :3].T
    pose, deformation = polish_deformed(target, whole, side.pose, normals, fits[better][1])
    normals = outward_normals(sketch, side.signs) @ pose[:3, :3].T
    found = match_sketch(target.coarse, sketch, pose, normals, NO_DEFORMATION_ROUNDS, deformation)[0]
    evidence = weigh_match(target.coarse, sketch, pose, normals, table, found)
    if evidence.certainty < LEAST_CERTAINTY or evidence.explained < _LEAST_EXPLAINED:
        return None
    best = Hypothesis(pose, evidence, normals)
    return alignment_of(target, sketch, table, best, [best], scale)


def _clearly_better(target: Target, sketch: Sketch, sides: Sequence[_Side],
                    fits: Sequence[tuple[Match, DisplacementField]],
                    ) -> int | None:
    """Number of the side that the scan fits clearly better; None if neither."""
    misfits = [misfit_of(target.coarse, sketch, side.normals, found)
               for side, (found, _) in zip(sides, fits, strict=True)]
    better = int(np.argmin(misfits))
    return better if misfits[better] < _MISFIT_RATIO * misfits[1 - better] else None
