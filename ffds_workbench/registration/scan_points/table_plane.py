# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table that a scan shows beside the part: the plane, and how the search for a pose finds it.

``scan/preparation`` finds tables as well, and gives the same `TablePlane`. It knows no part and has to take every point
of the table away, so it searches all points by open3d's RANSAC and measures how thick the plane is. Here the part is
known, a few thousand points with normals are at hand, and a table missed costs less than a side of the part taken for
one.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from ..arrays import Array
from ..robust_weights import robust_sigma
from .scan_sketch import Sketch

_TRIALS = 200
"""Planes that are tried (theory: one of them lies in a plane with 15 % of the points, but once in 10¹⁴)."""
_TOLERANCE_SIGMAS, _TOLERANCE_SIZES = 5.0, 2e-3
"""Height of a point of the plane at the most: in standard deviations of the noise (theory: a normal distribution ends
there), and over the size of the scan (unit: flatness of a table)."""
_FACING_COSINE = 0.95
"""Of a point's normal and the plane's (unit: 18°, what noise does to normals)."""
_LEAST_SHARE, _LEAST_POINTS = 0.15, 50
"""Of the scan that a table fills, and the number of points that it has (unit)."""
_LARGEST_SHARE_BEHIND = 0.03
"""Of the scan, that may lie behind a table (unit: stray points)."""
_WIDER = 1.2
"""Area of a table over the largest that the part can cover (unit: a side of the part is no larger than that)."""
_THICKNESS_SIGMAS, _THINNEST = 6.0, 1e-3
"""Half of the thickness that is taken away with the plane, in standard deviations of its points (theory: twice as far
as nearly all of them lie), and at least this share of the tolerance (unit: a scan without noise)."""


@dataclass(frozen=True)
class TablePlane:
    """A plane that something stands on.

    Attributes
    ----------
    normal : (3,) unit vector, towards what stands on it
    height : of the plane along the normal, normal · x in mm
    below, above : how far its points reach behind it and in front of it, in mm
    """

    normal: Array
    height: float
    below: float
    above: float

    def heights(self, points: Array) -> Array:
        """Signed distances of ``points`` (n, 3) from the plane, (n,) in mm."""
        return points @ self.normal - self.height

    def in_front(self, points: Array) -> NDArray[np.bool_]:
        """Which of the ``points`` (n, 3) are neither of the table nor behind it."""
        return np.asarray(self.heights(points) > self.above)


def table_of_sketch(sketch: Sketch, largest_projection: float, generator: np.random.Generator) -> TablePlane | None:
    """The plane that the part lies on or stands before, or None.

    It holds a good share of the points, spreads wider than any side of the part could, and has all else on one side.

    Parameters
    ----------
    sketch : even points of the whole scan
    largest_projection : largest area in mm² that the part can cover on a plane
    generator : draws the points whose planes are tried
    """
    points, normals = sketch.points, sketch.normals
    tolerance = max(_TOLERANCE_SIGMAS * sketch.noise, _TOLERANCE_SIZES * float(np.linalg.norm(np.ptp(points, axis=0))))
    trial = generator.integers(0, len(points), _TRIALS)
    height = points @ normals[trial].T - np.einsum("ni,ni->n", points[trial], normals[trial])
    inside = (np.abs(height) < tolerance) & (np.abs(normals @ normals[trial].T) > _FACING_COSINE)
    best = inside[:, np.argmax(inside.sum(axis=0))]
    for _ in range(3):
        centre = points[best].mean(axis=0)
        vectors = np.linalg.svd(points[best] - centre, full_matrices=False)[2]
        height = (points - centre) @ vectors[2]
        best = np.abs(height) < tolerance
    if best.mean() < _LEAST_SHARE or best.sum() < _LEAST_POINTS:
        return None
    side = np.sign(np.median(height[~best])) if (~best).any() else 1.0
    if float(np.mean(side * height < -tolerance)) > _LARGEST_SHARE_BEHIND:
        return None
    try:
        area = ConvexHull((points[best] - centre) @ vectors[:2].T).volume
    except QhullError:
        return None
    if area < _WIDER * largest_projection:
        return None
    half = float(np.clip(_THICKNESS_SIGMAS * robust_sigma(height[best]), _THINNEST * tolerance, tolerance))
    normal = side * vectors[2]
    return TablePlane(normal, float(normal @ centre), half, half)
