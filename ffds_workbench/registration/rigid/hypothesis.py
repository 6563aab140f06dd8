# SPDX-License-Identifier: LGPL-2.1-or-later
"""A pose refined against the side of the part that the scan shows, with the evidence for it."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..motions import angle, apply, shift
from ..scan_points import Sketch
from .deformation import DisplacementField, Match
from .evidence import Evidence, UnalignedScan, match_scan, misfit_of, weigh_match
from .model import Target
from .polish import is_deformed
from .refine import refine
from .search_settings import Effort, Rung

_GATE, _SECOND_GATE = 0.08, 0.04
"""Sizes, of the refinement of a pose and of the second one after stray normals were flipped (unit: what a deformation
of two thirds of that leaves)."""


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """A pose that may be the right one.

    Attributes
    ----------
    scan : what it was refined and weighed with
    pose : (4, 4), T_model_scan
    signs : (p,) for each of the scan's largest pieces +1 if its normals point out of the part, −1 if into it
    normals : (n, 3) outward normals of the sketch in model coordinates
    match, deformation : the scan matched with the part through that deformation
    """

    scan: UnalignedScan
    pose: Array
    signs: Array
    normals: Array
    match: Match
    deformation: DisplacementField

    @cached_property
    def evidence(self) -> Evidence:
        """What speaks for the pose."""
        return weigh_match(self.scan, self.pose, self.normals, self.match)

    @cached_property
    def misfit(self) -> float:
        """The evidence's misfit alone, which is faster to compute."""
        return misfit_of(self.scan, self.normals, self.match)

    def normals_of(self, sketch: Sketch, pose: Array) -> Array:
        """Outward normals (m, 3) in model coordinates of a ``sketch`` of the same scan at a ``pose`` (4, 4) nearby."""
        if sketch is self.scan.sketch:
            return self.normals @ self.pose[:3, :3] @ pose[:3, :3].T
        return outward_normals(sketch, self.signs) @ pose[:3, :3].T


def refined(scan: UnalignedScan, pose: Array, signs: Array, rung: Rung, effort: Effort) -> Hypothesis:
    """The pose refined against the side of the part that the scan shows, matched in the rung's rounds.

    Parameters
    ----------
    scan : even points of it, and the part
    pose : (4, 4) to start from
    signs : (p,) of the normals of its largest pieces
    rung, effort : how well
    """
    scan = scan.every(rung.stride).coarse
    pose, normals = _on_side(scan, pose, signs, effort)
    if not scan.hides_sides:
        pose, normals = _without_stray_normals(scan, pose, normals, effort.settle_steps)
    return Hypothesis(scan, pose, signs, normals, *match_scan(scan, pose, normals, rung.rounds))


def matched_on(known: Hypothesis, rung: Rung) -> Hypothesis:
    """The ``known`` hypothesis, its deformation continued in the rounds of a ``rung``."""
    match, deformation = match_scan(known.scan, known.pose, known.normals, rung.rounds, known.deformation)
    return replace(known, match=match, deformation=deformation)


def _on_side(scan: UnalignedScan, pose: Array, signs: Array, effort: Effort) -> tuple[Array, Array]:
    """The pose after a few steps, and the outward normals of the sketch in the model's frame."""
    target, gate = scan.target, _GATE * scan.target.size
    some = slice(None, None, effort.refine_stride)
    if scan.hides_sides:
        pose = refine(target, scan.sketch.points[some], pose, (1.5 * gate, gate, 0.5 * gate), 8)
        return pose, target.samples.normals[target.tree.query(apply(pose, scan.sketch.points))[1]]
    normals = outward_normals(scan.sketch, signs)
    pose = refine(target, scan.sketch.points[some], pose, (gate,), effort.refine_steps, normals[some])
    return pose, normals @ pose[:3, :3].T


def outward_normals(sketch: Sketch, signs: Array) -> Array:
    """Normals of the ``sketch``, scan coordinates, with the ``signs`` (p,) of the largest pieces; (n, 3)."""
    return signs[np.where(sketch.piece < len(signs), sketch.piece, 0)][:, None] * sketch.normals


def _without_stray_normals(scan: UnalignedScan, pose: Array, normals: Array, steps: int) -> tuple[Array, Array]:
    """The pose refined in some more steps, and the normals, once those few are turned round whose points then lie on
    the part, and do not as they are."""
    target, settings = scan.target, scan.target.settings.verdict
    near = max(settings.near * target.size, settings.near_sigmas * scan.sketch.noise)
    moved = apply(pose, scan.sketch.points)
    off = np.flatnonzero(_heights(target, moved, normals) > near)
    turned = np.zeros(len(moved), dtype=bool)
    turned[off] = _heights(target, moved[off], -normals[off]) < near
    if not 0.0 < turned.mean() < settings.stray_normals:
        return pose, normals
    flipped = np.where(turned[:, None], -normals, normals)
    closer = refine(target, scan.sketch.points, pose, (_SECOND_GATE * target.size,), steps, flipped @ pose[:3, :3])
    flipped = flipped @ pose[:3, :3] @ closer[:3, :3].T
    # some points of a deformed sheet lie nearer to its far side
    return (pose, normals) if is_deformed(target, scan.sketch, closer, flipped) else (closer, flipped)


def _heights(target: Target, points: Array, normals: Array) -> Array:
    """Distances in mm from the faces that face the same way, infinite where there are none nearby; (n,)."""
    distance, nearest = target.nearest(points, normals, target.settings.verdict.flip_reach * target.size)
    return np.where(np.isfinite(distance), np.abs(target.heights(points, nearest)[0]), np.inf)


def clearly_right(hypotheses: Sequence[Hypothesis], deformed: bool) -> list[Hypothesis]:
    """Those that explain the scan as it is, or where these are ``deformed`` fits, the one that fits far better than all
    others; none where nothing is clear."""
    if not deformed:
        return [one for one in hypotheses if is_good(one.evidence, one.scan.target)
                and not is_deformed(one.scan.target, one.scan.sketch, one.pose, one.normals)]
    ratio = hypotheses[0].scan.target.settings.verdict.clear_misfit
    best, *others = sorted(hypotheses, key=lambda one: one.misfit)
    return [best] if all(best.misfit < ratio * other.misfit for other in others) else []


def is_good(evidence: Evidence, target: Target) -> bool:
    """Whether the ``evidence`` for a pose on the ``target`` is good enough for a quick answer."""
    settings = target.settings.verdict
    return evidence.explained > settings.clear_explained and evidence.certainty > settings.least_certainty


def promising(hypotheses: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Poses that may turn out to be the best, the best first, without duplicates."""
    target = hypotheses[0].scan.target
    settings, best = target.settings.verdict, max(one.evidence.score for one in hypotheses)
    kept: list[Hypothesis] = []
    for one in sorted(hypotheses, key=lambda one: -one.evidence.score):
        known = any(angle(one.pose, other.pose) < settings.settled_turn
                    and shift(one.pose, other.pose, target.centre) < settings.settled_shift * target.size
                    for other in kept)
        if one.evidence.score > best - settings.promising and not known:
            kept.append(one)
    return kept


def choose(hypotheses: Sequence[Hypothesis], prefers: str) -> Hypothesis:
    """The best pose; of those that fit alike the one with the best "score", the one that turns and moves the scan least
    ("turn"), or the one that moves its middle least ("nearest": a start by hand says which side is meant)."""
    target = hypotheses[0].scan.target
    settings, place = target.settings.verdict, hypotheses[0].scan.sketch.points.mean(axis=0)
    best = max(one.evidence.score for one in hypotheses)
    good = [one for one in hypotheses if one.evidence.score >= best - settings.score_margin * (1.0 - best)]
    turn = {id(one): float(angle(one.pose, np.eye(4))) for one in good}
    move = {id(one): float(shift(one.pose, np.eye(4), place)) for one in good}
    if prefers == "nearest":
        return min(good, key=lambda one: move[id(one)])
    if prefers == "turn":
        least = min(turn.values())
        good = [one for one in good if turn[id(one)] < least + settings.same_turn]
        least = min(move[id(one)] for one in good)
        good = [one for one in good if move[id(one)] < least + settings.nearer * target.size]
    return max(good, key=lambda one: one.evidence.score)
