# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 1 of the paper: many poses proposed, the best ones refined, each verified against the model, one kept."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..scan_sketch import Plane, Sketch, find_table, sketch_of
from .alignment_result import FAILED, Alignment
from .deformation import NO_DEFORMATION_ROUNDS, SOFT_DEFORMATION_ROUNDS, STIFF_DEFORMATION_ROUNDS
from .evidence import weigh_pose
from .hypothesis import Hypothesis, best_hypothesis, hypothesis_of, nearest_hypothesis, promising, rotate_normals
from .model import Target
from .polish import polish
from .quick import align_quickly
from .search import LOCAL_SEARCH, THOROUGH_SEARCH, SearchStage, propose, starts_around, starts_of
from .scan_unit import plausible_scales
from .verdict import alignment_of, failed_alignment

_SURE_CERTAINTY = 0.95
"""Certainty from which the surroundings of the best pose are not searched once more."""
_LEAST_POINTS = 50
_ROUGH_STRIDE = 4
"""Of the points of the scan that tell which poses are worth a closer look."""


def align(target: Target, scan: Array, mode: str = "global", scales: Sequence[float] | None = None,
          seed: int = 0) -> Alignment:
    """Rigid pose of a scan on the nominal model.

    Parameters
    ----------
    target : the model, see ``target_of``
    scan : (n, 3) in mm, or in a unit that is to be recognised
    mode : "fine" starts from the present pose and its centroid, "global" from anywhere; "local" looks close around the
        present pose, and of poses that fit alike takes the nearest
    scales : factors to try on the scan's coordinates; by default those that its size allows
    seed : of the random choice of points

    Notes
    -----
    Coarse to fine: hundreds of poses with 120 points each, by Gauss-Newton steps on a look-up table of nearest samples
    that face the same way; the few dozen that are left with more points; the best dozen against the exact faces, each
    verified. The best one is polished on thousands of points.
    """
    scales = plausible_scales(scan, target.size) if scales is None else scales
    answer: Alignment | None = None
    for scale in scales:
        attempt = _align_in_mm(target, scan * scale if scale != 1.0 else scan, mode, scale, np.random.default_rng(seed))
        if answer is None or (attempt.verdict != FAILED) > (answer.verdict != FAILED):
            answer = attempt
        if answer.verdict != FAILED:
            break
    if answer is None:
        return failed_alignment(f"the scan measures {np.linalg.norm(np.ptp(scan, axis=0)):.3g} mm and the part "
                                f"{target.size:.3g} mm, which no usual unit explains")
    return answer


def _align_in_mm(target: Target, scan: Array, mode: str, scale: float, generator: np.random.Generator) -> Alignment:
    if mode == "fine":
        quick = align_quickly(target, scan, scale, generator)
        if quick is not None:
            return quick
    sketch = sketch_of(scan, generator)
    table = find_table(sketch, target.largest_projection, generator)
    if table is not None:
        scan = scan[table.heights(scan) > table.tolerance]
        sketch = sketch_of(scan, generator)
    if len(sketch.points) < _LEAST_POINTS:
        return failed_alignment(f"fewer than {_LEAST_POINTS} points of the scan belong together")
    if mode == "local":
        verified = _search(target, sketch, table, starts_around(target, sketch, np.eye(4)), LOCAL_SEARCH, generator)
        best = nearest_hypothesis(verified, sketch.points.mean(axis=0))
    else:
        verified = _search(target, sketch, table, starts_of(target, sketch, mode), THOROUGH_SEARCH, generator)
        best = best_hypothesis(verified, mode, target, sketch)
        if best.evidence.certainty < _SURE_CERTAINTY:
            verified += _search(target, sketch, table, starts_around(target, sketch, best.pose), LOCAL_SEARCH,
                                generator)
            best = best_hypothesis(verified, mode, target, sketch)
    pose = polish(target, sketch, best.pose, best.normals)
    # the pose has moved little: of the fits with a smooth deformation and without one the best counts
    normals = rotate_normals(best, pose)
    fits = best.evidence, *(weigh_pose(target, sketch, pose, normals, table, rounds)
                            for rounds in (NO_DEFORMATION_ROUNDS, SOFT_DEFORMATION_ROUNDS))
    best = Hypothesis(pose, max(fits, key=lambda evidence: evidence.score), normals)
    return alignment_of(target, sketch, table, best, verified, scale)


def _search(target: Target, sketch: Sketch, table: Plane | None, starts: Array, stages: Sequence[SearchStage],
            generator: np.random.Generator) -> list[Hypothesis]:
    """The most promising poses, refined and verified."""
    candidates = propose(target, sketch, starts, stages, generator)
    few = sketch.every(_ROUGH_STRIDE)
    rough = [hypothesis_of(target, few, table, pose, signs, STIFF_DEFORMATION_ROUNDS)
             for pose, signs in zip(candidates.poses, candidates.signs, strict=True)]
    return [hypothesis_of(target, sketch, table, found.pose, candidates.signs[k], SOFT_DEFORMATION_ROUNDS)
            for k, found in promising(rough, target)]
