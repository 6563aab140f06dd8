# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boxes and cylinders, and exact distances from them."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...registration.arrays import Array


class Solid(Protocol):
    """Anything that distances can be measured from."""

    def distances(self, points: Array) -> Array:
        """Signed distances (n,) in mm of points (n, 3), negative inside."""


@dataclass(frozen=True)
class Box:
    """A box between two corners (3,) of its own frame, whose pose (4, 4) is that in the model's frame."""

    low: Array
    high: Array
    pose: Array

    def distances(self, points: Array) -> Array:
        """See `Solid`."""
        own = (points - self.pose[:3, 3]) @ self.pose[:3, :3]
        beyond = np.maximum(self.low - own, own - self.high)
        result: Array = np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)
        return result


@dataclass(frozen=True)
class Cylinder:
    """A cylinder with flat ends at ``start`` and ``end`` (3,), in mm in the frame of the model."""

    start: Array
    end: Array
    radius: float

    def distances(self, points: Array) -> Array:
        """See `Solid`."""
        axis = self.end - self.start
        length = np.linalg.norm(axis)
        along = (points - self.start) @ axis / length
        across = np.linalg.norm(points - self.start - along[:, None] * axis / length, axis=1)
        beyond = np.stack([across - self.radius, np.abs(along - 0.5 * length) - 0.5 * length], axis=1)
        result: Array = np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)
        return result
