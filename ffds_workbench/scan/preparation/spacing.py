# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far apart the points of a scan are: the length that the steps are measured in."""
from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...registration.arrays import Array

_SAMPLE, _TWINS = 5000, 8
"""Points that are looked at, and how many others may lie in the same place, as where a scan was fused twice."""
_MOST_POINTS = 0.9


def spacing(points: Array) -> float:
    """The distance to the nearest point elsewhere that nine of ten points (n, 3) keep; 0 where there is none.

    Line scanners measure close along their lines and far across, which the median does not see; up to a tenth of the
    points may be outliers, far from all others.
    """
    if len(points) < 2:
        return 0.0
    chosen = np.random.default_rng(0).permutation(len(points))[:_SAMPLE]
    distances = cKDTree(points).query(points[chosen], k=_TWINS + 2)[0]
    nearest = np.where(distances > 0.0, distances, np.inf).min(axis=1)
    apart = nearest[np.isfinite(nearest)]
    return float(np.quantile(apart, _MOST_POINTS)) if len(apart) else 0.0
