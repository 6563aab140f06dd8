# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight down to a seam's end and away from it, along the torch."""
from __future__ import annotations

import numpy as np

from ...registration.arrays import Array
from ..cells import Cell
from ..clearance import Moving
from ..kinematics import inverse, wrapped
from .seam_path import branch_of

_STEP = 4.0
"""Distance in mm of the places on the way that are looked at."""


def leaving(moving: Moving, cell: Cell, tip: Array, joints: Array, distance: float) -> Array | None:
    """Joints (6,) above a seam's end, straight back along the torch; None where that is not free.

    Parameters
    ----------
    tip : (4, 4) pose of the wire's tip at the end, and its ``joints`` (6,)
    distance : in mm
    """
    count = 2 + int(distance / _STEP)
    tips = np.tile(tip, (count, 1, 1))
    tips[:, :3, 3] -= np.linspace(0.0, distance, count)[:, None] * tip[:3, 2]
    found = inverse(moving.arm.family, moving.flange(tips))[:, branch_of(moving, joints)]
    if np.isnan(found).any():
        return None
    way = np.unwrap(found, axis=0)
    way += joints - way[0] - wrapped(joints - way[0])
    low, high = moving.arm.limits.T
    if ((way < low - 1e-9) | (way > high + 1e-9)).any():
        return None
    clear = moving.all(way, cell.clearance + 1.0).distances
    # At the seam itself the torch is as near as it is there.
    return None if (clear < min(cell.clearance, clear[0]) - 1e-6).any() else way[-1]
