# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said of a pose: is it good enough, and does another one fit as well?"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..motions import angle, apply, shift
from ..scan_sketch import Plane, Sketch
from .alignment_result import AMBIGUOUS, FAILED, OK, Alignment, CandidatePose
from .evidence import Evidence
from .hypothesis import SAME_SHIFT, SAME_TURN, SCORE_MARGIN, Hypothesis
from .model import Target
from .polish import polish
from .symmetry import Symmetry, symmetry_of
from .scan_unit import unit_name

_FITNESS_POINTS = 1_000
"""Number of points that the fitness is computed on."""
LEAST_CERTAINTY = 0.79
"""A pose with less certainty is rejected. In the benchmark, ten scans of other parts reach 0.72, and one of 45 scans of
deformed other parts 0.788; scans of the part itself have at least 0.80 where it is deformed by 5 mm, and 0.85 with 20 %
stray points."""
_LEAST_COVERAGE = 0.12
_FITNESS_REACH = 0.02
"""Distance within which a point counts as on the part, as a share of the part's size."""


def alignment_of(target: Target, sketch: Sketch, table: Plane | None, best: Hypothesis, verified: Sequence[Hypothesis],
                 scale: float) -> Alignment:
    """The verdict: is the best pose good enough, and does another one fit as well?"""
    evidence = best.evidence
    symmetry = symmetry_of(target)
    rivals = _rivals(target, sketch, table, best, verified, symmetry)
    poses = (CandidatePose(best.pose, evidence.score, "found"),
             *(CandidatePose(rival.pose, rival.evidence.score, rival.reason) for rival in rivals))
    moved = apply(best.pose, sketch.pool[:_FITNESS_POINTS])
    distance, closest = target.tree.query(moved)
    reach = max(_FITNESS_REACH * target.size, 2.5 * sketch.noise)
    near = distance < reach
    height = target.heights(moved[near], closest[near])[0] if near.any() else np.zeros(1)
    reason, verdict = "", OK
    if evidence.certainty < LEAST_CERTAINTY or evidence.coverage < _LEAST_COVERAGE:
        verdict, poses, reason = FAILED, poses[:1], _why_failed(evidence)
    elif rivals:
        verdict, reason = AMBIGUOUS, symmetry.text() or "the scan fits in several poses alike"
    sure = float(np.clip((evidence.certainty - LEAST_CERTAINTY) / (1.0 - LEAST_CERTAINTY), 0.0, 1.0))
    confidence = sure / (len(poses) if verdict == AMBIGUOUS else 1)
    return Alignment(best.pose, verdict, confidence, poses, reach, float(near.mean()),
                     float(np.sqrt(np.mean(height**2))), evidence.explained, evidence.coverage, symmetry.text(), scale,
                     unit_name(scale), table is not None, reason)


def _why_failed(evidence: Evidence) -> str:
    if evidence.certainty >= LEAST_CERTAINTY:
        return (f"the scan fits, but shows only {100 * evidence.coverage:.0f} % of the part, too little to tell this "
                f"pose from others: scan more of it, or align it by three points")
    return (f"only {100 * evidence.explained:.0f} % of the scan lies on the part and only "
            f"{100 * evidence.coverage:.0f} % of the part is covered at the best pose found")


def _rivals(target: Target, sketch: Sketch, table: Plane | None, best: Hypothesis, verified: Sequence[Hypothesis],
            symmetry: Symmetry) -> list[Hypothesis]:
    """Other poses that fit as well as the best: the part's symmetry, and what else the search found."""
    turned = []
    for pose, exact in zip(symmetry.motions, symmetry.exact, strict=True):
        if exact:
            turned.append(Hypothesis(pose @ best.pose, best.evidence, best.normals, "symmetry of the part"))
    margin = SCORE_MARGIN * (1.0 - best.evidence.score)
    place = sketch.points.mean(axis=0)
    rivals: list[Hypothesis] = []
    found = [v for v in verified if v.evidence.score > best.evidence.score - margin]
    for other in [*turned, *sorted(found, key=lambda v: -v.evidence.score)]:
        known = (best, *rivals)
        if _is_new(other.pose, known, place, target.size) and other.reason == "found":
            other = replace(other, pose=polish(target, sketch, other.pose, other.normals))
        if _is_new(other.pose, known, place, target.size):
            rivals.append(other)
    return rivals


def _is_new(pose: Array, known: Sequence[Hypothesis], place: Array, size: float) -> bool:
    return all(angle(pose, other.pose) > SAME_TURN or shift(pose, other.pose, place) > SAME_SHIFT * size
               for other in known)


def failed_alignment(reason: str) -> Alignment:
    return Alignment(np.eye(4), FAILED, 0.0, (), 0.0, 0.0, 0.0, 0.0, 0.0, "", 1.0, "mm", False, reason)
