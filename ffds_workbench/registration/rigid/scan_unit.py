# SPDX-License-Identifier: LGPL-2.1-or-later
"""The unit of a scan.

Which units are plausible from its size against the part's (`plausible_scales`, before it is aligned); and whether its
unit differs from that of the model that it should lie on, by size and position (`unit_mismatch`).

A partial view, or a table beside the part, changes the size of the scan just as a wrong unit does. So the position
counts first: if the scan lies on the part as it is, no other unit is suggested, unless one makes it fill the part.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..arrays import Array
from .settings import UnitSettings

SCALES = {"m": 1000.0, "dm": 100.0, "cm": 10.0, "in": 25.4}
"""Factors to mm that scans come in beside 1 (theory: definitions of the units); each may also be off the other way
round."""
FACTORS = (*SCALES.values(), *(1.0 / factor for factor in SCALES.values()))
"""What a scan may have to be multiplied by."""
Surface = Callable[[], tuple[Array, Array]]
"""Gives points (m, 3) spread over a part, and the unit normals there (m, 3), when they are needed."""

_USUAL_RATIO = (0.2, 1.6)
"""Size of a scan against its part's, as partial views and clutter leave it; theory: a whole one has .7 to 1, by how its
points are spread, and the smallest factor, 10, brings no view of more than a fifth of the part into this range."""
_EXPLAINED_RATIO = (0.1, 1.6)
"""Size of a scan against its part's, once multiplied by a factor that explains it (theory: as above, and half of the
smallest for one seen from aside)."""
_CLUTTERED_RATIO = 16.0
"""Where it may bring that of a scan with much beside the part; theory: ten times the largest that is explained."""
_ABSURD_RATIO = (0.12, 6.0)
"""Beyond this a scan that does not lie on the part is in another unit, wherever it lies; theory: off by 10, a whole one
has no more than .1 or no less than 7."""
_ON_PART, _HALF = 0.8, 0.5
"""Share of the points near the part that has to lie on it to speak for a factor, and of the part's size that they have
to span to fill it; and how much nearer they have to be, or how much less they have to span, as they are (calibrated: by
hand, on the scans of tests/api/test_units.py)."""
_REACH, _MARGIN = 0.03, 0.05
"""How far from the part its deformed scan may lie, over the scan's size, and beyond the part's box, over the part's
(unit: sheet metal springs back by a few hundredths of its size)."""
_LOOKED_AT, _NEAR_POINTS = 2_000, 50
"""Points of a scan that are looked at (unit: time), and how many near the part tell anything (unit)."""


@dataclass(frozen=True)
class _Part:
    """A part's box, and points and normals spread over its surface, as a tree."""

    low: Array
    high: Array
    points: Array
    normals: Array
    tree: cKDTree
    spacing: float

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.high - self.low))

    def near(self, scan: Array) -> tuple[Array, Array]:
        """Those of the points (n, 3) that lie in the box or close to it, none where they are few, and their distances
        from the surface (n,)."""
        margin = _MARGIN * self.size
        near = scan[((scan > self.low - margin) & (scan < self.high + margin)).all(axis=1)]
        if len(near) < min(_NEAR_POINTS, len(scan)):
            return near[:0], np.empty(0)
        apart, place = self.tree.query(near)
        off = np.abs(((near - self.points[place]) * self.normals[place]).sum(axis=1))
        return near, np.where(apart < 3.0 * self.spacing + off, off, apart)


@dataclass(frozen=True)
class _Fit:
    """How a scan that is multiplied by a factor lies on a part.

    Attributes
    ----------
    share : of the points near the part that lie on it
    span : size of what they cover, as a part of the part's
    count : of them
    distance : median distance of the points near the part from it in mm
    """

    factor: float
    share: float
    span: float
    count: int
    distance: float


def box_of(points: Array) -> tuple[Array, Array, float]:
    """Corners of the box that holds all but the outermost 2 % of points (n, 3) on each side, and its diagonal."""
    some = points[:: max(1, len(points) // 20_000)]
    low, high = np.quantile(some, [0.02, 0.98], axis=0)
    return low, high, float(np.linalg.norm(high - low))


def plausible_scales(scan: Array, size: float, settings: UnitSettings | None = None) -> list[float]:
    """Factors to try on the scan's coordinates, the likeliest first.

    Parameters
    ----------
    scan : (n, 3)
    size : diagonal of the part in mm
    settings : ratios of sizes; None for the defaults
    """
    settings = settings or UnitSettings()
    ratio = max(box_of(scan)[2], 1e-300) / size
    possible = [f for f in (1.0, *FACTORS) if settings.possible[0] < ratio * f < settings.possible[1]]
    trusted = settings.trusted[0] < ratio < settings.trusted[1]
    return sorted(possible, key=lambda f: (not (trusted and f == 1.0), abs(np.log(ratio * f))))[:settings.tried]


def unit_name(scale: float) -> str:
    """What a factor to mm is called: "m" for 1000, "mm" for 1; "mm / 25.4" for the other way round."""
    for name, factor in SCALES.items():
        if np.isclose(scale, factor):
            return name
        if np.isclose(scale * factor, 1.0):
            return f"mm / {factor:g}"
    return "mm" if np.isclose(scale, 1.0) else f"{scale:g} mm"


def unit_mismatch(scan: Array, low: Array, high: Array, surface: Surface) -> float | None:
    """The factor that the coordinates of a scan (n, 3) have to be multiplied by to be a scan of the part.

    Parameters
    ----------
    low, high : (3,) corners of the part's box
    surface : the part's surface

    Returns
    -------
    one of `FACTORS`; None where the scan may be as it is, or where no factor explains it
    """
    ratio = max(box_of(scan)[2], 1e-300) / float(np.linalg.norm(high - low))
    if _USUAL_RATIO[0] < ratio < _USUAL_RATIO[1]:
        return None
    part = _part(low, high, surface)
    some = scan[np.linspace(0, len(scan) - 1, min(len(scan), _LOOKED_AT)).astype(int)]

    now = _fit(part, some, 1.0, ratio)
    fits = [fit for fit in (_fit(part, some, factor, ratio) for factor in FACTORS
                            if _EXPLAINED_RATIO[0] < ratio * factor < _CLUTTERED_RATIO) if fit.share > _ON_PART]
    if fits:
        best = max(fits, key=lambda fit: (round(5.0 * fit.span), fit.count))
        nearer = now.share < _ON_PART and best.distance < _HALF * now.distance
        fills = best.span > _ON_PART and now.span < _HALF * best.span
        if nearer or fills:
            return best.factor
    return unit_by_size(scan, part.size) if now.distance > _REACH * part.size else None


def _fit(part: _Part, scan: Array, factor: float, ratio: float) -> _Fit:
    near, distances = part.near(factor * scan)
    on = near[distances < _REACH * min(ratio * factor, 1.0) * part.size]
    if not len(on):
        return _Fit(factor, 0.0, 0.0, 0, np.inf)
    span = box_of(on)[2] / box_of(part.points)[2]
    return _Fit(factor, len(on) / len(near), span, len(on), float(np.median(distances)))


def unit_by_size(scan: Array, size: float) -> float | None:
    """The factor that brings a scan (n, 3), wherever it lies, nearest to a part of this size; None where it may be as
    large as it is, or where none does."""
    ratio = max(box_of(scan)[2], 1e-300) / size
    explained = [factor for factor in FACTORS if _EXPLAINED_RATIO[0] < ratio * factor < _EXPLAINED_RATIO[1]]
    if _ABSURD_RATIO[0] < ratio < _ABSURD_RATIO[1] or not explained:
        return None
    return min(explained, key=lambda factor: abs(np.log(ratio * factor)))


def _part(low: Array, high: Array, surface: Surface) -> _Part:
    points, normals = surface()
    tree = cKDTree(points)
    apart, _ = tree.query(points[:: max(1, len(points) // 500)], 2)
    return _Part(low, high, points, normals, tree, float(np.median(apart[:, 1])))
