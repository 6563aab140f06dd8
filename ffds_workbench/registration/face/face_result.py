# SPDX-License-Identifier: LGPL-2.1-or-later
"""What every registration method returns."""
from __future__ import annotations

from dataclasses import dataclass

from ..splines import SplineSurface


@dataclass(frozen=True)
class FaceRegistration:
    """The registration of one face.

    Attributes
    ----------
    name : "Face6"
    displacement : d(u, v) in mm over the face's own (u, v); its control points are the paper's ΔP̃ (Eq. 4)
    points : scan points that carried weight in the solution
    coverage : share of the face's area that the scan observes, 0…1
    noise : standard deviation of the scan about the deformed face in mm, robust (1.4826 × median absolute deviation)
    """

    name: str
    displacement: SplineSurface
    points: int
    coverage: float
    noise: float

    @property
    def lattice(self) -> tuple[int, int]:
        """(N_i, N_j), the number of control points in u and in v."""
        rows, columns = self.displacement.control_points.shape[:2]
        return rows, columns
