# SPDX-License-Identifier: LGPL-2.1-or-later
"""An arm's configuration as its controller writes it beside a pose, so that the pose is reached as it was planned."""
from __future__ import annotations

import numpy as np

from ..registration.arrays import Array
from .arms import Arm
from .kinematics import posture


def configurations(arm: Arm, joints: Array) -> tuple[str, ...]:
    """One text per row of joints (n, 6) in rad; empty for makers whose programs have none.

    FANUC: wrist (N: joint 5 below zero), elbow (U), front (T), and whole turns of joints 1, 4 and 6. Yaskawa: 1 where R
    lies within ±90° (no flip), 1 where the elbow is below, 1 where the wrist is behind, and 1 where R, T and S are
    beyond 180°. Both are from memory, as neither maker's manual was at hand; ``resources/docs/robot.md`` says so to
    users.
    """
    if arm.maker not in ("fanuc", "yaskawa") or not arm.family.spherical:
        return ()
    bend, out = posture(arm.family, joints)
    front = out > 0.0
    above = (bend > 0.0) == front
    degrees = np.degrees(joints)
    if arm.maker == "fanuc":
        turns = np.floor((degrees[:, [0, 3, 5]] + 180.0) / 360.0).astype(int).tolist()
        return tuple(f"{'N' if five < 0.0 else 'F'} {'U' if up else 'D'} {'T' if ahead else 'B'}, "
                     f"{one}, {four}, {six}"
                     for five, up, ahead, (one, four, six) in zip(degrees[:, 4], above, front, turns, strict=True))
    beyond = (np.abs(degrees[:, [3, 5, 0]]) >= 180.0).astype(int).tolist()
    flat = np.abs((degrees[:, 3] + 180.0) % 360.0 - 180.0) <= 90.0
    return tuple(f"{int(r)},{int(not up)},{int(not ahead)},{','.join(map(str, far))}"
                 for r, up, ahead, far in zip(flat, above, front, beyond, strict=True))
