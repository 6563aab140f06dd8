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
from .deformation import NOT, SOFT, STIFF, Deformation, Match
from .evidence import examine, is_rough, matched, misfit_of, weigh
from .hypothesis import TURNED, Verified, best_of, mended, outward, turned_on
from .model import Target
from .polish import is_deformed, polish_deformed, polish_rigid
from .refine import refine
from .search import QUICK, propose, turns_up_to
from .verdict import FAILS, answer_of

_FEWEST = 50
_ROTATIONS, _TURN = 12, 0.5
"""Turns that are tried, and the largest in rad: from there a search finds those of 30° and a little more."""
_POOL, _POINTS, _EVERY = 24_000, 1_500, 3
"""Points of the scan that are looked at; those that tell sides; and every which of them is matched."""
_WIDE = 0.75
"""A point farther than this share of the part's size from the centroid of the scan is beside the part."""
_GATE, _STEPS = 0.08, 5
"""Distance, as a share of the part's size, within which a point has its face, and steps towards it."""
_STIFF_LOOKS, _SOFT_LOOKS = STIFF[:2], SOFT[2:4]
"""Rounds of the deformations that tell the sides: the second one follows where the first one does not tell."""
_CLEARLY_RIGHT = 0.90
"""Share of explained points from which a quick answer is taken: of a sheet matched with its far side up to 0.95 is
explained, but more of one matched with the right one."""
_CLEARLY_BETTER = 0.65
"""Misfit of the right side over that of the other one, where a smooth deformation is taken back."""


def quickly(target: Target, scan: Array, scale: float, generator: np.random.Generator) -> Alignment | None:
    """The pose of a clean scan that lies within some 30° of it; None if none is clearly right."""
    whole = sketch_of(scan, generator, _POINTS, _POOL, 1)
    table = None
    if np.linalg.norm(whole.points - whole.points.mean(axis=0), axis=1).max() > _WIDE * target.size:
        table = find_table(whole, target.shadow, generator)
    if table is not None:
        whole = sketch_of(scan[table.heights(scan) > table.tolerance], generator, _POINTS, _POOL, 1)
    sketch = whole.every(_EVERY)
    if len(sketch.points) < _FEWEST or is_rough(target, sketch):
        return None
    centre = sketch.points.mean(axis=0)
    rotations = turns_up_to(_TURN, _ROTATIONS)
    candidates = propose(target, sketch, motion(rotations, target.centre - rotations @ centre), QUICK, generator)
    # a sheet is seen from one side, and only its rims tell which
    sides = [_refined(target, sketch, candidates.poses[0], signs)
             for signs in (candidates.signs[0], -candidates.signs[0])]
    return (_undeformed(target, sketch, table, sides, scale)
            or _deformed(target, sketch, table, sides, scale, whole))


@dataclass(frozen=True)
class _Side:
    """A pose (4, 4), the signs (p,) of the pieces' normals, and the outward normals (n, 3) in the model's frame."""

    pose: Array
    signs: Array
    normals: Array


def _refined(target: Target, sketch: Sketch, pose: Array, signs: Array) -> _Side:
    """The pose after a few steps towards the side that the signs tell."""
    normals = outward(sketch, signs)
    pose = refine(target.light, sketch.points[::2], pose, (_GATE * target.size,), _STEPS, normals[::2])
    return _Side(pose, signs, normals @ pose[:3, :3].T)


def _undeformed(target: Target, sketch: Sketch, table: Plane | None, sides: Sequence[_Side], scale: float,
                ) -> Alignment | None:
    """The answer of a pose at which the scan lies on the part as it is."""
    clear: list[Verified] = []
    for side in sides:
        if is_deformed(target.light, sketch, side.pose, side.normals):
            continue
        normals, turned = mended(target, sketch, side.pose, side.normals, 4.0 * sketch.noise)
        if turned >= TURNED:
            continue
        evidence = examine(target.light, sketch, side.pose, normals, table, NOT)
        if evidence.explained > _CLEARLY_RIGHT and evidence.certainty > FAILS:
            clear.append(Verified(side.pose, evidence, normals))
    if not clear:
        return None
    best = best_of(clear, "fine", target, sketch)
    pose = polish_rigid(target, sketch, best.pose)
    return answer_of(target, sketch, table, Verified(pose, best.evidence, turned_on(best, pose)), clear, scale)


def _deformed(target: Target, sketch: Sketch, table: Plane | None, sides: Sequence[_Side], scale: float,
              whole: Sketch) -> Alignment | None:
    """The answer of a pose at which the scan lies on the part after a smooth deformation, and of no other.

    ``whole`` is the sketch before it was thinned: all of its points count for the pose.
    """
    fits = [matched(target.light, sketch, side.pose, side.normals, _STIFF_LOOKS) for side in sides]
    better = _better(target, sketch, sides, fits)
    if better is None:
        fits = [matched(target.light, sketch, side.pose, side.normals, _SOFT_LOOKS, deformation)
                for side, (_, deformation) in zip(sides, fits, strict=True)]
        better = _better(target, sketch, sides, fits)
    if better is None:
        return None
    side = sides[better]
    normals = outward(whole, side.signs) @ side.pose[:3, :3].T
    pose, deformation = polish_deformed(target, whole, side.pose, normals, fits[better][1])
    normals = outward(sketch, side.signs) @ pose[:3, :3].T
    found = matched(target.light, sketch, pose, normals, NOT, deformation)[0]
    evidence = weigh(target.light, sketch, pose, normals, table, found)
    if evidence.certainty < FAILS or evidence.explained < _CLEARLY_RIGHT:
        return None
    best = Verified(pose, evidence, normals)
    return answer_of(target, sketch, table, best, [best], scale)


def _better(target: Target, sketch: Sketch, sides: Sequence[_Side], fits: Sequence[tuple[Match, Deformation]],
            ) -> int | None:
    """The number of the side that the scan fits clearly better."""
    misfits = [misfit_of(target.light, sketch, side.normals, found)
               for side, (found, _) in zip(sides, fits, strict=True)]
    better = int(np.argmin(misfits))
    return better if misfits[better] < _CLEARLY_BETTER * misfits[1 - better] else None
