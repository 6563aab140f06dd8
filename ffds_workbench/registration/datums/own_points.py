# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which points of a scan show a face: those nearest to its inside, without what is off the face they make."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array
from ..face_geometry import FaceGeometry
from ..motions import twist_rows
from ..robust_weights import NOISE_ENDS_SIGMAS, robust_sigma
from ..uv_raster import make_raster

_CELLS = 96
"""Cells of a face's raster, which has 16 per direction at least: its border is told to a sixteenth of its sides (unit:
time)."""
_MARGIN = 0.25
"""Over the largest depth within the face: points nearer to its border may show another one (unit). Rasters know
depths up to `LARGEST_DEPTH`, so that this is less on large faces."""
_REACH = 0.02
"""Over the size of the part: how far a datum face may lie off its nominal place (unit)."""
_FEWEST_POINTS = 10
"""Points of a face below which all are taken (theory: a motion and a size have seven unknowns)."""


def points_of_faces(faces: Sequence[FaceGeometry], wanted: Sequence[int], points: Array, size: float) -> list[Array]:
    """Numbers of the points that show each wanted face.

    Parameters
    ----------
    faces : all faces of the part
    wanted : indices of faces
    points : (n, 3) in mm, near the model
    size : of the part in mm
    """
    rasters = [make_raster(face, _CELLS) for face in faces]
    place = np.concatenate([raster.position[raster.inside] for raster in rasters])
    depth = np.concatenate([raster.depth[raster.inside] for raster in rasters])
    normal = np.concatenate([raster.normal[raster.inside] for raster in rasters])
    owner = np.repeat(np.arange(len(faces)), [int(raster.inside.sum()) for raster in rasters])
    distance, cell = cKDTree(place).query(points, distance_upper_bound=_REACH * size)
    near = np.flatnonzero(np.isfinite(distance))
    cell = cell[near]
    height = np.einsum("nx,nx->n", points[near] - place[cell], normal[cell])
    found = []
    for face in wanted:
        deep = depth[cell] > _MARGIN * depth[owner == face].max(initial=0.0)
        chosen = np.flatnonzero((owner[cell] == face) & deep)
        kept = _together(points[near[chosen]], normal[cell[chosen]], height[chosen])
        found.append(near[chosen[kept]])
    return found


def _together(points: Array, normal: Array, height: Array) -> NDArray[np.bool_]:
    """Which points (n, 3) lie where most of them say that the face is, moved and of another size: (n,)."""
    kept = np.ones(len(points), dtype=bool)
    if len(points) < _FEWEST_POINTS:
        return kept
    rows = np.column_stack([np.ones(len(points)), twist_rows(points - points.mean(axis=0), normal)])
    for _ in range(5):
        told = np.linalg.lstsq(rows[kept], height[kept], rcond=1e-6)[0]
        left = height - rows @ told
        sigma = robust_sigma(left[kept])
        kept = np.abs(left) <= max(NOISE_ENDS_SIGMAS * sigma, 1e-9)
    return kept
