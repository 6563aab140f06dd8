# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fewer points, and the normals of the surface through them."""
from __future__ import annotations

import numpy as np

from ...registration.arrays import Array
from . import library

_NEIGHBOURS = 16
"""Points that a normal is estimated from."""


def estimated_normals(points: Array, sensor: Array) -> Array:
    """Unit normals (n, 3) of the surface through points (n, 3), each towards its ``sensor``, (3,) or (n, 3)."""
    open3d = library.open3d("estimating normals")
    cloud = library.cloud(open3d, points)
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(_NEIGHBOURS))
    normals = np.asarray(cloud.normals)
    away = np.einsum("ij,ij->i", normals, sensor - points) < 0.0
    return np.where(away[:, None], -normals, normals)


def thinned(points: Array, normals: Array | None, spacing: float) -> tuple[Array, Array | None]:
    """The mean of the points, and of their normals, in each cube of this edge that holds any (open3d's voxels).

    A normal is zero where the cube holds none, or where those in it cancel out.
    """
    open3d = library.open3d("thinning")
    cloud = library.cloud(open3d, points, normals).voxel_down_sample(spacing)
    if normals is None:
        return np.asarray(cloud.points), None
    means = np.asarray(cloud.normals)
    length = np.linalg.norm(means, axis=1, keepdims=True)
    return np.asarray(cloud.points), np.divide(means, length, out=np.zeros_like(means), where=length > 1e-6)
