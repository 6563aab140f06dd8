# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which unit a scan may be in, from its size against the part's."""
from __future__ import annotations

import numpy as np

from ..arrays import Array
from .settings import UnitSettings

SCALES = {"m": 1000.0, "dm": 100.0, "cm": 10.0, "in": 25.4}
"""Factors to mm that scans come in beside 1; each may also be off the other way round."""


def extent(scan: Array) -> float:
    """Diagonal in mm of the box that holds all but the outermost 2 % of the points on each side."""
    some = scan[:: max(1, len(scan) // 5_000)]
    low, high = np.quantile(some, [0.02, 0.98], axis=0)
    return float(np.linalg.norm(high - low))


def plausible_scales(scan: Array, size: float, settings: UnitSettings | None = None) -> list[float]:
    """Factors to try on the scan's coordinates, the likeliest first.

    Parameters
    ----------
    scan : (n, 3)
    size : diagonal of the part in mm
    settings : ratios of sizes; None for the defaults
    """
    settings = settings or UnitSettings()
    ratio = max(extent(scan), 1e-300) / size
    factors = [1.0, *SCALES.values(), *(1.0 / factor for factor in SCALES.values())]
    possible = [f for f in factors if settings.possible[0] < ratio * f < settings.possible[1]]
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
