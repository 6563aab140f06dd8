# SPDX-License-Identifier: LGPL-2.1-or-later
"""The answer of the rigid registration."""
from __future__ import annotations

from dataclasses import dataclass

from ..arrays import Array

OK, AMBIGUOUS, FAILED = "ok", "ambiguous", "failed"


@dataclass(frozen=True)
class CandidatePose:
    """One pose in question.

    Attributes
    ----------
    T_model_scan : (4, 4) for the scan in mm
    score : rank among the poses, 1 is perfect
    reason : where it comes from: "found", or the symmetry that maps the best pose to it
    """

    T_model_scan: Array
    score: float
    reason: str


@dataclass(frozen=True)
class Alignment:
    """Where the scan lies on the part.

    Attributes
    ----------
    T_model_scan : (4, 4) for the scan in mm, after ``scale``
    verdict : "ok", "ambiguous" (several poses fit alike: see ``poses``) or "failed"
    certainty : what the verdict rests on, see `Evidence.certainty`; 1 is perfect
    confidence : 0…1, how far the pose is from failing and from the next best one
    poses : the poses that fit equally well, the chosen one first
    reach : distance in mm within which a point counts as on the part
    fitness : share of the scan, table left out, within ``reach`` of the part
    rmse : root mean square distance of those points from the part in mm
    explained : share of the scan, table left out, that lies on the part with matching normals
    coverage : share of the part's visible surface that the scan shows
    symmetry : the part's own symmetry in words, or empty
    scale : factor that was applied to the scan's coordinates
    unit : name of that factor: "m" if the scan was read as mm but is in metres
    table : whether a table plane was found and left out
    reason : one phrase that says why it failed or is ambiguous, or empty
    """

    T_model_scan: Array
    verdict: str
    certainty: float
    confidence: float
    poses: tuple[CandidatePose, ...]
    reach: float
    fitness: float
    rmse: float
    explained: float
    coverage: float
    symmetry: str
    scale: float
    unit: str
    table: bool
    reason: str

    @property
    def text(self) -> str:
        """The verdict in one phrase."""
        if self.verdict == AMBIGUOUS:
            return f"ambiguous ({len(self.poses)} poses): {self.reason}"
        return self.verdict if not self.reason else f"{self.verdict}: {self.reason}"
