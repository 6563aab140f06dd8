# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small rigid motions of a part: six numbers, turns first, about a middle and over a length so that all are in mm."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from ..registration.arrays import Array

FREE = np.eye(6)
"""All motions, as columns."""
SHIFTS = np.eye(6)[:, 3:]
"""Motions without a turn."""


@dataclass(frozen=True)
class Frame:
    """Where a part lies.

    Attributes
    ----------
    middle : (3,) what it turns about, in mm
    length : its size in mm; a turn by one unit moves what is so far from the middle by 1 mm
    rotation, shift : the motion so far, x ↦ R (x − middle) + middle + shift
    """

    middle: Array
    length: float
    rotation: Array = field(default_factory=lambda: np.eye(3))
    shift: Array = field(default_factory=lambda: np.zeros(3))

    def __call__(self, points: Array) -> Array:
        """Points (…, 3) moved along."""
        return np.asarray((points - self.middle) @ self.rotation.T + self.middle + self.shift)

    def moved(self, motion: Array) -> Frame:
        """After a further ``motion`` (6,)."""
        turn = Rotation.from_rotvec(motion[:3] / self.length).as_matrix()
        return Frame(self.middle, self.length, turn @ self.rotation, turn @ self.shift + motion[3:])

    def jacobian(self, points: Array, directions: Array) -> Array:
        """Change (n, 6) of directions (n, 3) · points (n, 3) with a motion."""
        return np.hstack([np.cross(points - self.middle, directions) / self.length, directions])

    def vector_jacobian(self, points: Array, projections: Array) -> Array:
        """Change (n, 3, 6) of ``projections`` (n, 3, 3) of points (n, 3) with a motion."""
        turned = np.stack([np.cross(axis, points - self.middle) for axis in np.eye(3)], axis=2) / self.length
        return np.concatenate([projections @ turned, projections], axis=2)
