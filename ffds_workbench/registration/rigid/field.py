# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth displacement of space, polynomial in the place, fitted to the heights of points over faces."""
from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from ..splines import Array
from .fine import quantile, tukey

_STRAIN_POINTS = 200
_LEAST = 1e-6
"""Least spread of points that is reckoned with, as a share of the part's size."""
_ROUNDS = 2
"""Of weights by what the last fit left."""


@dataclass(frozen=True)
class Freedom:
    """Displacements of space that are allowed.

    Attributes
    ----------
    degree : of the polynomials
    ridge : holds them at zero
    stretch : a surface that stretches by 1 costs as much as so many mm of height, at as many points; 0 for nothing
    """

    degree: int
    ridge: float
    stretch: float = 0.0


STIFF = Freedom(2, 1e-2)
"""Tells the part from another one."""
SOFT = Freedom(3, 1e-3, 0.63)
"""Follows a deformed part; the surface stretches little, or bumps that no polynomial has would let it slide."""


@dataclass(frozen=True)
class Pulls:
    """Displacements wanted at places in one direction each, beside those along the normals.

    Attributes
    ----------
    places, directions : (k, 3) in mm and unit vectors
    wanted, left : (k,) in mm: the whole displacement, and how much of it is not reached yet
    weight : (k,) 1/mm²
    cutoff : least cut-off in mm of Tukey's weights
    share : weight against points whose spread is theirs
    """

    places: Array
    directions: Array
    wanted: Array
    left: Array
    weight: Array
    cutoff: float
    share: float

    def weights(self, left: Array, spread: float) -> Array:
        """(k,), with what is left of each in mm and the standard deviation of the points in mm."""
        if not len(left):
            return left
        cutoff = max(4.0 * 1.4826 * quantile(np.abs(left), 0.5), self.cutoff)
        return self.share * spread**2 * self.weight * tukey(left, cutoff)


@dataclass(frozen=True)
class Field:
    """Displacement d(x) = Σ c_k m_k(x), with monomials m_k in (x − middle) / half.

    Attributes
    ----------
    middle, half : (3,) and a length in mm
    powers : the axes whose product each monomial is
    coefficients : (k, 3) in mm
    """

    middle: Array
    half: float
    powers: tuple[tuple[int, ...], ...]
    coefficients: Array

    @classmethod
    def still(cls, points: Array, size: float, degree: int) -> Field:
        """No displacement, in monomials up to the degree about points (n, 3) of a part of that size."""
        powers = tuple(power for d in range(degree + 1) for power in combinations_with_replacement(range(3), d))
        return cls(points.mean(axis=0), 0.5 * size, powers, np.zeros((len(powers), 3)))

    def __call__(self, points: Array) -> Array:
        """Displacement at points (n, 3) in mm."""
        return self.monomials(points) @ self.coefficients

    def monomials(self, points: Array) -> Array:
        """(n, k) at points (n, 3)."""
        x = (points - self.middle).T / self.half
        result = np.ones((len(self.powers), len(points)))
        for number, power in enumerate(self.powers[1:], start=1):
            result[number] = result[self.powers.index(power[:-1])] * x[power[-1]]
        return result.T

    def strain(self, points: Array, tangents: Array) -> Array:
        """Rows (3n, 3k) of the strain ε₁₁, ε₂₂, √2 ε₁₂ in tangent planes with frames (n, 2, 3), to first order."""
        x = (points - self.middle) / self.half
        gradient = np.zeros((len(points), len(self.powers), 3))
        for number, power in enumerate(self.powers):
            for axis in set(power):
                rest = list(power)
                rest.remove(axis)
                gradient[:, number, axis] = power.count(axis) * x[:, rest].prod(axis=1) / self.half
        first, second = (np.einsum("nka,na->nk", gradient, tangents[:, i])[:, :, None] for i in (0, 1))
        t, s = tangents[:, None, 0], tangents[:, None, 1]
        return np.concatenate([rows.reshape(len(points), -1)
                               for rows in (first * t, second * s, np.sqrt(0.5) * (first * s + second * t))])


def fit_field(points: Array, normal: Array, wanted: Array, left: Array, chosen: NDArray[np.bool_], tangents: Array,
              gate: float, size: float, freedom: Freedom, pulls: Pulls | None = None) -> Field:
    """Least-squares field whose normal component is as wanted at the chosen points.

    Points count by how much of it is left to explain, within the gate or the spread of all, if that is wider.

    Parameters
    ----------
    points, normal : (n, 3) in mm, and unit vectors
    wanted, left : (n,) in mm: the whole displacement along the normals, and how much of it is not reached yet
    chosen : (n,)
    tangents : (n, 2, 3) orthonormal frames of the faces at the points
    gate : in mm
    size : of the part in mm
    freedom : of the field
    pulls : what is wanted besides
    """
    count, field = len(points), Field.still(points, size, freedom.degree)
    places, ways = points, normal
    if pulls is not None:
        places, ways = np.concatenate([points, pulls.places]), np.concatenate([normal, pulls.directions])
        wanted, left = np.concatenate([wanted, pulls.wanted]), np.concatenate([left, pulls.left])
    rows = (field.monomials(places)[:, :, None] * ways[:, None, :]).reshape(len(places), -1)
    if chosen.sum() < 2 * rows.shape[1]:
        return field
    fixed = np.zeros((rows.shape[1],) * 2)
    if freedom.stretch:
        some = np.arange(0, count, 1 + count // _STRAIN_POINTS)
        strain = field.strain(points[some], tangents[some])
        fixed += freedom.stretch**2 * count / len(some) * (strain.T @ strain)
    for _ in range(_ROUNDS):
        spread = max(1.4826 * quantile(np.abs(left[:count][chosen]), 0.5), _LEAST * size)
        weight = chosen * tukey(left[:count], max(4.0 * spread, gate))
        ridge = freedom.ridge * weight.sum() / 30.0 + 1e-12
        if pulls is not None:
            weight = np.concatenate([weight, pulls.weights(left[count:], spread)])
        weighted = rows * weight[:, None]
        matrix = weighted.T @ rows + fixed
        matrix.flat[:: len(matrix) + 1] += ridge
        coefficients = np.linalg.solve(matrix, weighted.T @ wanted)
        left = wanted - rows @ coefficients
    return replace(field, coefficients=coefficients.reshape(-1, 3))
