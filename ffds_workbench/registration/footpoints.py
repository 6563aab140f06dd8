# SPDX-License-Identifier: LGPL-2.1-or-later
"""Foot points: the (u, v) of the surface point below a scan point, and the signed height of the scan point over it."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .raster import Raster
from .splines import Array, SplineSurface

Index = NDArray[np.intp]
Located = tuple[Array, Array, Array, NDArray[np.bool_]]
"""Cell coordinates x and y, height in mm, and whether they are to be trusted."""

_CHUNK = 8192
_MOST_VOXELS = 262144
_LONGEST_STEP = 4.0
_LEAST_SPREAD = 0.2
"""Foot points closer to the centre of curvature than this share of the radius are not unique enough to be used."""
_UNKNOWN, _FAR = -2, -1
_SETTLED = 1.5
"""A foot point this many cells from the frame it was found in is not trusted."""


@dataclass(frozen=True)
class SurfaceCoordinates:
    """The scan points near a face in the face's own coordinates.

    Attributes
    ----------
    index : (k,) into the scan
    x, y : (k,) parameters of the foot points, counted in cells of the raster
    height : (k,) in mm, positive out of the material
    """

    index: Index
    x: Array
    y: Array
    height: Array

    def on_face(self, raster: Raster, margin: float) -> SurfaceCoordinates:
        """Those whose foot point lies inside the trims, at least ``margin`` mm from them."""
        cell = raster.cell(self.x, self.y)
        i, j = np.divmod(cell, raster.shape[1])
        slope_x, slope_y = raster.gradient(raster.depth)
        depth = raster.depth[cell] + slope_x[cell] * (self.x - i - 0.5) + slope_y[cell] * (self.y - j - 0.5)
        return self._part(np.flatnonzero(depth >= margin))

    def sample(self, most: int) -> SurfaceCoordinates:
        """At most ``most`` of them, drawn at random but always the same."""
        if len(self.x) <= most:
            return self
        return self._part(np.random.default_rng(0).integers(len(self.x), size=most))

    def _part(self, rows: Index) -> SurfaceCoordinates:
        return SurfaceCoordinates(self.index[rows], self.x[rows], self.y[rows], self.height[rows])


def surface_coordinates(raster: Raster, points: Array, reach: float) -> SurfaceCoordinates:
    """Foot points of all scan points within ``reach`` of the face's parameter range, linear in the scan.

    Parameters
    ----------
    points : (n, 3) in mm
    reach : largest |height| in mm

    Notes
    -----
    An affine surface has a closed form. On others each point takes the cell nearest to its voxel and makes Newton steps
    in the quadratic frames of the cells, the last one in the cell it ends in: the height is right to third order of the
    cell size.
    """
    locate = _locate_flat if raster.flat else _curved_locator(raster, reach)
    margin = reach + raster.size.max()
    low, high = raster.position.min(axis=0) - margin, raster.position.max(axis=0) + margin
    kept = []
    for first in range(0, len(points), _CHUNK):
        chunk = np.ascontiguousarray(points[first : first + _CHUNK].T)
        near = np.ones(chunk.shape[1], dtype=bool)
        for a, lowest, highest in zip(chunk, low, high, strict=True):
            near &= (a >= lowest) & (a <= highest)
        index = np.flatnonzero(near)
        if not len(index):
            continue
        x, y, height, valid = locate(raster, chunk.take(index, axis=1))
        valid &= np.abs(height) <= reach
        for a, count, periodic in zip((x, y), raster.shape, raster.periodic, strict=True):
            if not periodic:
                valid &= (a >= 0) & (a < count)
        kept.append((index[valid] + first, x[valid], y[valid], height[valid]))
    if not kept:
        kept.append((np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0), np.zeros(0)))
    index, x, y, height = (np.concatenate(column) for column in zip(*kept, strict=True))
    return SurfaceCoordinates(index, raster.wrapped(x, 0), raster.wrapped(y, 1), height)


def _locate_flat(raster: Raster, points: Array) -> Located:
    tangents = np.stack([raster.tangent_u[0], raster.tangent_v[0]])
    to_cells = np.vstack([np.linalg.pinv(tangents).T, raster.normal[0]])
    x, y, height = to_cells @ (points - raster.position[0][:, None])
    return x + 0.5, y + 0.5, height, np.ones(points.shape[1], dtype=bool)


def _curved_locator(raster: Raster, reach: float) -> Callable[[Raster, Array], Located]:
    """A function that seeds each point with the cell nearest to its voxel; voxels are looked up once, when first met."""
    tree = cKDTree(raster.position)
    margin = reach + 2 * raster.size.max()
    low = raster.position.min(axis=0) - margin
    extent = raster.position.max(axis=0) + margin - low
    edge = max((np.prod(extent) / _MOST_VOXELS) ** (1 / 3), 2 * raster.size.min())
    count = np.ceil(extent / edge).astype(np.intp)
    farthest = margin + edge
    seeds = np.full(int(np.prod(count)), _UNKNOWN, dtype=np.intp)

    def locate(raster: Raster, points: Array) -> Located:
        i, j, k = ((points - low[:, None]) * (1 / edge)).astype(np.intp)
        voxel = (i * count[1] + j) * count[2] + k
        cell = seeds.take(voxel)
        new = np.unique(voxel[cell == _UNKNOWN])
        if len(new):
            centre = low + edge * (np.stack(np.unravel_index(new, tuple(count)), axis=1) + 0.5)
            distance, nearest = tree.query(centre)
            seeds[new] = np.where(distance <= farthest, nearest, _FAR)
            cell = seeds.take(voxel)
        near = np.flatnonzero(cell >= 0)
        if len(near) == len(cell):
            return newton_in_cells(raster, points, cell)
        x, y, height = (np.full(len(cell), np.inf) for _ in range(3))
        valid = np.zeros(len(cell), dtype=bool)
        x[near], y[near], height[near], valid[near] = newton_in_cells(raster, points.take(near, axis=1), cell[near])
        return x, y, height, valid

    return locate


def newton_in_cells(raster: Raster, points: Array, cell: Index, steps: int = 2) -> Located:
    """Foot points from the quadratic frames of the cells.

    Parameters
    ----------
    points : (3, n) in mm
    cell : (n,) the cell to start from

    Returns
    -------
    x, y, height : (n,) cell coordinates and signed height in mm
    valid : (n,) the foot point settled near its last cell, on this side of the centre of curvature

    Notes
    -----
    In the principal frame of a cell, with (x₁, x₂, z) the point and k₁, k₂ the curvatures, the foot point is at
    sᵢ = xᵢ / (1 − z kᵢ) and the height z − ½ Σ kᵢ xᵢ sᵢ, up to third order.
    """
    n = raster.shape[1]
    for _ in range(steps):
        c = raster.table.take(cell, axis=1)
        r = points - c[0:3]
        x1, x2, z = (r[0] * c[k] + r[1] * c[k + 1] + r[2] * c[k + 2] for k in (3, 6, 9))
        spread1, spread2 = 1 - z * c[12], 1 - z * c[13]
        unique = np.minimum(spread1, spread2) > _LEAST_SPREAD
        s1, s2 = x1 / np.maximum(spread1, _LEAST_SPREAD), x2 / np.maximum(spread2, _LEAST_SPREAD)
        dx, dy = c[14] * s1 + c[15] * s2, c[16] * s1 + c[17] * s2
        i, j = np.divmod(cell, n)
        x = i + 0.5 + np.clip(dx, -_LONGEST_STEP, _LONGEST_STEP)
        y = j + 0.5 + np.clip(dy, -_LONGEST_STEP, _LONGEST_STEP)
        cell = _clipped(raster, x, 0) * n + _clipped(raster, y, 1)
    height = z - 0.5 * (c[12] * x1 * s1 + c[13] * x2 * s2)
    return x, y, height, unique & (np.maximum(np.abs(dx), np.abs(dy)) <= _SETTLED)


def _clipped(raster: Raster, x: Array, axis: int) -> Index:
    count = raster.shape[axis]
    i = np.floor(x).astype(np.intp)
    return np.mod(i, count) if raster.periodic[axis] else np.clip(i, 0, count - 1)
