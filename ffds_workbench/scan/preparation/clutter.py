# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points that do not belong to the part: things that stand apart, and single points."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from ...registration.arrays import Array
from . import library

_REACH, _CORE = 5.0, 6
"""Points within the first times the spacing belong together where so many are that close to one of them."""
_SHARE = 0.05
"""A piece with fewer points than this share of the largest piece's is clutter: less than any side of a part, which may
come in pieces where the scan has gaps."""
_SHARE_WITHIN = 0.0025
"""The same for a piece within the outline, seen along the table's normal, of what stands on it: a leg under a plate, of
which the sensor does not see the top. Nothing else can be there."""
_NEIGHBOURS, _DEVIATIONS = 16, 5.0
"""An outlier's mean distance to so many neighbours is so many standard deviations beyond the mean of all points."""


def in_large_pieces(points: Array, spacing: float, up: Array | None = None) -> tuple[NDArray[np.bool_], int]:
    """Which points (n, 3) near the origin are of a large piece, and how many pieces are large.

    The pieces are those of open3d's DBSCAN, among one point of each cube with the spacing as its edge. ``up`` (3,) is
    the normal of a table that the part stands on, where there is one: what is within the part's outline is the part's.
    """
    open3d = library.open3d("removing clutter")
    if spacing <= 0.0:
        return np.zeros(len(points), dtype=bool), 0
    first, cube = _cubes(points, spacing)
    piece_of_cube = np.asarray(library.cloud(open3d, points[first]).cluster_dbscan(_REACH * spacing, _CORE), dtype=int)
    piece = piece_of_cube[cube]
    counts = np.bincount(piece[piece >= 0], minlength=1)
    large = counts >= max(_SHARE * counts.max(), 1.0)
    if up is not None and not large.all():
        within = _within_outline(points[first], piece_of_cube, large, up)
        large |= within & (counts >= _SHARE_WITHIN * counts.max())
    return (piece >= 0) & large[piece], int(large.sum())


def _within_outline(points: Array, piece: NDArray[np.int_], large: NDArray[np.bool_], up: Array) -> NDArray[np.bool_]:
    """Which pieces lie within the outline of the large ones, seen along ``up``; ``piece`` (n,) is negative for none."""
    flat = points @ np.linalg.svd(up[None])[2][1:].T
    of_piece = piece >= 0
    try:
        sides = ConvexHull(flat[of_piece & large[piece]]).equations
    except QhullError:  # a line
        return np.zeros(len(large), dtype=bool)
    inside = (flat[of_piece] @ sides[:, :2].T + sides[:, 2] <= 0.0).all(axis=1)
    return np.bincount(piece[of_piece], inside, len(large)) > 0.5 * np.bincount(piece[of_piece], minlength=len(large))


def surrounded(points: Array) -> NDArray[np.bool_]:
    """Which points (n, 3) are about as close to their neighbours as others are (open3d's statistical outliers)."""
    open3d = library.open3d("removing outliers")
    _, kept = library.cloud(open3d, points).remove_statistical_outlier(_NEIGHBOURS, _DEVIATIONS)
    result = np.zeros(len(points), dtype=bool)
    result[np.asarray(kept, dtype=int)] = True
    return result


def _cubes(points: Array, edge: float) -> tuple[NDArray[np.int_], NDArray[np.int_]]:
    """The place of the first point of each cube of space that holds any, and the number of the cube of each point."""
    place = np.floor((points - points.min(axis=0)) / edge).astype(np.int64)
    sides = place.max(axis=0) + 1
    if np.log2(sides.astype(float)).sum() > 62.0:  # a few points far away: cubes that no single number counts
        numbers = np.unique(place, axis=0, return_inverse=True)[1].ravel()
    else:
        numbers = np.ravel_multi_index(tuple(place.T), tuple(sides))
    _, first, cube = np.unique(numbers, return_index=True, return_inverse=True)
    return first, cube
