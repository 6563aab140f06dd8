# SPDX-License-Identifier: LGPL-2.1-or-later
"""Does a pose explain the scan, and the scan the part? Judged against the model, independently of the search."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array
from ..motions import apply
from ..scan_points import Sketch, TablePlane, workers
from .deformation import DisplacementField, Match, match_deformed
from .model import Target
from .settings import Rounds

_LEAST_EXPLAINED = 12
"""Points below which nothing is covered (theory: two for each degree of freedom)."""


@dataclass(frozen=True)
class UnalignedScan:
    """A scan that may show the part, in an unknown pose.

    Attributes
    ----------
    target : the part
    sketch : even points of the scan, without the table
    table : the plane beside the part, scan coordinates, or None
    """

    target: Target
    sketch: Sketch
    table: TablePlane | None

    @property
    def hides_sides(self) -> bool:
        """Whether the noise is so large that normals and the sides of sheets are guesses."""
        return self.sketch.noise > self.target.settings.evidence.hiding_noise * self.target.size

    @property
    def coarse(self) -> UnalignedScan:
        """The same before a part with a quarter of the samples."""
        return replace(self, target=self.target.coarse)

    def every(self, stride: int) -> UnalignedScan:
        """The same of fewer points, one of every ``stride``."""
        return self if stride == 1 else replace(self, sketch=self.sketch.every(stride))


@dataclass(frozen=True)
class Evidence:
    """What speaks for a pose.

    Attributes
    ----------
    explained : share of the scan (table left out) that lies on the part with matching normals
    misfit : mean distance of the scan from the part after a smooth deformation is allowed for, less the noise, capped
        and as a share of the cap: 0 is perfect, 1 is nothing
    coverage : share of the part's visible surface that the scan shows
    missing : area that cameras at the inferred views should have seen and did not, as a share of what they saw
    pierced : share of the part that would lie behind the table
    bent : root mean square of the smooth deformation, as a share of the part's size
    score : rank among poses, larger is better, 1 is perfect
    """

    explained: float
    misfit: float
    coverage: float
    missing: float
    pierced: float
    bent: float
    score: float

    @property
    def certainty(self) -> float:
        """Mean of the score and of the share explained, 1 is perfect: it distinguishes the part from other ones."""
        return 0.5 * (self.score + self.explained)


def match_scan(scan: UnalignedScan, pose: Array, normals: Array, rounds: Rounds,
               start: DisplacementField | None = None) -> tuple[Match, DisplacementField]:
    """The scan at a ``pose`` (4, 4), with outward ``normals`` (n, 3) of its sketch in model coordinates, matched with
    the part in ``rounds`` of a smooth deformation that goes on from ``start``; see ``match_deformed``."""
    reach = 2.0 * scan.target.settings.deformation.reach * scan.target.size
    # under large noise a smooth deformation could not be told from a wrong pose
    return match_deformed(scan.target, apply(pose, scan.sketch.points), normals, reach,
                          () if scan.hides_sides else rounds, start)


def weigh_match(scan: UnalignedScan, pose: Array, normals: Array, found: Match) -> Evidence:
    """What a match says of a pose.

    Parameters
    ----------
    pose : (4, 4), T_model_scan
    normals : (n, 3) outward normals of the sketch in model coordinates
    found : the scan matched with the part at that pose
    """
    target, settings = scan.target, scan.target.settings.evidence
    agree, explained, misfit = _explained(scan, normals, found)
    coverage, missing = _coverage(target, found.points[explained], normals[explained], scan.sketch)
    pierced = 0.0
    if scan.table is not None:
        in_scan = apply(np.linalg.inv(pose), target.even.points)
        depth = max(scan.table.below, settings.below_table * target.size)
        pierced = float(np.mean(scan.table.heights(in_scan) < -depth))
    off = (apply(pose, scan.sketch.points) - found.points)[agree]
    bent = float(np.sqrt(np.mean(off**2) * 3.0)) / target.size if agree.any() else 0.0
    score = (1.0 - misfit - settings.missing_weight * min(missing, 1.0) - settings.pierced_weight * pierced
             - settings.bent_weight * bent)
    return Evidence(float(explained.mean()), misfit, coverage, missing, pierced, bent, score)


def misfit_of(scan: UnalignedScan, normals: Array, found: Match) -> float:
    """The misfit alone of the evidence that ``weigh_match`` gives."""
    return _explained(scan, normals, found)[2]


def _explained(scan: UnalignedScan, normals: Array, found: Match) -> tuple[NDArray[np.bool_], NDArray[np.bool_], float]:
    """Which points face as the part does, which of them lie on it, and the misfit of all."""
    target, noise, settings = scan.target, scan.sketch.noise, scan.target.settings.evidence
    beside = _distance_beyond_faces(target, found.points, found.nearest, found.height, found.normal)
    agree = np.isfinite(found.distance) & (np.einsum("ni,ni->n", normals, found.normal) > settings.agreeing_cosine)
    cap = max(settings.cap * target.size, settings.cap_sigmas * noise)
    distance = np.where(agree, np.hypot(found.height, beside), cap + noise)
    return agree, agree & (distance < cap), float(np.clip((distance - noise) / cap, 0.0, 1.0).mean())


def _distance_beyond_faces(target: Target, points: Array, nearest: NDArray[np.intp], height: Array,
                           normal: Array) -> Array:
    """Distance in mm along the surface from where the face ends to points that lie beyond; (n,)."""
    along = points - target.samples.points[nearest] - height[:, None] * normal
    gap = np.maximum(np.linalg.norm(along, axis=1) - target.settings.evidence.rim_spacings * target.spacing, 0.0)
    beyond = target.overshoot(points, nearest, target.settings.deformation.reach * target.size)[0]
    return np.maximum(gap, beyond)


def _coverage(target: Target, points: Array, normals: Array, sketch: Sketch) -> tuple[float, float]:
    """Coverage of the visible surface, and what the cameras that best explain it ought to have seen besides."""
    samples, settings = target.even, target.settings.evidence
    if len(points) < _LEAST_EXPLAINED:
        return 0.0, 1.0
    reach = max(settings.reach_spacings * sketch.spacing, settings.reach * target.size)
    distance, index = cKDTree(points).query(samples.points, k=settings.neighbours, distance_upper_bound=reach,
                                            workers=workers(samples.points))
    padded = np.concatenate([normals, np.zeros((1, 3))])
    facing = np.einsum("nki,ni->nk", padded[index], samples.normals) > settings.seen_cosine
    covered = (np.isfinite(distance) & facing).any(axis=1)
    seen, worth = np.zeros(len(covered), dtype=bool), np.where(covered, np.float32(1.0), np.float32(-1.0))
    for _ in range(settings.cameras):
        gain = target.sees @ np.where(seen, np.float32(0.0), worth)
        best = int(np.argmax(gain))
        if gain[best] <= settings.least_gain * len(covered):
            break
        seen |= target.visible[best]
    missing = float((seen & ~covered).sum()) / max(float(covered.sum()), 1.0)
    return float(covered.mean()), missing if seen.any() else 1.0
