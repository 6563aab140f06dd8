# SPDX-License-Identifier: LGPL-2.1-or-later
"""Signed distances from scan points to the faces they belong to, by foot points on the surfaces themselves."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..registration.face_geometry import FaceGeometry
from ..registration.footpoints import surface_coordinates
from ..registration.uv_raster import Raster, make_raster

Array = NDArray[np.float64]
Index = NDArray[np.intp]

REACH = 10.0
"""A scan point farther than this (mm) from every face belongs to none …"""
_RELATIVE_REACH = 0.1
"""… nor one farther than this part of the model's diagonal."""


@dataclass(frozen=True)
class FaceDeviation:
    """The scan points of one face.

    Attributes
    ----------
    name : "Face6"
    points : (k,) indices into the scan
    deviations : (k,) signed, in mm, positive out of the material
    normals : (k, 3) outward normals of the face below the points
    """

    name: str
    points: Index
    deviations: Array
    normals: Array


def reach_of(diagonal: float) -> float:
    """How far from the faces of a model with this diagonal (mm) its scan points are looked for."""
    return min(REACH, _RELATIVE_REACH * diagonal)


def measure(faces: Sequence[FaceGeometry], points: Array, reach: float) -> list[FaceDeviation]:
    """Give each scan point to the nearest face that has a foot point for it inside its trims.

    Parameters
    ----------
    faces : candidates
    points : (n, 3) in mm
    reach : largest distance in mm

    Returns
    -------
    One entry per face, in the same order; a point is in at most one of them.
    """
    owner = np.full(len(points), -1, dtype=np.intp)
    height = np.full(len(points), np.inf)
    normal = np.zeros((len(points), 3))
    # Along the longest side of the scan most faces are short: only points beside them are looked at.
    axis = int(np.argmax(np.ptp(points, axis=0))) if len(points) else 0
    order = np.argsort(points[:, axis], kind="stable")
    along = points[order, axis]
    for number, face in enumerate(faces):
        raster = make_raster(face)
        middles, widest = raster.position[:, axis], reach + _cell_size(raster)
        beside = order[slice(*np.searchsorted(along, (middles.min() - widest, middles.max() + widest)))]
        near = beside[_within(raster, points[beside], np.minimum(np.abs(height[beside]), reach))]
        index, heights, normals = _over_face(raster, points[near], reach)
        index = near[index]
        nearer = np.abs(heights) < np.abs(height[index])
        index = index[nearer]
        owner[index], height[index], normal[index] = number, heights[nearer], normals[nearer]
    found = []
    for number, face in enumerate(faces):
        index = np.flatnonzero(owner == number)
        found.append(FaceDeviation(face.name, index, height[index], normal[index]))
    return found


def _within(raster: Raster, points: Array, reach: Array) -> Index:
    """The points that can have a foot point on the trimmed face within their own ``reach``, (n,) in mm."""
    cells = raster.position[raster.inside]
    if not len(cells):
        return np.zeros(0, dtype=np.intp)
    beyond = np.maximum(np.maximum(cells.min(axis=0) - points, points - cells.max(axis=0)), 0.0)
    return np.flatnonzero(np.linalg.norm(beyond, axis=1) <= reach + _cell_size(raster))


def _cell_size(raster: Raster) -> float:
    """No two places in a cell are farther apart, in mm."""
    return float(np.linalg.norm(np.abs(raster.tangent_u).max(axis=0) + np.abs(raster.tangent_v).max(axis=0)))


def _over_face(raster: Raster, points: Array, reach: float) -> tuple[Index, Array, Array]:
    found = surface_coordinates(raster, points, reach)
    cell = raster.cell(found.x, found.y)
    kept = (cell >= 0) & raster.inside[cell]
    return found.index[kept], found.height[kept], raster.normal[cell[kept]]
