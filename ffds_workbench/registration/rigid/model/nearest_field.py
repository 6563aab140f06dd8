# SPDX-License-Identifier: LGPL-2.1-or-later
"""A look-up table of the samples of a part that are nearest to places around it."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array
from ..search_settings import SearchSettings
from .part_samples import Target, kept_with_target

_SIDES = np.concatenate([np.eye(3), -np.eye(3)])
"""Directions of the normal that have a table each (theory: the six sides of a cube)."""


@dataclass(frozen=True)
class NearestField:
    """Nearest sample that faces the same way, on a voxel grid around the part: a look-up costs an index and no tree.

    Attributes
    ----------
    origin : (3,) in mm
    voxel : edge length in mm
    nearest : (7, nx, ny, nz) index into points, one table for each of the directions ±x, ±y, ±z of the normal, and one
        for normals that are not known
    points, normals : (m, 3) samples
    centre, size : of the part, (3,) and a length in mm
    settings : of the search
    """

    origin: Array
    voxel: float
    nearest: NDArray[np.int32]
    points: Array
    normals: Array
    centre: Array
    size: float
    settings: SearchSettings

    def __call__(self, points: Array, normals: Array | None) -> NDArray[np.int32]:
        """Index of the nearest sample for points and normals (…, 3); outside the grid the border counts."""
        shape = np.array(self.nearest.shape[1:], dtype=np.int32)
        cell = np.clip(((points - self.origin) / self.voxel).astype(np.int32), 0, shape - 1)
        if normals is None:
            side = np.array(len(_SIDES))
        else:
            axis = np.argmax(np.abs(normals), axis=-1)
            side = axis + 3 * (np.take_along_axis(normals, axis[..., None], axis=-1)[..., 0] < 0)
        flat = ((side * shape[0] + cell[..., 0]) * shape[1] + cell[..., 1]) * shape[2] + cell[..., 2]
        return self.nearest.ravel()[flat]


@kept_with_target
def nearest_field(target: Target) -> NearestField:
    """The look-up table of the part that ``target`` is, and of its surroundings."""
    points, normals = target.even.points, target.even.normals
    settings = target.settings.search
    margin = settings.margin * target.size
    low, high = points.min(axis=0) - margin, points.max(axis=0) + margin
    voxel = float((high - low).max()) / settings.voxels
    axes = [np.arange(a + 0.5 * voxel, b + voxel, voxel) for a, b in zip(low, high, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=3)
    tables = []
    on_side = [np.flatnonzero(normals @ side > settings.same_side_cosine) for side in _SIDES]
    for facing in [*on_side, np.arange(len(points))]:
        facing = facing if len(facing) else np.arange(len(points))
        tables.append(facing[cKDTree(points[facing]).query(grid.reshape(-1, 3))[1]].reshape(grid.shape[:3]))
    return NearestField(low, voxel, np.stack(tables).astype(np.int32), points, normals, target.centre, target.size,
                        settings)
