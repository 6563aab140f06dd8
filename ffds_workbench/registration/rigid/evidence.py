# SPDX-License-Identifier: LGPL-2.1-or-later
"""Does a pose explain the scan, and the scan the part? Judged against the model, whatever proposed the pose."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array
from ..motions import apply
from ..parallel import workers
from ..scan_sketch import Plane, Sketch
from .deformation import (NO_DEFORMATION_ROUNDS, STIFF_DEFORMATION_ROUNDS, DisplacementField, Match, Rounds,
                          match_deformed)
from .model import Target

_NORMALS_AGREE = 0.6
_HIDING_NOISE = 0.003
"""Noise above this share of the part's size hides which side of a sheet is seen, and small features."""
_CAMERAS, _NEIGHBOURS = 3, 4
"""Number of cameras that are inferred; and number of points near a sample, one of which has to face as the sample does:
the nearest may lie on the far side of a sheet."""
_DEFORMATION_PENALTY = 6.0
"""Penalty on the score per deformation relative to the part's size: bending another part into this one by 4 % costs
0.24."""
_DEFORMATION_REACH = 0.06
"""How far the smooth deformation may reach, as a share of the part's size."""


@dataclass(frozen=True)
class Evidence:
    """What speaks for a pose.

    Attributes
    ----------
    explained : share of the scan (table left out) that lies on the part with matching normals
    misfit : mean distance of the scan from the part after a smooth deformation is allowed for, less the noise, capped
        and as a share of the cap: 0 is perfect, 1 is nothing
    coverage : share of the part's visible surface that the scan shows
    missing : part that cameras at the inferred views ought to have seen and did not, as a share of what they saw
    pierced : share of the part that would lie behind the table
    bent : root mean square of the smooth deformation, as a share of the part's size
    """

    explained: float
    misfit: float
    coverage: float
    missing: float
    pierced: float
    bent: float

    @property
    def score(self) -> float:
        """Rank among poses, larger is better, 1 is perfect."""
        return 1.0 - self.misfit - 0.5 * min(self.missing, 1.0) - 2.0 * self.pierced - _DEFORMATION_PENALTY * self.bent

    @property
    def certainty(self) -> float:
        """Mean of the score and of what is explained, 1 is perfect: what tells the part from another one."""
        return 0.5 * (self.score + self.explained)


def hides_sides(target: Target, sketch: Sketch) -> bool:
    """Whether the noise is so large that normals and the sides of sheets are guesses."""
    return sketch.noise > _HIDING_NOISE * target.size


def facing_normals(target: Target, points: Array) -> Array:
    """Normals of the part below points (n, 3) in model coordinates, in place of normals that are guesses."""
    return target.samples.normals[target.tree.query(points)[1]]


def weigh_pose(target: Target, sketch: Sketch, pose: Array, normals: Array, table: Plane | None,
               rounds: Rounds = STIFF_DEFORMATION_ROUNDS) -> Evidence:
    """Weigh a pose.

    Parameters
    ----------
    sketch : even points of the scan without the table
    pose : (4, 4), T_model_scan
    normals : (n, 3) outward normals of the sketch in model coordinates
    table : the plane beside the part, scan coordinates
    rounds : of the smooth deformation that is allowed for, see ``match_deformed``
    """
    return weigh_match(target, sketch, pose, normals, table, match_sketch(target, sketch, pose, normals, rounds)[0])


def match_sketch(target: Target, sketch: Sketch, pose: Array, normals: Array, rounds: Rounds,
                 start: DisplacementField | None = None) -> tuple[Match, DisplacementField]:
    """The sketch matched with the part; see ``weigh_pose`` and ``match_deformed``."""
    # under large noise a smooth deformation could not be told from a wrong pose
    return match_deformed(target, apply(pose, sketch.points), normals, 2.0 * _DEFORMATION_REACH * target.size,
                          NO_DEFORMATION_ROUNDS if hides_sides(target, sketch) else rounds, start)


def weigh_match(target: Target, sketch: Sketch, pose: Array, normals: Array, table: Plane | None,
                found: Match) -> Evidence:
    """What a match says of a pose; see ``weigh_pose``."""
    size, moved = target.size, apply(pose, sketch.points)
    agree, explained, misfit = _explained(target, sketch, normals, found)
    coverage, missing = _coverage(target, found.points[explained], normals[explained], sketch)
    pierced = 0.0
    if table is not None:
        in_scan = apply(np.linalg.inv(pose), target.even.points)
        pierced = float(np.mean(table.heights(in_scan) < -max(table.tolerance, 0.04 * size)))
    bent = float(np.sqrt(np.mean((moved - found.points)[agree] ** 2) * 3.0)) / size if agree.any() else 0.0
    return Evidence(float(explained.mean()), misfit, coverage, missing, pierced, bent)


def misfit_of(target: Target, sketch: Sketch, normals: Array, found: Match) -> float:
    """The misfit alone of the evidence that ``weigh_match`` gives."""
    return _explained(target, sketch, normals, found)[2]


def _explained(target: Target, sketch: Sketch, normals: Array, found: Match,
               ) -> tuple[NDArray[np.bool_], NDArray[np.bool_], float]:
    """Which points face as the part does, which of them lie on it, and the misfit of all."""
    beside = _distance_beyond_faces(target, found.points, found.nearest, found.height, found.normal)
    agree = np.isfinite(found.distance) & (np.einsum("ni,ni->n", normals, found.normal) > _NORMALS_AGREE)
    cap = max(0.008 * target.size, 4.0 * sketch.noise)
    distance = np.where(agree, np.hypot(found.height, beside), cap + sketch.noise)
    return agree, agree & (distance < cap), float(np.clip((distance - sketch.noise) / cap, 0.0, 1.0).mean())


def _distance_beyond_faces(target: Target, points: Array, nearest: NDArray[np.intp], height: Array,
                           normal: Array) -> Array:
    """Distance in mm along the surface from where the face ends to points that lie beyond; (n,)."""
    along = points - target.samples.points[nearest] - height[:, None] * normal
    gap = np.maximum(np.linalg.norm(along, axis=1) - 1.5 * target.spacing, 0.0)
    beyond = target.overshoot(points, nearest, _DEFORMATION_REACH * target.size)[0]
    return np.maximum(gap, beyond)


def _coverage(target: Target, points: Array, normals: Array, sketch: Sketch) -> tuple[float, float]:
    """Coverage of the visible surface, and what the cameras that best explain it ought to have seen besides."""
    samples = target.even
    if len(points) < 12:
        return 0.0, 1.0
    reach = max(3.0 * sketch.spacing, 0.025 * target.size)
    distance, index = cKDTree(points).query(samples.points, k=_NEIGHBOURS, distance_upper_bound=reach,
                                            workers=workers(samples.points))
    padded = np.concatenate([normals, np.zeros((1, 3))])
    covered = (np.isfinite(distance) & (np.einsum("nki,ni->nk", padded[index], samples.normals) > 0.5)).any(axis=1)
    seen, worth = np.zeros(len(covered), dtype=bool), np.where(covered, np.float32(1.0), np.float32(-1.0))
    for _ in range(_CAMERAS):
        gain = target.sees @ np.where(seen, np.float32(0.0), worth)
        best = int(np.argmax(gain))
        if gain[best] <= 0.02 * len(covered):
            break
        seen |= target.visible[best]
    missing = float((seen & ~covered).sum()) / max(float(covered.sum()), 1.0)
    return float(covered.mean()), missing if seen.any() else 1.0
