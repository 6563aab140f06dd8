# SPDX-License-Identifier: LGPL-2.1-or-later
"""The most promising poses of very many, found on few points of the scan in stages."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ..evidence import UnalignedScan
from ..model import nearest_field
from ..search_settings import SearchStage
from .candidates import Candidates, Probe, distinct, improve, scores


def propose(scan: UnalignedScan, starts: Array, stages: Sequence[SearchStage],
            generator: np.random.Generator) -> Candidates:
    """The most promising poses, best first.

    Parameters
    ----------
    scan : even points of it, and the part
    starts : (k, 4, 4) poses to start from
    stages : of the search, coarse to fine
    generator : draws the points that are looked at
    """
    target, sketch, sided = scan.target, scan.sketch, not scan.hides_sides
    share = np.bincount(sketch.piece) / len(sketch.piece)
    pieces = max(1, int((share[:2] > target.settings.search.major_piece).sum())) if sided else 1
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
