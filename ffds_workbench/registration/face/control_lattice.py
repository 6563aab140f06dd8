# SPDX-License-Identifier: LGPL-2.1-or-later
"""The control lattice of a displacement field on a face: its knots, and which of its control points are free.

In a closed direction the lattice is periodic; opposite sides that are one curve in space, and the row at a pole, share
their control points, so that a displacement never tears a face apart.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..splines import DEGREE, SplineSurface, basis_matrix, clamped_knots

Index = NDArray[np.intp]

_COINCIDENT = 1e-6
"""Control points of a nominal surface nearer to each other than this, in mm, are one point (unit: ten times the
precision of Open CASCADE)."""


@dataclass(frozen=True)
class ControlLattice:
    """Cubic tensor-product basis for displacements over a face's (u, v).

    Attributes
    ----------
    knots_u, knots_v : flat knot vectors of the stored control points
    fold_u, fold_v : (nu,) and (nv,) the row (column) that each stored row (column) repeats; 0 … rows − 1
    unknown : (rows, columns) number of the free control point; a pole row has a single one
    periodic_u, periodic_v : the direction is unrolled as in `splines`
    """

    knots_u: Array
    knots_v: Array
    fold_u: Index
    fold_v: Index
    unknown: Index
    periodic_u: bool
    periodic_v: bool

    @property
    def size(self) -> tuple[int, int]:
        """(N_i, N_j), control points in u and v; repeated ones of a periodic direction do not count."""
        return (len(self.fold_u) - DEGREE * self.periodic_u, len(self.fold_v) - DEGREE * self.periodic_v)

    @property
    def free(self) -> int:
        """Number of free control points."""
        return int(self.unknown.max()) + 1

    @property
    def is_tensor(self) -> bool:
        """True without poles: every (row, column) is a control point of its own, so that B is a Kronecker product."""
        return self.free == self.unknown.size

    def basis_u(self, u: Array, derivative: int = 0) -> Array:
        """Basis functions of the rows at u (n,), or a ``derivative`` of them: (n, rows); repeated rows added up."""
        return sum_repeated(basis_matrix(self.knots_u, u, derivative=derivative), self.fold_u)

    def basis_v(self, v: Array, derivative: int = 0) -> Array:
        """Basis functions of the columns at v (n,), or a ``derivative`` of them: (n, columns); repeated columns added
        up."""
        return sum_repeated(basis_matrix(self.knots_v, v, derivative=derivative), self.fold_v)

    def field(self, free_points: Array) -> SplineSurface:
        """The displacement with these ``free_points``, (free, 3) in mm."""
        points = free_points[self.unknown][np.ix_(self.fold_u, self.fold_v)]
        return SplineSurface(self.knots_u, self.knots_v, points,
                             periodic_u=self.periodic_u, periodic_v=self.periodic_v)


def displacement_lattice(surface: SplineSurface, size: tuple[int, int]) -> ControlLattice:
    """Uniform cubic control lattice over the parameter range of a nominal surface.

    Parameters
    ----------
    surface : the face's surface in its own (u, v)
    size : (N_i, N_j), control points in u and v, at least 4 each; repeated ones of a closed direction do not count

    Raises
    ------
    ValueError
        A number is below 4.
    """
    if min(size) <= DEGREE:
        raise ValueError(f"a cubic control lattice needs at least 4 × 4 control points, not {size[0]} × {size[1]}")
    u0, u1, v0, v1 = surface.range
    points = surface.control_points
    knots_u, fold_u = _direction(u0, u1, size[0], surface.periodic_u, _same(points[0], points[-1]))
    knots_v, fold_v = _direction(v0, v1, size[1], surface.periodic_v, _same(points[:, 0], points[:, -1]))
    unknown = np.arange((fold_u.max() + 1) * (fold_v.max() + 1)).reshape(fold_u.max() + 1, fold_v.max() + 1)
    poles = [(k, end) for k, periodic in enumerate((surface.periodic_u, surface.periodic_v)) if not periodic
             for end in (0, -1) if _same(np.take(points, end, axis=k), np.take(points, end, axis=k)[:1])]
    for axis, end in poles:
        row = np.moveaxis(unknown, axis, 0)[end]
        row[:] = row.min()
    if poles:
        unknown = np.unique(unknown, return_inverse=True)[1].reshape(unknown.shape)
    return ControlLattice(knots_u, knots_v, fold_u, fold_v, unknown, surface.periodic_u, surface.periodic_v)


def periodic_knots(start: float, end: float, count: int) -> Array:
    """Uniform knot vector of a closed direction: ``count`` control points, unrolled; (count + 2·degree + 1,)."""
    step = (end - start) / count
    return start + step * np.arange(-DEGREE, count + DEGREE + 1)


def _direction(start: float, end: float, count: int, periodic: bool, closed: bool) -> tuple[Array, Index]:
    if periodic:
        return periodic_knots(start, end, count), np.arange(count + DEGREE) % count
    fold = np.arange(count)
    if closed:
        fold[-1] = 0
    return clamped_knots(start, end, count), fold


def sum_repeated(basis: Array, fold: Index) -> Array:
    """Columns of repeated control points added up: (n, stored) to (n, free)."""
    if len(fold) == fold.max() + 1:
        return basis
    result = np.zeros((len(basis), int(fold.max()) + 1))
    np.add.at(result.T, fold, basis.T)
    return result


def _same(a: Array, b: Array) -> bool:
    return bool(np.abs(a - b).max() < _COINCIDENT)
