# SPDX-License-Identifier: LGPL-2.1-or-later
"""Least squares on a control lattice: normal matrices of weighted products of basis functions over a grid, banded.

Rows lie on a regular (u, v) grid, so a normal matrix is a sum of Kronecker-like products, Bᵀ W B with one weight per
grid node; neighbouring control points alone interact, and the matrix is solved by a banded Cholesky factorisation.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.linalg.blas import dsbmv

from ...arrays import Array
from ...splines import DEGREE, tensor_product
from ..control_lattice import ControlLattice

Index = NDArray[np.intp]

LEAST_NOISE = 0.1
"""Standard deviation in mm with which points are trusted at the best: noise that neighbours have in common does not
show in residuals (unit: what a scanner of parts of some decimetres shares)."""

_OFFSETS = 2 * DEGREE + 1
"""Basis functions that overlap with one, itself counted (theory)."""


def offset_products(left: Array, right: Array) -> Array:
    """Products of each basis function with its neighbours: (nodes, n) twice to (nodes, n, 7), [:, i, o] = left[:, i] ·
    right[:, i + o − 3]."""
    nodes, n = left.shape
    padded = np.zeros((nodes, n + 2 * DEGREE))
    padded[:, DEGREE : DEGREE + n] = right
    windows = np.lib.stride_tricks.sliding_window_view(padded, _OFFSETS, axis=1)
    return left[:, :, None] * windows


def grid_products(weights: Array, products_u: Array, products_v: Array) -> Array:
    """Σ over the grid of weight × product in u × product in v.

    Parameters
    ----------
    weights : (k, m, n)
    products_u, products_v : from `offset_products`, (m, nu, 7) and (n, nv, 7)

    Returns
    -------
    (k, nu·7, nv·7)
    """
    left = products_u.reshape(len(products_u), -1).T
    right = products_v.reshape(len(products_v), -1)
    (k, m, n), a, b = weights.shape, len(left), right.shape[1]
    if a * n * (m + b) < b * m * (n + a):
        return np.asarray((left @ weights) @ right)
    return np.asarray(left @ (weights.reshape(k * m, n) @ right).reshape(k, m, b))


@dataclass(frozen=True)
class NormalMatrix:
    """Layout of the symmetric matrix of a lattice with ``components`` unknowns per control point.

    Attributes
    ----------
    unknown : (nu, nv, components) number of the unknown of each stored control point
    size, band : number of unknowns, and of superdiagonals
    upper, upper_place : which products of two control points' unknowns, in the order of `grid_products`, lie on or
        above the diagonal, and where in LAPACK's upper banded storage
    both, both_place, both_scale : all products, the place of the entry or of its mirror image above the diagonal, and 2
        on the diagonal, 1 elsewhere
    """

    unknown: Index
    size: int
    band: int
    upper: Index
    upper_place: Index
    both: Index
    both_place: Index
    both_scale: Array

    def symmetric(self, products: Array) -> Array:
        """Banded matrix of products that are symmetric as a whole; (components², nu·7, nv·7) to (band + 1, size)."""
        return self._scattered(self.upper_place, products.ravel().take(self.upper))

    def symmetrised(self, products: Array) -> Array:
        """Banded matrix of products + their transpose; (components², nu·7, nv·7) to (band + 1, size)."""
        return self._scattered(self.both_place, products.ravel().take(self.both) * self.both_scale)

    def right_side(self, values: Array, basis_u: Array, basis_v: Array) -> Array:
        """Bᵀ y for values on the grid, (m, n, components) to (size,)."""
        gathered = tensor_product(basis_u.T, basis_v.T, values)
        return np.asarray(np.bincount(self.unknown.ravel(), gathered.ravel(), self.size), dtype=float)

    def control_points(self, solution: Array) -> Array:
        """Stored control points of a solution, (size,) to (nu, nv, components)."""
        return solution[self.unknown]

    def energy(self, matrix: Array, control_points: Array) -> float:
        """xᵀ A x for stored control points (nu, nv, components) and a banded A."""
        unknowns = np.zeros(self.size)
        unknowns[self.unknown.ravel()] = control_points.ravel()
        return float(unknowns @ dsbmv(self.band, 1.0, matrix, unknowns))

    def _scattered(self, place: Index, values: Array) -> Array:
        flat = np.asarray(np.bincount(place, values, (self.band + 1) * self.size), dtype=float)
        return flat.reshape(self.band + 1, self.size)


def normal_matrix(lattice: ControlLattice, components: int) -> NormalMatrix:
    """Layout for a lattice; the direction that gives the narrower band runs inside."""
    stored = lattice.unknown[np.ix_(lattice.fold_u, lattice.fold_v)]
    numbers = (stored, _renumbered(stored))
    bands = [_largest_distance(number) for number in numbers]
    points = numbers[int(np.argmin(bands))]
    unknown = points[..., None] * components + np.arange(components)
    size = int(points.max() + 1) * components
    band = min((min(bands) + 1) * components - 1, size - 1)
    row, column = _pairs(unknown)
    row, column = row.ravel(), column.ravel()
    low, high = np.minimum(row, column), np.maximum(row, column)
    place = (band + low - high) * size + high
    both = np.flatnonzero(low >= 0)
    upper = both[row[both] <= column[both]]
    scale = np.where(row == column, 2.0, 1.0)
    return NormalMatrix(unknown, size, band, upper, place[upper], both, place[both], scale[both])


def solve_banded(matrix: Array, right_side: Array) -> Array:
    """Solution of a positive definite system in upper banded storage.

    Raises
    ------
    numpy.linalg.LinAlgError
        The matrix is not positive definite.
    """
    return np.asarray(cho_solve_banded((cholesky_banded(matrix, check_finite=False), False), right_side,
                                       check_finite=False))


def _renumbered(stored: Index) -> Index:
    """The same control points numbered column by column."""
    _, first, number = np.unique(stored.T, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.intp)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[number].reshape(stored.T.shape).T


def _largest_distance(number: Index) -> int:
    row, column = _pairs(number[..., None])
    return int(np.abs(row - column)[row >= 0].max())


def _pairs(unknown: Index) -> tuple[Index, Index]:
    """Row and column of all products, (c, c, nu, 7, nv, 7); −1 where the neighbour does not exist."""
    nu, nv, c = unknown.shape
    padded = np.full((nu + 2 * DEGREE, nv + 2 * DEGREE, c), -1, dtype=np.intp)
    padded[DEGREE:-DEGREE, DEGREE:-DEGREE] = unknown
    along_u = np.lib.stride_tricks.sliding_window_view(padded, _OFFSETS, axis=0)
    windows = np.lib.stride_tricks.sliding_window_view(along_u, _OFFSETS, axis=1)  # nu, nv, c, 7, 7
    column = np.broadcast_to(windows.transpose(2, 0, 3, 1, 4)[None], (c, c, nu, _OFFSETS, nv, _OFFSETS))
    row = np.broadcast_to(unknown.transpose(2, 0, 1)[:, None, :, None, :, None], column.shape)
    row = np.where(column >= 0, row, -1)
    return row, column
