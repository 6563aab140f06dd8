# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the search for a pose works with: a few thousand even points of the scan with normals.

The normals of one connected piece of surface are turned to one side; which side is outside only the model can tell.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array
from .normal_sides import orient_normals
from .parallel import workers

_POOL_SIZE = 40_000
"""Points of the scan that are looked at (unit: time)."""
_POINT_COUNT, _FINER_FACTOR = 2_000, 4
"""Even points of a sketch (theory: a share of them is known to 1 %, 0.5/√n), and how many times as many their sides are
found on (unit: distant neighbours link surfaces that are not connected)."""
_PLANE_NEIGHBOURS = (14, 40)
"""Points that a plane is put through, and of a rougher scan (unit: few, as a surface is curved)."""
_ROUGHNESS = 0.22
"""Ratio of local roughness to the radius of a neighbourhood above which a wider one gives better normals (theory: a
plane through 14 points then turns by 7°)."""
_SPARSE_IN_SCAN, _ALONE_AMONG_OWN = 4.0, 1.6
"""A point is isolated if its neighbours are farther away, by the first factor, than in the median of the scan, or, by
the second, than the neighbours' own neighbours are (calibrated: by hand, on the scans of ``./ffds benchmark
alignment``)."""
_DENSITY_NEIGHBOURS, _NEIGHBOUR_STRIDE, _MEDIAN_POINTS, _DOUBTFUL_DENSITY = 9, 3, 500, 1.3
"""Number of neighbours, the point itself included; stride of those that are compared with their own neighbours; number
of points for the median; and factor above the median from which a point is examined (unit: time)."""
_INVERSE_STEPS = 2
"""Further steps of inverse iteration for a normal (theory: each divides the error by the ratio of the two smallest
eigenvalues, which is 4 or more on a surface)."""
_COUNT_TOLERANCE = 1.15
"""Thinning stops when the number of points is within this factor of the number wanted (unit: time)."""
_CELLS_PER_POINT = 100
"""With at most this many cells per point, a table of all cells is faster than sorting the points (unit: time)."""


@dataclass(frozen=True)
class Sketch:
    """Even points of a scan.

    Attributes
    ----------
    points, normals : (n, 3) in mm and unit vectors, of one sign within a piece
    piece : (n,) number of the connected piece, 0 the largest
    noise : standard deviation in mm of the scan about its own local planes
    pool : (m, 3) more points of the same surfaces, not thinned
    scan : (k, 3) all points
    """

    points: Array
    normals: Array
    piece: NDArray[np.intp]
    noise: float
    pool: Array
    scan: Array

    @cached_property
    def spacing(self) -> float:
        """Median distance in mm between neighbouring points."""
        return float(np.median(cKDTree(self.points).query(self.points[:_MEDIAN_POINTS], k=2)[0][:, 1]))

    def every(self, step: int) -> Sketch:
        """The same of fewer points, one of every ``step``."""
        return replace(self, points=self.points[::step], normals=self.normals[::step], piece=self.piece[::step])


def sketch_of(scan: Array, generator: np.random.Generator, count: int = _POINT_COUNT, pool_size: int = _POOL_SIZE,
              finer: int = _FINER_FACTOR) -> Sketch:
    """Even points with normals from a random part of the scan; isolated points are dropped.

    Parameters
    ----------
    scan : (n, 3) in mm
    generator : random choice of the points
    count : how many points to aim at
    pool_size : how many points of the scan to look at
    finer : the sides of the surface are found on this many times ``count`` points, because distant neighbours link
        surfaces that are not connected
    """
    pool = scan if len(scan) <= pool_size else scan.take(generator.integers(0, len(scan), pool_size), axis=0)
    tree = cKDTree(pool, balanced_tree=False, compact_nodes=False)
    points = pool[thin(pool, finer * count)]
    distance, index = tree.query(points, k=min(_PLANE_NEIGHBOURS[0], len(pool)), workers=workers(points))
    among = _not_isolated(tree, distance, index)
    points, distance, index = points[among], distance[among], index[among]
    normals, roughness = _local_planes(pool[index])
    if np.median(roughness / np.maximum(distance[:, -1], 1e-12)) > _ROUGHNESS:
        index = tree.query(points, k=min(_PLANE_NEIGHBOURS[1], len(pool)), workers=workers(points))[1]
        normals, roughness = _local_planes(pool[index])
    normals, piece = orient_normals(points, normals)
    even = thin(points, count)
    return Sketch(points[even], normals[even], piece[even], float(np.median(roughness)), pool, scan)


def thin(points: Array, count: int) -> NDArray[np.intp]:
    """Indices (k,) of about ``count`` of the ``points`` (n, 3), one per voxel of a size found by bisection."""
    if len(points) <= _COUNT_TOLERANCE * count:
        return np.arange(len(points))
    low, high = 0.0, float(np.ptp(points, axis=0).max())
    base = np.ascontiguousarray((points - points.min(axis=0)).T)
    chosen = np.arange(len(points))
    probe = high / np.sqrt(count)
    for _ in range(12):
        chosen = _first_of_each((base * (1.0 / probe)).astype(np.int64))
        if count <= _COUNT_TOLERANCE * len(chosen) and len(chosen) <= _COUNT_TOLERANCE * count:
            break
        low, high = (probe, high) if len(chosen) > count else (low, probe)
        probe *= np.sqrt(len(chosen) / count)
        if not low < probe < high:
            probe = 0.5 * (low + high)
    return chosen


def _first_of_each(cell: NDArray[np.int64]) -> NDArray[np.intp]:
    """Index of a point in each of the cells (3, n), numbered from 0, that hold any."""
    shape = cell.max(axis=1) + 1
    key = (cell[0] * shape[1] + cell[1]) * shape[2] + cell[2]
    if np.prod(shape, dtype=float) > _CELLS_PER_POINT * len(key):
        return np.unique(key, return_index=True)[1]
    first = np.full(shape.prod(), -1, dtype=np.intp)
    first[key] = np.arange(len(key))
    return first[first >= 0]


def _not_isolated(tree: cKDTree, distance: Array, index: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Which points lie as densely as the median of the scan, and as densely as their own neighbours.

    The second criterion is a short form of the local outlier factor (M. Breunig et al., LOF, 2000): a stray point just
    above a surface has near neighbours, but those have far nearer ones.

    Parameters
    ----------
    tree : of the scan
    distance, index : (n, k) in mm, of the neighbours of some of its points: even ones, among which strays are far more
        frequent than in the scan
    """
    k = min(_DENSITY_NEIGHBOURS, distance.shape[1])
    usual = max(float(np.median(tree.query(tree.data[:_MEDIAN_POINTS], k=k)[0][:, -1])), 1e-9)
    farthest = distance[:, k - 1]
    among = farthest < _SPARSE_IN_SCAN * usual
    doubtful = np.flatnonzero(among & (farthest > _DOUBTFUL_DENSITY * usual))
    theirs = tree.query(tree.data[index[doubtful, 1:k:_NEIGHBOUR_STRIDE]], k=k, workers=-1)[0][:, :, -1]
    among[doubtful] = farthest[doubtful] < _ALONE_AMONG_OWN * np.median(theirs, axis=1)
    return among


def _local_planes(neighbourhoods: Array) -> tuple[Array, Array]:
    """Normal and standard deviation about the plane through (n, k, 3) neighbourhoods, the point itself first.

    Neighbours off a first plane weigh less in the second: the other side of a thin sheet is not the same surface.
    """
    offset = neighbourhoods - neighbourhoods[:, :1]
    radius = np.sqrt(np.einsum("nki,nki->nk", offset, offset).max(axis=1, keepdims=True))
    flat = _flattest(_scatter(offset, np.ones(offset.shape[:2])))
    height = (offset @ flat[:, :, None])[:, :, 0]
    weight = np.exp(-((height / np.maximum(0.5 * radius, 1e-12)) ** 2))
    scatter = _scatter(offset, weight)
    normal = _flattest(scatter)
    square = np.einsum("ni,nij,nj->n", normal, scatter, normal)
    return normal, np.sqrt(np.maximum(square, 0.0) / np.maximum(weight.sum(axis=1) - 3.0, 1.0))


def _scatter(offset: Array, weight: Array) -> Array:
    """Weighted sums (n, 3, 3) of squares about the mean of neighbourhoods (n, k, 3) with weights (n, k)."""
    centred = offset - (weight[:, None] @ offset) / weight.sum(axis=1)[:, None, None]
    return np.swapaxes(centred * weight[:, :, None], 1, 2) @ centred


def _flattest(scatter: Array) -> Array:
    """Unit eigenvectors (n, 3) of the least eigenvalues of matrices (n, 3, 3), by inverse iteration.

    The inverse is the adjugate up to a factor, and its columns are cross products: ten times as fast as ``eigh``.
    """
    inverse = np.stack([np.cross(scatter[:, k - 2], scatter[:, k - 1]) for k in range(3)], axis=2)
    longest = np.einsum("nik,nik->nk", inverse, inverse).argmax(axis=1)
    vector = inverse[np.arange(len(inverse)), :, longest]
    for _ in range(_INVERSE_STEPS):
        vector = vector / np.maximum(np.linalg.norm(vector, axis=1, keepdims=True), 1e-300)
        vector = (inverse @ vector[:, :, None])[:, :, 0]
    return np.asarray(vector / np.maximum(np.linalg.norm(vector, axis=1, keepdims=True), 1e-300))
