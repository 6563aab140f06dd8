# SPDX-License-Identifier: LGPL-2.1-or-later
"""Straight down to a seam's end and away from it, along the torch."""
from __future__ import annotations

import numpy as np

from ...registration.arrays import Array
from ..cells import Cell
from ..clearance import Moving
from ..kinematics import inverse
from .seam_path import branch_of

_STEP = 4.0
"""Distance in mm of the places on the way that are looked at (unit: what time is worth)."""


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
    way = within_branch(moving, tips, joints)
    if way is None:
        return None
    clear = moving.all(way, cell.clearance + 1.0).distances
    # At the seam itself the torch is as near as it is there.
    return None if (clear < min(cell.clearance, clear[0]) - 1e-6).any() else way[-1]


def within_branch(moving: Moving, tips: Array, joints: Array) -> Array | None:
    """Joints (n, 6) along poses (n, 4, 4) of the tip in the configuration of ``joints`` (6,), which are near the first.

    None where that does not reach or a limit is in the way.
    """
    found = inverse(moving.arm.family, moving.flange(tips))[:, branch_of(moving, joints)]
    if np.isnan(found).any():
        return None
    way = np.unwrap(found, axis=0)
    # In the turn of the joints that it goes on from.
    way += 2.0 * np.pi * np.round((joints - way[0]) / (2.0 * np.pi))
    low, high = moving.arm.limits.T
    return None if ((way < low - 1e-9) | (way > high + 1e-9)).any() else way
