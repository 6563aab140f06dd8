# SPDX-License-Identifier: LGPL-2.1-or-later
"""The point cloud as the rest of the program sees it: finite points in mm."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

FARTHEST = 1e12
"""Theory: beyond this a double of 53 bits tells coordinates in mm no closer than 1e-4 apart: no measured position."""


@dataclass(frozen=True)
class PointCloud:
    """A scan, in mm.

    Attributes
    ----------
    points : (n, 3) float64, finite
    dropped : rows of the files that were not finite
    unit : the unit that the files were read in: "mm", "m", "cm" or "in"
    normals : (n, 3) unit vectors that the files hold, zero for points without; None if they hold none. Most
        point to the sensor, but that is not checked
    """

    points: NDArray[np.float64]
    dropped: int = 0
    unit: str = "mm"
    normals: NDArray[np.float64] | None = None

    def moved(self, pose: NDArray[np.float64], scale: float = 1.0) -> PointCloud:
        """The scan multiplied by ``scale`` and then moved by the rigid motion ``pose`` (4, 4), with a shift in mm."""
        rotation, shift = pose[:3, :3], pose[:3, 3]
        return replace(self, points=scale * self.points @ rotation.T + shift,
                       normals=None if self.normals is None else self.normals @ rotation.T)

    def tobytes(self) -> bytes:
        """Differs where points or normals differ."""
        return b"".join(np.ascontiguousarray(rows).tobytes() for rows in (self.points, self.normals)
                        if rows is not None)
