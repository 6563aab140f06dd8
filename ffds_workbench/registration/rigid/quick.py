# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pose of a clean scan of an undeformed part that lies nearby: few points, few starts, no doubt allowed."""
from __future__ import annotations

import numpy as np

from ..splines import Array
from .alignment import Alignment
from .hypothesis import TURNED, Verified, best_of, mended, refined, turned_on
from .motions import motion
from .polish import polish
from .proposals import QUICK, propose
from .sketch import sketch_of
from .starts import turns_up_to
from .target import Target
from .verdict import FAILS, answer_of
from .verify import examine, is_rough

_FEWEST = 50
_ROTATIONS, _TURN, _POINTS, _POOL = 12, 0.5, 1000, 16_000
_CLEARLY_RIGHT = 0.90
"""Share of explained points from which a quick answer is taken: of a sheet matched with its far side up to 0.95 is
explained, but more of one matched with the right one."""


def quickly(target: Target, scan: Array, scale: float, generator: np.random.Generator) -> Alignment | None:
    """The pose of a clean scan of an undeformed part that lies within some 30° of it; None if none is clearly right."""
    sketch = sketch_of(scan, generator, _POINTS, _POOL, 1)
    if len(sketch.points) < _FEWEST or is_rough(target, sketch):
        return None
    centre = sketch.points.mean(axis=0)
    rotations = turns_up_to(_TURN, _ROTATIONS)
    candidates = propose(target, sketch, motion(rotations, target.centre - rotations @ centre), QUICK, generator)
    clear: list[Verified] = []
    # a sheet is seen from one side, and only its rims tell which
    for signs in (candidates.signs[0], -candidates.signs[0]):
        pose, normals = refined(target, sketch, candidates.poses[0], signs)
        normals, turned = mended(target, sketch, pose, normals, 4.0 * sketch.noise)
        evidence = examine(target.light, sketch, pose, normals, None, rounds=0)
        if evidence.explained > _CLEARLY_RIGHT and evidence.certainty > FAILS and turned < TURNED:
            clear.append(Verified(pose, evidence, normals))
    if not clear:
        return None
    best = best_of(clear, "fine", target, sketch)
    pose = polish(target, sketch, best.pose, best.normals, best.evidence.coverage)
    return answer_of(target, sketch, None, Verified(pose, best.evidence, turned_on(best, pose)), clear, scale)
