# SPDX-License-Identifier: LGPL-2.1-or-later
"""A displacement field: vectors at places of the nominal part, and between them."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..errors import InputError
from ..registration.arrays import Array
from ..registration.space import SpaceField, fit

_EXACTNESS, _LEAST_EXACTNESS = 5e-7, 2e-5
"""What a field leaves of the vectors that it goes through: over the size of the part, and in mm (unit: twice what a
rebuilt face leaves of its displacement)."""
_AROUND = 13
"""Vectors around one, itself among them, that tell what it should be like (unit: three times what a plane needs)."""
_MEDIAN_LENGTH = 1.538
"""Median length of a vector of three normal components of standard deviation 1 (theory: chi of three)."""


@dataclass(frozen=True)
class VectorField:
    """Displacements of a part.

    Attributes
    ----------
    positions : (n, 3) places on the nominal part, in mm
    displacements : (n, 3) how far they move, in mm
    sigma : (n,) standard deviations of them in mm, None where nothing is known of them
    faces : (n,) numbers of the faces that the places lie on, from 1 as in "Face1", 0 where unknown; None without any

    Raises
    ------
    InputError : there is no place, the arrays do not go together, or hold what is no number
    """

    positions: Array
    displacements: Array
    sigma: Array | None = None
    faces: NDArray[np.intp] | None = None

    def __post_init__(self) -> None:
        count = len(self.positions)
        if not count:
            raise InputError("The field holds no vector: give one place and its displacement or more.")
        if self.positions.shape != (count, 3) or self.displacements.shape != (count, 3):
            raise InputError("A field has three coordinates and three displacements for every place.")
        for name in ("sigma", "faces"):
            values = getattr(self, name)
            if values is not None and np.shape(values) != (count,):
                raise InputError(f"A field has one {name} for every place: there are {len(values)} for {count}.")
        if not (np.isfinite(self.positions).all() and np.isfinite(self.displacements).all()):
            raise InputError("The field holds coordinates or displacements that are no numbers: leave these rows out.")
        if self.sigma is not None and not (np.isfinite(self.sigma).all() and (self.sigma >= 0).all()):
            raise InputError("The field holds a sigma that is no standard deviation: it is a length of 0 or more.")

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def size(self) -> float:
        """Diagonal of the box around the places, in mm."""
        return float(np.linalg.norm(np.ptp(self.positions, axis=0)))

    @property
    def largest(self) -> float:
        """Largest displacement in mm."""
        return float(np.linalg.norm(self.displacements, axis=1).max())

    def at(self, points: Array) -> Array:
        """The displacement at any points near the part, (n, 3) to (n, 3) in mm: smooth, and through all vectors."""
        return self.in_space(points)

    @property
    def exactness(self) -> float:
        """What the field in space may leave of a vector without sigma, in mm."""
        return max(_EXACTNESS * self.size, _LEAST_EXACTNESS)

    @cached_property
    def in_space(self) -> SpaceField:
        """The smooth field through all vectors, or past them as far as their sigma lets them stand apart."""
        noise = None if self.sigma is None else np.minimum(self.sigma, self._scatter())
        return fit(self.positions, self.displacements, self.exactness, noise)

    def _scatter(self) -> float:
        """Standard deviation in mm by which neighbouring vectors differ: the rest of their sigma they share.

        Of each vector, what a plane through those around it leaves; robustly, over all.
        """
        if len(self) < 2 * _AROUND:
            return 0.0
        near = cKDTree(self.positions).query(self.positions, _AROUND)[1]
        rows = np.concatenate([np.ones((*near.shape, 1)), self.positions[near] - self.positions[:, None]], axis=2)
        told = np.linalg.pinv(rows[:, 1:], rcond=1e-6) @ self.displacements[near[:, 1:]]
        left = np.linalg.norm(self.displacements - told[:, 0], axis=1)
        return float(np.median(left) / _MEDIAN_LENGTH)

    def take(self, which: NDArray[np.bool_] | NDArray[np.intp]) -> VectorField:
        """Only the places that an index or mask array, ``which`` (n,), tells."""
        return VectorField(self.positions[which], self.displacements[which],
                           None if self.sigma is None else self.sigma[which],
                           None if self.faces is None else self.faces[which])
