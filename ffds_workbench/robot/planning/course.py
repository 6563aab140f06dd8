# SPDX-License-Identifier: LGPL-2.1-or-later
"""What has to be welded, before anything is known of how the torch is held."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...registration.arrays import Array


@dataclass(frozen=True)
class Course:
    """What has to be welded: stations in the frame of the model.

    Attributes
    ----------
    torch : (n, 3, 3) the seam's torch frames, x along the travel
    positions : (n, 3) in mm
    velocities : (n − 1,) in mm/s, from each station to the next
    """

    torch: Array
    positions: Array
    velocities: Array

    @property
    def times(self) -> Array:
        """(n − 1,) seconds from each station to the next."""
        result: Array = np.linalg.norm(np.diff(self.positions, axis=0), axis=1) / self.velocities
        return result

    @property
    def turning(self) -> Array:
        """(n − 1,) angle in rad by which the torch frame turns from each station to the next."""
        return Rotation.from_matrix(np.swapaxes(self.torch[:-1], 1, 2) @ self.torch[1:]).magnitude()
