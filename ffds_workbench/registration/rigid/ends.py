# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a scan ends along the part's rims: what holds it in the directions that its surfaces leave free."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..splines import Array
from .motions import apply
from .rims import Rims
from .target import workers

_STRIP = 3.0
"""Depth of the strip inside a rim that is looked at, in widths: the density is counted beyond the first width."""
_FEWEST = 6
"""Points in the counted strip from which a stretch of rim says something."""
_STRANGE = 0.1
"""Share of points beside the face, by those on it: from there on the wall at the rim is seen, and holds the scan."""
_SATURATED = 0.8
"""A scan that ends farther inside than this share of the width ends for another reason."""
_GRADES = 4
"""Widths per doubling."""
_FLOOR = 0.1
"""Uncertainty of a rim that no density takes away, in widths: rounded edges, mixed pixels."""


@dataclass(frozen=True)
class Ends:
    """Stretches of rim along which the scan is seen to end.

    Attributes
    ----------
    stretch : (n,) their numbers
    places, outwards : (n, 3) in mm and unit vectors
    gap : (n,) in mm from the rim to the end of the scan, negative where it ends inside
    weight : (n,) 1/mm²
    """

    stretch: NDArray[np.intp]
    places: Array
    outwards: Array
    gap: Array
    weight: Array

    def moved(self, motion: Array) -> Ends:
        """After the scan has moved on a little by (4, 4)."""
        end = self.places + self.gap[:, None] * self.outwards
        more = np.einsum("ni,ni->n", apply(motion, end) - end, self.outwards)
        return replace(self, gap=self.gap + more)


@dataclass(frozen=True)
class Beside:
    """Which points of a scan lie near which points of the rims.

    Attributes
    ----------
    row, entry : (k,) numbers of the point and of the one on the rim; a point beside an edge has one on either face
    """

    row: NDArray[np.intp]
    entry: NDArray[np.intp]


def beside(rims: Rims, points: Array, reach: float) -> Beside:
    """What of points (n, 3), in model coordinates, lies within ``reach`` mm of the rims."""
    if not len(rims.points):
        return Beside(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))
    nearest = rims.tree.query(points, distance_upper_bound=reach, workers=workers(points))[1]
    row = np.flatnonzero(nearest < len(rims.points))
    first = nearest[row]
    partner = rims.partner[first]
    other = partner != first
    return Beside(np.concatenate([row, row[other]]), np.concatenate([first, partner[other]]))


def find_ends(rims: Rims, points: Array, width: float, tolerance: float, near: Beside | None = None) -> Ends:
    """Count the points near the rims: as many as the strip inside lets expect lie on a face that ends at its rim.

    Of a scan of density λ per mm of depth, n = λ (width + gap) points lie within the width of the rim or beyond it,
    however symmetric noise blurs its end.

    Parameters
    ----------
    points : (n, 3) in model coordinates, of even density on each side of a rim
    width : in mm; ends farther than this from the rim are not recognised
    tolerance : in mm, height up to which a point is on a face
    near : which points lie near the rims, if known
    """
    depth = depth_of(width)
    if near is None:
        near = beside(rims, points, 1.1 * depth)
    if not len(near.row):
        return _nothing()
    chosen = rims.clear(depth)[near.entry]
    row, entry = near.row[chosen], near.entry[chosen]
    offset = points[row] - rims.points[entry]
    beyond = np.einsum("ni,ni->n", offset, rims.outwards[entry])
    height = np.abs(np.einsum("ni,ni->n", offset, rims.normals[entry]))
    on, close = height < tolerance, np.abs(beyond) < width
    stretch, count = rims.stretch[entry], len(rims.middles)
    inside, around, strange = (np.bincount(stretch[some], minlength=count) for some in (
        on & (beyond < -width) & (beyond > -depth), on & close, close & ~on & (height < tolerance + width)))
    density = inside / (depth - width)
    gap = around / np.maximum(density, 1e-12) - width
    seen = np.flatnonzero((inside >= _FEWEST) & (strange < _STRANGE * density * width)
                          & (np.abs(gap) < _SATURATED * width))
    spread = 1.5 * width / np.maximum(density[seen], 1e-12) + (_FLOOR * width) ** 2
    return Ends(seen, rims.middles[seen], rims.ways[seen], gap[seen], 1.0 / spread)


def depth_of(width: float) -> float:
    """Depth in mm of the strip that is looked at for ends within the width."""
    return _STRIP * width


def width_of_ends(rims: Rims, density: float, least: float) -> float:
    """Width in mm that holds enough points of a scan, of so many points per mm², to count its ends, and is not below
    the ``least``; one of few, as the rims keep what they know of each."""
    wanted = max(least, 2.0 * _FEWEST / (rims.length_of_stretch * max(density, 1e-12) * (_STRIP - 1.0)))
    return float(rims.step * 2.0 ** (np.ceil(_GRADES * np.log2(wanted / rims.step)) / _GRADES))


def _nothing() -> Ends:
    return Ends(np.zeros(0, dtype=np.intp), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0))
