# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which faces of a part a scan observes."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .coverage import covered_share
from .face import FaceGeometry
from .footpoints import surface_coordinates
from .raster import Raster, dot, make_raster
from .splines import Array

Index = NDArray[np.intp]

REACH = 10.0
LEAST_COVERAGE = 0.5
_LEAST_POINTS = 50
_SAMPLE = 40000
_CELLS = 1024
_NEIGHBOURS = 12
_ALIKE = 0.6


@dataclass(frozen=True)
class _Candidate:
    """A face, and the sampled scan points that lie over it and face its way: their cells, numbers and distances."""

    raster: Raster
    cell: Index
    point: Index
    distance: Array

    def share(self, owned: NDArray[np.bool_]) -> float:
        """Share of the face's area that the owned points cover."""
        if np.count_nonzero(owned) < _LEAST_POINTS:
            return 0.0
        return covered_share(self.raster, np.bincount(self.cell[owned], minlength=len(self.raster.area)))


def observed_faces(faces: Sequence[FaceGeometry], scan: Array, reach: float = REACH,
                   least: float = LEAST_COVERAGE) -> dict[int, float]:
    """Numbers of the faces that a scan observes, and the share of each that it covers.

    Parameters
    ----------
    faces : all faces of the part
    scan : (n, 3) in mm
    reach : largest distance in mm of a point from its face
    least : coverage from which a face counts as observed

    Notes
    -----
    Each point belongs to the nearest face that has a foot point for it and faces its way. The face with the least coverage is then given
    up and its points go to the next nearest, until all that are left are covered: so the skin of a sheet that moved
    inwards by more than half the thickness is not taken for the other skin.
    """
    if len(scan) > _SAMPLE:
        scan = scan[np.random.default_rng(0).choice(len(scan), _SAMPLE, replace=False)]
    normals = _normals(scan)
    candidates = {number: _candidate(face, scan, normals, reach) for number, face in enumerate(faces)}
    while candidates:
        owned = _owned(candidates, len(scan))
        shares = {number: candidate.share(owned[number]) for number, candidate in candidates.items()}
        worst = min(shares, key=shares.__getitem__)
        if shares[worst] >= least:
            return shares
        for number in [n for n, share in shares.items() if share == 0] or [worst]:
            del candidates[number]
    return {}


def _candidate(face: FaceGeometry, scan: Array, normals: Array, reach: float) -> _Candidate:
    raster = make_raster(face, _CELLS)
    points = surface_coordinates(raster, scan, reach).on_face(raster, 0.0)
    cell = points.in_cell[0]
    alike = np.abs(dot(raster.normal[cell], normals[points.index])) > _ALIKE
    return _Candidate(raster, cell[alike], points.index[alike], np.abs(points.height[alike]))


def _owned(candidates: dict[int, _Candidate], count: int) -> dict[int, NDArray[np.bool_]]:
    """For each face, which of its candidate points are nearer to it than to any other."""
    nearest, owner = np.full(count, np.inf), np.full(count, -1)
    for number, candidate in candidates.items():
        nearer = candidate.distance < nearest[candidate.point]
        point = candidate.point[nearer]
        nearest[point], owner[point] = candidate.distance[nearer], number
    return {number: owner[candidate.point] == number for number, candidate in candidates.items()}


def _normals(points: Array) -> Array:
    """Unit normals of the scan, their sign unknown, from the plane through each point's neighbours; (n, 3)."""
    count = min(_NEIGHBOURS, len(points))
    neighbours = points[cKDTree(points).query(points, count)[1].reshape(len(points), count)]
    neighbours = neighbours - neighbours.mean(axis=1, keepdims=True)
    return np.asarray(np.linalg.eigh(neighbours.transpose(0, 2, 1) @ neighbours)[1][:, :, 0])
