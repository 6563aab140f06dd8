# SPDX-License-Identifier: LGPL-2.1-or-later
"""The most promising poses of very many, found on few points of the scan in stages."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...scan_sketch import Sketch
from ..evidence import hides_sides
from ..model import Target, nearest_field
from .candidates import Candidates, Probe, distinct, improve, scores

_MAJOR_PIECE = 0.1
"""A connected piece with at least this share of the points has a sign of its own in the search."""


@dataclass(frozen=True)
class SearchStage:
    """One round of the search.

    Attributes
    ----------
    points : of the scan that are looked at
    widest, closest, steps : gates of the Gauss-Newton steps, as shares of the part's size
    width : distance, as a share of the size, at which a point counts half in the score
    kept : poses that go on
    turn : poses closer than this (rad) are one; 0 keeps them all
    """

    points: int
    widest: float
    closest: float
    steps: int
    width: float
    kept: int
    turn: float


THOROUGH_SEARCH = (SearchStage(120, 0.30, 0.10, 6, 0.05, 240, 0.0), SearchStage(250, 0.10, 0.05, 6, 0.04, 40, 0.12),
                   SearchStage(600, 0.05, 0.03, 8, 0.03, 12, 0.05))
QUICK_SEARCH = (SearchStage(90, 0.30, 0.07, 7, 0.04, 6, 0.1), SearchStage(250, 0.07, 0.02, 5, 0.015, 1, 0.05))
LOCAL_SEARCH = (SearchStage(150, 0.08, 0.05, 6, 0.04, 30, 0.08), SearchStage(600, 0.05, 0.03, 8, 0.03, 5, 0.04))


def propose(target: Target, sketch: Sketch, starts: Array, stages: Sequence[SearchStage],
            generator: np.random.Generator) -> Candidates:
    """The most promising poses, best first.

    Parameters
    ----------
    target, sketch : the part, and even points of the scan
    starts : (k, 4, 4) poses to start from
    stages : of the search, coarse to fine
    generator : draws the points that are looked at
    """
    share = np.bincount(sketch.piece) / len(sketch.piece)
    sided = not hides_sides(target, sketch)
    pieces = max(1, int((share[:2] > _MAJOR_PIECE).sum())) if sided else 1
    field, size = nearest_field(target), target.size
    candidates = Candidates.all_signs(starts, pieces)
    if not sided:
        candidates = candidates[candidates.signs[:, 0] > 0]
    for stage in stages:
        chosen = generator.choice(len(sketch.points), min(stage.points, len(sketch.points)), replace=False)
        piece = np.where(sketch.piece[chosen] < pieces, sketch.piece[chosen], 0)
        probe = Probe(sketch.points[chosen], sketch.normals[chosen], piece, sided)
        gates = (size * np.geomspace(stage.widest, stage.closest, stage.steps)).tolist()
        candidates = improve(field, probe, candidates, gates)
        score = scores(field, probe, candidates, stage.width * size)
        if stage.turn:
            kept = distinct(candidates, score, field.centre, stage.kept, stage.turn, 0.25 * stage.turn * size)
        else:
            kept = np.argsort(-score)[: stage.kept]
        candidates = candidates[kept]
    return candidates
