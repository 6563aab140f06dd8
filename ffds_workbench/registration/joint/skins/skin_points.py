# SPDX-License-Identifier: LGPL-2.1-or-later
"""Even points of a scan with normals that are those of one skin of a sheet, not of a mixture of both."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ...scan_points import orient_normals, plane_normals
from ..data import ScanStatistics

_LEAST_NEIGHBOURS, _LARGEST_NEIGHBOURS = 12, 100
"""Neighbours that a plane is put through (unit)."""
_PLANE_TURN = 0.15
"""Standard deviation in rad that noise may turn a plane by (unit); that of k points in a disc of radius r: 2σ/(r√k)."""
_ONE_SKIN_RADIUS, _MIXED_RADIUS, _BOTH_SKINS_RADIUS = 0.5, 0.8, 2.0
"""Radius of a neighbourhood over the thickness up to which it holds points of one skin, from which it may hold some of
the other, and from which those turn its plane no more: two parallel planes have the normal of one (unit)."""
_COUNT_BOUNDS, _POINT_DISTANCE, _SPARE_FACTOR = (2500, 40_000), 0.6, 2
"""Points that tell sides, at least and at the most (unit: time); their distance over the thickness, as more distant
ones link skins (unit); and how many times as many even ones are taken from."""
_ROUNDS = 3
"""Sizes of cubes that are tried (unit)."""
_STRAY_DISTANCE = 3.0
"""A point whose neighbours are farther by this factor than they usually are is no part of a surface (unit)."""


@dataclass(frozen=True)
class SkinPoints:
    """Even points of the scan.

    Attributes
    ----------
    points, normals : (n, 3) in mm, on the planes through their neighbours; unit vectors of one sign within a piece
    piece : (n,) number of the connected piece
    """

    points: Array
    normals: Array
    piece: Index


def skin_points(scan: Array, part: cKDTree, reach: float, statistics: ScanStatistics, thickness: float,
                generator: np.random.Generator) -> SkinPoints:
    """Even points with normals from a ``scan`` (n, 3), as dense as sheets with a ``thickness`` in mm ask for.

    ``part`` holds places on the nominal part, of which they lie within ``reach`` mm.
    """
    count = int(np.clip(len(scan) / statistics.density / (_POINT_DISTANCE * thickness) ** 2, *_COUNT_BOUNDS))
    some = scan if len(scan) < _SPARE_FACTOR * count else generator.choice(scan, _SPARE_FACTOR * count, replace=False,
                                                                           shuffle=False)
    some = some[np.isfinite(part.query(some, distance_upper_bound=reach, workers=-1)[0])]
    if not len(some):
        return SkinPoints(some, some, np.zeros(0, dtype=np.intp))
    points = _even(some, count)
    wide = np.pi * (_ONE_SKIN_RADIUS * thickness) ** 2
    enough = max(_LEAST_NEIGHBOURS, (2 * statistics.noise / _PLANE_TURN) ** 2 * np.pi / wide) / wide
    share = min(1.0, max(enough / statistics.density, count / len(scan)))
    pool = scan if share == 1.0 else generator.choice(scan, int(share * len(scan)), replace=False, shuffle=False)
    density = np.pi * share * statistics.density
    neighbours = max(_LEAST_NEIGHBOURS, 2 * statistics.noise * np.sqrt(density) / _PLANE_TURN)
    mixed = neighbours > density * (_MIXED_RADIUS * thickness) ** 2
    if mixed:
        neighbours = max(neighbours, density * (_BOTH_SKINS_RADIUS * thickness) ** 2)
    distance, index = cKDTree(pool).query(points, min(int(np.clip(neighbours, _LEAST_NEIGHBOURS, _LARGEST_NEIGHBOURS)),
                                                      len(pool)), workers=-1)
    usual = distance[:, -1] < _STRAY_DISTANCE * np.median(distance[:, -1])
    points, around = points[usual], pool[index[usual]]
    middle = around.mean(axis=1)
    around = around - middle[:, None]
    normals = plane_normals(around)
    if not mixed:
        points = points - np.einsum("nx,nx->n", points - middle, normals)[:, None] * normals
    return SkinPoints(points, *orient_normals(points, normals))


def _even(points: Array, count: int) -> Array:
    """About ``count`` of points (n, 3) on surfaces, one of each cube of a grid."""
    base, chosen = points - points.min(axis=0), np.arange(len(points))
    size = float(base.max()) / np.sqrt(count)
    for _ in range(_ROUNDS if len(points) > count else 0):
        chosen = np.unique((base / size).astype(int), axis=0, return_index=True)[1]
        size *= np.sqrt(len(chosen) / count)  # cubes that a surface meets are as many as their size squared is small
    return points[chosen]
