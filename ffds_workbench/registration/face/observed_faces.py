# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which faces of a part a scan observes."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..face_geometry import FaceGeometry
from ..footpoints import surface_coordinates
from ..scan_points import faces_alike, scan_normals
from ..uv_raster import Raster, make_raster
from .robust_fit import dense_layers

Index = NDArray[np.intp]

REACH = 10.0
"""Largest distance in mm of a point from its face (unit: parts of some decimetres warp by less)."""
LEAST_COVERAGE = 0.5
"""Share of a face that has to be covered for it to count as observed (unit: most of it)."""
_LEAST_POINTS = 30
"""Points of a face that is observed (theory: twice the control points of the smallest lattice, nearly)."""
_SAMPLE_SIZE = 40000
"""Scan points that are looked at (unit: time)."""
_RASTER_CELLS = 1024
"""Cells of a face (unit: time)."""


@dataclass(frozen=True)
class _FaceCandidate:
    """A face, and the layers of the sampled scan points that lie over it and have its normals.

    Attributes
    ----------
    raster : the face in cells
    point, distance : (k,) numbers of the points and their distances from the face in mm, layer by layer
    first : where each layer starts
    cells : (layers, m·n) whether a cell lies in the layer's block
    """

    raster: Raster
    point: Index
    distance: Array
    first: Index
    cells: NDArray[np.bool_]

    def share(self, owned: NDArray[np.bool_]) -> float:
        """Share of the face's area in blocks with a layer that has most of its points nearer to this face."""
        count = np.diff(np.append(self.first, len(owned)))
        own = np.add.reduceat(owned.astype(float), self.first) > 0.5 * count
        if count[own].sum() < _LEAST_POINTS:
            return 0.0
        area = self.raster.area * self.raster.inside
        return float(area[self.cells[own].any(axis=0)].sum() / area.sum())


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
    Along the normals of a face, the points with matching normals form layers, block by block. Each point belongs to the
    nearest face, each layer to the face that owns most of its points. The face with the smallest share of its area
    under its own layers is dropped and its points go to the next nearest, until all remaining faces are covered. So the
    skin of a sheet that moved inwards by more than half the thickness is not mistaken for the other skin.
    """
    if len(scan) > _SAMPLE_SIZE:
        scan = scan[np.random.default_rng(0).choice(len(scan), _SAMPLE_SIZE, replace=False)]
    normals = scan_normals(scan)
    found = {number: _candidate(face, scan, normals, reach) for number, face in enumerate(faces)}
    candidates = {number: candidate for number, candidate in found.items() if candidate is not None}
    while candidates:
        owned = _owned(candidates, len(scan))
        shares = {number: candidate.share(owned[number]) for number, candidate in candidates.items()}
        worst = min(shares, key=shares.__getitem__)
        if shares[worst] >= least:
            return shares
        for number in [n for n, share in shares.items() if share == 0] or [worst]:
            del candidates[number]
    return {}


def _candidate(face: FaceGeometry, scan: Array, normals: Array, reach: float) -> _FaceCandidate | None:
    raster = make_raster(face, _RASTER_CELLS)
    points = surface_coordinates(raster, scan, reach, 0.0)
    points = points.part(np.flatnonzero(faces_alike(raster, points, normals[points.index])))
    if len(points.x) < _LEAST_POINTS:
        return None
    layers = dense_layers(raster, points)
    count = layers.end - layers.begin
    first = np.cumsum(count) - count
    rows = layers.order[np.arange(count.sum()) + np.repeat(layers.begin - first, count)]
    i, j = np.divmod(np.arange(len(raster.area)), raster.shape[1])
    block = (layers.x.astype(int) // layers.block, layers.y.astype(int) // layers.block)
    cells = (i // layers.block == block[0][:, None]) & (j // layers.block == block[1][:, None])
    return _FaceCandidate(raster, points.index[rows], np.abs(points.height[rows]), first, cells)


def _owned(candidates: dict[int, _FaceCandidate], count: int) -> dict[int, NDArray[np.bool_]]:
    """For each face, which of its candidate points are nearer to it than to any other."""
    nearest, owner = np.full(count, np.inf), np.full(count, -1)
    for number, candidate in candidates.items():
        nearer = candidate.distance < nearest[candidate.point]
        point = candidate.point[nearer]
        nearest[point], owner[point] = candidate.distance[nearer], number
    return {number: owner[candidate.point] == number for number, candidate in candidates.items()}
