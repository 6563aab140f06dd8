# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scan points that stand alone: outliers in the air, which a map of deviations shows as patches on unseen skins."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...registration.arrays import Array

_NEIGHBOURS = 8
"""The neighbour whose distance tells how dense points are about one (unit: fewer stray points than that lie
together)."""
_FARTHER = 4.0
"""Times the usual distance of that neighbour (unit: on a surface, points are then sixteen times as sparse as usual)."""


def lone_points(points: Array) -> NDArray[np.bool_]:
    """Which of the points (n, 3) have hardly any others about them; none of so few that nothing is usual."""
    if len(points) <= 2 * _NEIGHBOURS:
        return np.zeros(len(points), dtype=bool)
    distance = cKDTree(points).query(points, _NEIGHBOURS + 1)[0][:, -1]
    return distance > _FARTHER * np.median(distance)
