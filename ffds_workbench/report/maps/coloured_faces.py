# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces as coloured meshes: the cells of their rasters, with the mean deviation at the corners of the cells."""
from __future__ import annotations

import numpy as np

from ...registration.arrays import Array, Index
from ...registration.footpoints import surface_coordinates
from ...registration.uv_raster import Raster


def corner_values(raster: Raster, points: Array, deviations: Array) -> Array:
    """Mean deviation around each corner of the cells, NaN without data; points (k, 3) in mm that lie on the face."""
    if not len(points):
        return np.full((raster.shape[0] + 1) * (raster.shape[1] + 1), np.nan)
    found = surface_coordinates(raster, points, float(np.abs(deviations).max()) + 1.0)
    return at_corners(raster, found.in_cell[0], deviations[found.index])


def corners(raster: Raster) -> tuple[Array, Array]:
    """Parameters of the cells' corners, (m + 1,) in u and (n + 1,) in v."""
    return (raster.corner[0] + raster.step[0] * np.arange(raster.shape[0] + 1),
            raster.corner[1] + raster.step[1] * np.arange(raster.shape[1] + 1))


def surface_grid(raster: Raster) -> Index:
    """Triangles (k, 3) between the corners of the cells that carry material."""
    m, n = raster.shape
    index = np.arange((m + 1) * (n + 1)).reshape(m + 1, n + 1)
    corner = (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:])
    a, b, c, d = (grid.ravel()[raster.inside] for grid in corner)
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def at_corners(raster: Raster, cell: Index, values: Array) -> Array:
    """Mean at each corner of the values in the cells around it, or about it where these are empty, NaN where there are
    none; ((m + 1)·(n + 1),)."""
    count, total = (np.bincount(cell, weights, len(raster.position)).reshape(raster.shape).astype(float)
                    for weights in (None, values))
    near, wide = ([_summed(sums, reach, raster.periodic) for sums in (count, total)] for reach in (1, 2))
    count, total = (np.where(near[0] > 0, close, far).ravel() for close, far in zip(near, wide, strict=True))
    return np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)


def _summed(cells: Array, reach: int, periodic: tuple[bool, bool]) -> Array:
    """Sums over the 2 · reach cells on either axis about each corner, (m, n) to (m + 1, n + 1)."""
    for axis, closed in enumerate(periodic):
        width = [(reach, reach) if k == axis else (0, 0) for k in (0, 1)]
        padded = np.cumsum(np.pad(cells, width, mode="wrap" if closed else "constant"), axis=axis)
        before = np.insert(np.delete(padded, -1, axis=axis), 0, 0.0, axis=axis)
        ends = np.arange(cells.shape[axis] + 1)
        cells = np.take(padded, ends + 2 * reach - 1, axis=axis) - np.take(before, ends, axis=axis)
    return cells
