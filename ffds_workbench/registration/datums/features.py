# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a datum face is: a plane, the axis of a cylinder, the centre of a sphere; and how far points lie off it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import Array


class DatumFeature(Protocol):
    """A nominal feature, in mm."""

    @property
    def free_size(self) -> bool:
        """Whether the feature has a radius, which the datum leaves to the part: only its axis or centre counts."""

    def distance(self, points: Array) -> Array:
        """Signed distances of points (n, 3) from the plane, axis or centre: (n,)."""

    def direction(self, points: Array) -> Array:
        """In which the distance of points (n, 3) grows: unit vectors (n, 3)."""


@dataclass(frozen=True)
class PlaneFeature:
    """A plane through a ``point`` (3,), with a unit ``normal`` (3,); it has no ``free_size``."""

    point: Array
    normal: Array
    free_size: bool = False

    def distance(self, points: Array) -> Array:
        """Signed distances of points (n, 3): (n,) in mm."""
        return np.asarray((points - self.point) @ self.normal)

    def direction(self, points: Array) -> Array:
        """In which the distance of points (n, 3) grows: (n, 3)."""
        return np.broadcast_to(self.normal, points.shape)


@dataclass(frozen=True)
class CylinderFeature:
    """The ``axis`` of a cylinder, a unit direction (3,) through a ``point`` (3,); its radius is a ``free_size``."""

    point: Array
    axis: Array
    free_size: bool = True

    def _across(self, points: Array) -> Array:
        arm = points - self.point
        return np.asarray(arm - np.outer(arm @ self.axis, self.axis))

    def distance(self, points: Array) -> Array:
        """Signed distances of points (n, 3): (n,) in mm."""
        return np.asarray(np.linalg.norm(self._across(points), axis=1))

    def direction(self, points: Array) -> Array:
        """In which the distance of points (n, 3) grows: (n, 3)."""
        across = self._across(points)
        return np.asarray(across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12))


@dataclass(frozen=True)
class SphereFeature:
    """The centre of a sphere, a ``point`` (3,); its radius is a ``free_size``."""

    point: Array
    free_size: bool = True

    def distance(self, points: Array) -> Array:
        """Signed distances of points (n, 3): (n,) in mm."""
        return np.asarray(np.linalg.norm(points - self.point, axis=1))

    def direction(self, points: Array) -> Array:
        """In which the distance of points (n, 3) grows: (n, 3)."""
        arm = points - self.point
        return np.asarray(arm / np.maximum(np.linalg.norm(arm, axis=1, keepdims=True), 1e-12))
