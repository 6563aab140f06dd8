# SPDX-License-Identifier: LGPL-2.1-or-later
"""Normals of a scan, for telling a face from the walls that cross it."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array
from ..footpoints import SurfaceCoordinates
from ..uv_raster import Raster, dot

_PLANE_NEIGHBOURS = 12
"""Points that a plane is put through (unit: few, as a surface is curved)."""
_ALIKE_COSINE = 0.6
"""Cosine of the angle between a point's normal and its face's from which they face the same way (unit: 53°, what noise
does to normals)."""


def scan_normals(points: Array) -> Array:
    """Unit normals of scan points, their sign unknown, from the plane through each point's neighbours; (n, 3)."""
    count = min(_PLANE_NEIGHBOURS, len(points))
    neighbours = points[cKDTree(points).query(points, count)[1].reshape(len(points), count)]
    return plane_normals(neighbours - neighbours.mean(axis=1, keepdims=True))


def plane_normals(offsets: Array) -> Array:
    """Unit normals, their sign unknown, of the planes through neighbourhoods of k points, given as ``offsets``
    (n, k, 3) from the middle of each; (n, 3). `scan_sketch` has its own version for weighted points, ten times as fast.
    """
    return np.asarray(np.linalg.eigh(offsets.transpose(0, 2, 1) @ offsets)[1][:, :, 0])


def faces_alike(raster: Raster, points: SurfaceCoordinates, normals: Array) -> NDArray[np.bool_]:
    """Whether the scan's normals, (k, 3) at the given points, are those of the face below them on
    its ``raster``; (k,)."""
    return np.asarray(np.abs(dot(raster.normal[points.in_cell[0]], normals)) > _ALIKE_COSINE)
