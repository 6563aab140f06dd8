# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many scan points a preview uses while a control moves; once it rests, all of them count."""
from __future__ import annotations

import numpy as np

from ...registration.arrays import Array

_FACE_POINTS, _WHOLE_POINTS = 3000, 8000
"""Points of one face and of a whole part whose deviations are shown (unit: a picture hardly changes with more)."""
FITTED_POINTS = 4000
"""Points that a face is fitted to (unit: so few that the picture follows the mouse)."""


def every_nth(count: int) -> int:
    """Every how many of ``count`` points near a face are looked at."""
    return max(1, -(-count // _FACE_POINTS))


def thinned(points: Array) -> Array:
    """Some of the points (n, 3) of a whole scan, drawn at random but always the same."""
    return points[np.random.default_rng(0).permutation(len(points))[:_WHOLE_POINTS]]
