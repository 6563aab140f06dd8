# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much of a face the scan covers."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from ..arrays import Array
from ..uv_raster import Raster

_DENSE_POINTS = 2.0
"""Mean points of an occupied cell from which cells are judged by themselves (theory: fewer leave a seventh of the cells
empty by chance)."""
_COVERED_SPACING = 1.2 * 2.13
"""Cells within this many median neighbour distances of a point are covered. Points at random are √(π / ln 2) = 2.13
median neighbour distances apart on average, and 99 % of a covered area lie within 1.2 spacings of one (theory)."""


def covered_share(raster: Raster, points: Array) -> float:
    """Share of the face's area that lies within about one point spacing of a scan point, 0…1.

    Parameters
    ----------
    raster : of the face, (m, n) cells
    points : (m·n,) number, or weight, of the scan points in each cell
    """
    occupied = (points > 0) & raster.inside
    if np.count_nonzero(occupied) < 2:
        return 0.0
    spacing = 1.0
    if points[occupied].mean() < _DENSE_POINTS:
        places = np.argwhere(occupied.reshape(raster.shape))
        spacing = max(spacing, _COVERED_SPACING * float(np.median(cKDTree(places).query(places, 2)[0][:, 1])))
    seen = _distance(raster, occupied) <= spacing
    return float(raster.area[raster.inside & seen].sum() / raster.area[raster.inside].sum())


def _distance(raster: Raster, occupied: NDArray[np.bool_]) -> Array:
    """Distance in cells to the nearest occupied cell; closed directions wrap."""
    grid = occupied.reshape(raster.shape)
    pad = [(k // 2, k // 2) if closed else (0, 0) for k, closed in zip(raster.shape, raster.periodic, strict=True)]
    distance = distance_transform_edt(~np.pad(grid, pad, mode="wrap"))
    rows, columns = (slice(a, a + k) for (a, _), k in zip(pad, raster.shape, strict=True))
    return np.asarray(distance[rows, columns]).ravel()
