# SPDX-License-Identifier: LGPL-2.1-or-later
"""A uniform tri-cubic B-spline lattice in space: the classical free-form deformation, of class C2.

Owns the evaluation of such a field and its exact refinement; points and vectors in mm.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import map_coordinates
from scipy.sparse import csr_matrix

from ..arrays import Array
from ..splines import cubic

_MARGIN = 2
"""Control points that the lattice has beyond the box on each side (theory: a cubic needs one, and as many for its cells
to be halved)."""


@dataclass(frozen=True)
class SpaceField:
    """d(x) = A (x − origin) + b + Σ c_ijk β(x) β(y) β(z), with cubic B-splines β one cell wide per span.

    Attributes
    ----------
    origin : (3,) where control point 0, 0, 0 stands, in mm
    cell : side of the cells in mm
    control_points : (nx, ny, nz, 3) in mm
    gradient : (3, 3) of the linear part, no unit
    offset : (3,) its value at the origin in mm

    Parameters of the methods
    -------------------------
    points : (n, 3) in mm
    """

    origin: Array
    cell: float
    control_points: Array
    gradient: Array
    offset: Array

    def __call__(self, points: Array) -> Array:
        """Displacements at the points, (n, 3) in mm; beyond the lattice the linear part goes on alone with what its
        border has."""
        linear = (points - self.origin) @ self.gradient.T + self.offset
        return linear + self._spline(self._places(points))

    def _places(self, points: Array) -> Array:
        """Points in cells, kept where all that acts on them is there: (n, 3)."""
        last = np.array(self.control_points.shape[:3]) - 2.0
        return np.clip((points - self.origin) / self.cell, 1.0, last)

    def _spline(self, places: Array) -> Array:
        result = np.empty((len(places), 3))
        for k in range(3):
            map_coordinates(np.ascontiguousarray(self.control_points[..., k]), places.T, result[:, k], order=3,
                            mode="nearest", prefilter=False)
        return result

    def rows(self, points: Array) -> csr_matrix:
        """Weights of the control points at the points, in one sparse row each: (n, nx · ny · nz)."""
        places = self._places(points)
        cells = np.minimum(np.floor(places), np.array(self.control_points.shape[:3]) - 3.0)
        local = places - cells
        weights = [cubic(local[:, k]) for k in range(3)]
        product = np.einsum("ni,nj,nk->nijk", *weights).reshape(len(points), 64)
        shape = self.control_points.shape[:3]
        index = [cells[:, k].astype(np.intp)[:, None] + np.arange(-1, 3) for k in range(3)]
        flat = ((index[0][:, :, None, None] * shape[1] + index[1][:, None, :, None]) * shape[2]
                + index[2][:, None, None, :])
        return csr_matrix((product.ravel(), flat.reshape(-1), np.arange(len(points) + 1) * 64),
                          shape=(len(points), int(np.prod(shape))))

    def plus(self, more: Array) -> SpaceField:
        """With ``more``, (nx · ny · nz, 3), added to the control points."""
        return replace(self, control_points=self.control_points + more.reshape(self.control_points.shape))

    def halved(self) -> SpaceField:
        """The same field on cells of half the side (Lane and Riesenfeld 1980: cubic subdivision)."""
        finer = self.control_points
        for axis in range(3):
            finer = _halved(finer, axis)
        step = np.full(3, self.cell)
        return replace(self, origin=self.origin + step, offset=self.offset + self.gradient @ step,
                       cell=0.5 * self.cell, control_points=finer)

    def scaled(self, factor: float) -> SpaceField:
        """The field times a factor."""
        return replace(self, control_points=factor * self.control_points, gradient=factor * self.gradient,
                       offset=factor * self.offset)


def lattice_over(low: Array, high: Array, cell: float, gradient: Array, value: Array) -> SpaceField:
    """A field without control points moved, whose lattice covers a box.

    Parameters
    ----------
    low, high : (3,) corners of the box in mm
    cell : side of the cells in mm
    gradient, value : (3, 3), and (3,) in mm at ``low``, of the linear part
    """
    cells = np.maximum(np.ceil((high - low) / cell - 1e-9), 1).astype(int)
    origin = low - _MARGIN * cell
    return SpaceField(origin, cell, np.zeros((*(cells + 1 + 2 * _MARGIN), 3)), gradient,
                      value + gradient @ (origin - low))


def _halved(points: Array, axis: int) -> Array:
    """Control points of half the spacing along an axis, from the second one to the last but one: the margin stays."""
    p = np.moveaxis(points, axis, 0)
    finer = np.empty((2 * len(p) - 5, *p.shape[1:]))
    finer[0::2] = (p[:-2] + 6.0 * p[1:-1] + p[2:]) / 8.0
    finer[1::2] = 0.5 * (p[1:-2] + p[2:-1])
    return np.moveaxis(finer, 0, axis)
