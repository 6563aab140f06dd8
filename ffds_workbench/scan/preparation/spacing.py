# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far apart the points of a scan are: the length that the steps are measured in."""
from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...registration.arrays import Array

_SAMPLE = 5000
_MOST_POINTS = 0.9


def spacing(points: Array) -> float:
    """The distance to the nearest other point that nine of ten points (n, 3) keep; 0 where there are no two points.

    Line scanners measure close along their lines and far across, which the median does not see; up to a tenth of the
    points may be outliers, far from all others.
    """
    if len(points) < 2:
        return 0.0
    chosen = np.random.default_rng(0).permutation(len(points))[:_SAMPLE]
    distances = cKDTree(points).query(points[chosen], k=2)[0][:, 1]
    return float(np.quantile(distances, _MOST_POINTS))
