# SPDX-License-Identifier: LGPL-2.1-or-later
"""The verdict on a pose: is it good enough, and does another one fit as well?"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..motions import angle, apply, shift
from .alignment_result import AMBIGUOUS, FAILED, OK, Alignment, CandidatePose
from .evidence import Evidence, UnalignedScan
from .hypothesis import Hypothesis
from .polish import polish
from .settings import VerdictSettings
from .symmetry import Symmetry, symmetry_of
from .scan_unit import unit_name


@dataclass(frozen=True)
class Answer:
    """A polished pose (4, 4) with the evidence for it, and the outward normals (n, 3) that it gives the sketch."""

    pose: Array
    evidence: Evidence
    normals: Array


def alignment_of(scan: UnalignedScan, best: Answer, hypotheses: Sequence[Hypothesis], scale: float) -> Alignment:
    """The verdict: is the best pose good enough, and does another one fit as well?

    Parameters
    ----------
    scan : even points of it, and the part
    best : the pose that was chosen
    hypotheses : what else the search found
    scale : factor that was applied to the scan's coordinates
    """
    target, sketch, evidence, settings = scan.target, scan.sketch, best.evidence, scan.target.settings.verdict
    symmetry = symmetry_of(target)
    poses = (CandidatePose(best.pose, evidence.score, "found"), *_rivals(scan, best, hypotheses, symmetry))
    moved = apply(best.pose, sketch.pool[:settings.fitness_points])
    distance, closest = target.tree.query(moved)
    reach = max(settings.fitness_reach * target.size, settings.fitness_sigmas * sketch.noise)
    near = distance < reach
    height = target.heights(moved[near], closest[near])[0] if near.any() else np.zeros(1)
    reason, verdict = "", OK
    if evidence.certainty < settings.least_certainty or evidence.coverage < settings.least_coverage:
        verdict, poses, reason = FAILED, poses[:1], _why_failed(evidence, settings)
    elif len(poses) > 1:
        verdict, reason = AMBIGUOUS, symmetry.text() or "the scan fits equally well in several poses"
    sure = float(np.clip((evidence.certainty - settings.least_certainty) / (1.0 - settings.least_certainty), 0.0, 1.0))
    confidence = sure / (len(poses) if verdict == AMBIGUOUS else 1)
    return Alignment(best.pose, verdict, evidence.certainty, confidence, poses, reach, float(near.mean()),
                     float(np.sqrt(np.mean(height**2))), evidence.explained, evidence.coverage, symmetry.text(), scale,
                     unit_name(scale), scan.table is not None, reason)


def _why_failed(evidence: Evidence, settings: VerdictSettings) -> str:
    if evidence.certainty >= settings.least_certainty:
        return (f"the scan fits, but shows only {100 * evidence.coverage:.0f} % of the part, too little to tell this "
                f"pose from others: scan more of it, or align it by three points")
    return (f"only {100 * evidence.explained:.0f} % of the scan lies on the part and only "
            f"{100 * evidence.coverage:.0f} % of the part is covered at the best pose found")


def _rivals(scan: UnalignedScan, best: Answer, hypotheses: Sequence[Hypothesis], symmetry: Symmetry,
            ) -> list[CandidatePose]:
    """Other poses that fit as well as the best: the part's symmetry, and what else the search found."""
    target, settings, score = scan.target, scan.target.settings.verdict, best.evidence.score
    place = scan.sketch.points.mean(axis=0)

    def is_new(pose: Array) -> bool:
        return all(angle(pose, known) > settings.same_turn
                   or shift(pose, known, place) > settings.same_shift * target.size
                   for known in (best.pose, *(rival.T_model_scan for rival in rivals)))

    rivals: list[CandidatePose] = []
    for motion in symmetry.motions[symmetry.exact]:
        pose = motion @ best.pose
        if not is_new(pose):
            continue
        if symmetry.axis is None:  # the same except for small features, which decide the exact pose
            pose = polish(target, scan.sketch, pose, best.normals @ motion[:3, :3].T)[0]
        rivals.append(CandidatePose(pose, score, "symmetry of the part"))
    for other in sorted(hypotheses, key=lambda one: -one.evidence.score):
        if other.evidence.score > score - settings.score_margin * (1.0 - score) and is_new(other.pose):
            pose = polish(target, scan.sketch, other.pose, other.normals_of(scan.sketch, other.pose))[0]
            if is_new(pose):
                rivals.append(CandidatePose(pose, other.evidence.score, "found"))
    return rivals


def failed_alignment(reason: str) -> Alignment:
    """An alignment that found no pose, for that ``reason``."""
    return Alignment(np.eye(4), FAILED, 0.0, 0.0, (), 0.0, 0.0, 0.0, 0.0, 0.0, "", 1.0, "mm", False, reason)
