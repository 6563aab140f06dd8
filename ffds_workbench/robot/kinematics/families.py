# SPDX-License-Identifier: LGPL-2.1-or-later
"""The two families of arms whose joints follow from a pose in closed form, recognised by how their axes lie.

Both have axis 1 square to axis 2 and axis 3 parallel to axis 2. Arms with a spherical wrist have axes 4, 5 and 6
through one point; those of the kind of Universal Robots have axis 4 parallel to 2 and 3, and 5 meets 4 and 6.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from .chain import Chain, rotation_about

_SQUARE, _MEETS = 1e-6, 1e-3
"""Largest cosine of axes that count as square, and distance in mm of axes that count as meeting: files have rounded
numbers (unit)."""


@dataclass(frozen=True)
class Family:
    """What the inverse needs of a chain.

    Attributes
    ----------
    chain : the arm
    spherical : whether the wrist is; otherwise the arm is of the kind of Universal Robots
    frame : (3, 3) columns x, y, z of the frame in which it is solved: z along axis 1, y along axis 2
    shoulder, elbow : (3,) points in mm on axes 2 and 3, in the plane in which the wrist moves
    wrist : (3,) in mm: where axes 4, 5 and 6 meet, or where axes 5 and 6 do
    fourth : (3,) in mm: what joints 2 and 3 have to bring into place, the wrist or a point on axis 4
    """

    chain: Chain
    spherical: bool
    frame: Array
    shoulder: Array
    elbow: Array
    wrist: Array
    fourth: Array

    @property
    def lengths(self) -> tuple[float, float]:
        """Of upper arm and forearm in mm, seen along axis 2."""
        first, second = (np.linalg.norm(np.delete(self.frame.T @ step, 1))
                         for step in (self.elbow - self.shoulder, self.fourth - self.elbow))
        return float(first), float(second)


def family(chain: Chain) -> Family:
    """The family of an arm.

    Raises
    ------
    InputError : its axes lie in another way, so that no closed form is known here
    """
    z, y = chain.directions[0], chain.directions[1]
    parallel = [abs(abs(direction @ y) - 1.0) < _SQUARE for direction in chain.directions]
    if abs(z @ y) > _SQUARE or not parallel[2]:
        raise InputError("The arm's joints follow from no pose in closed form: its first axis must be square to its "
                         "second, and the third parallel to that.")
    frame = np.stack([np.cross(y, z), y, z], axis=1)
    first, second = _meeting(chain, 4, 5), _meeting(chain, 3, 4)
    if first is None or second is None:
        raise InputError("The arm's joints follow from no pose in closed form: its wrist axes do not meet.")
    spherical = bool(np.linalg.norm(first - second) < _MEETS) and not parallel[3]
    square = all(abs(chain.directions[i] @ chain.directions[i + 1]) < _SQUARE for i in (3, 4))
    if not square or not (spherical or parallel[3]):
        raise InputError("The arm's joints follow from no pose in closed form: it has neither a spherical wrist nor "
                         "three parallel axes.")
    fourth = first if spherical else second
    return Family(chain, spherical, frame, chain.points[1], chain.points[2], first, fourth)


def _meeting(chain: Chain, one: int, other: int) -> Array | None:
    """Where two axes that are not parallel meet, or None."""
    a, b, between = chain.directions[one], chain.directions[other], chain.points[other] - chain.points[one]
    normal = np.cross(a, b)
    if np.linalg.norm(normal) < _SQUARE or abs(between @ normal) / np.linalg.norm(normal) > _MEETS:
        return None
    along = np.linalg.lstsq(np.stack([a, -b], axis=1), between, rcond=None)[0]
    return chain.points[one] + along[0] * a


def wrist_height(arm: Family) -> float:
    """How far in mm the wrist lies from axis 1 along axis 2, which joints 2 and 3 (and a parallel 4) cannot change."""
    return float((arm.wrist - arm.chain.points[0]) @ arm.frame[:, 1])


def link_angles(arm: Family) -> tuple[float, float]:
    """Where upper arm and forearm point at zero: angles in rad about axis 2 from axis 1."""
    x, _, z = arm.frame.T
    first, second = (float(np.arctan2(step @ x, step @ z)) for step in (arm.elbow - arm.shoulder,
                                                                        arm.fourth - arm.elbow))
    return first, second


def wrist_start(arm: Family) -> float:
    """Angle in rad of axis 6 about axis 5 at zero, from axis 4 (spherical), or of axis 2 from axis 6 (parallel)."""
    w4, w5, w6 = arm.chain.directions[3:]
    if arm.spherical:
        return float(np.arctan2(w6 @ np.cross(w5, w4), w6 @ w4))
    y = arm.frame[:, 1]
    return float(np.arctan2(y @ np.cross(w5, w6), y @ w6))


def turn(arm: Family, joint: int, angles: Array) -> Array:
    """Rotations (…, 3, 3) of a joint (0 to 5) by ``angles`` (…) in rad."""
    return rotation_about(arm.chain.directions[joint], angles)


def posture(arm: Family, joints: Array) -> tuple[Array, Array]:
    """How joints (…, 6) hold upper arm and forearm.

    Returns
    -------
    bend : (…) of the elbow in rad about axis 2, 0 where the arm is straight
    out : (…) in mm: how far the forearm's end is in front of axis 1, negative behind it
    """
    start_1, start_2 = link_angles(arm)
    first, second = arm.lengths
    upper = start_1 + joints[..., 1]
    bend = start_2 - start_1 + float(np.sign(arm.chain.directions[2] @ arm.frame[:, 1])) * joints[..., 2]
    shoulder = (arm.shoulder - arm.chain.points[0]) @ arm.frame[:, 0]
    return bend, shoulder + first * np.sin(upper) + second * np.sin(upper + bend)


def distance_to_singularity(arm: Family, joints: Array) -> Array:
    """How far joints (…, 6) are from a pose in which the arm loses a direction: 0 at it, at most 1.

    The least of three: the sine of the angle between axes 4 and 6 (wrist), that of the bend of the elbow, and the
    distance of the wrist from where axis 1 cannot move it, as a share of the arm's length.
    """
    bend, out = posture(arm, joints)
    wrist = joints[..., 4] + (wrist_start(arm) if arm.spherical else -wrist_start(arm))
    if not arm.spherical:
        sign_3, sign_4 = (float(np.sign(arm.chain.directions[i] @ arm.frame[:, 1])) for i in (2, 3))
        x, _, z = arm.frame.T
        last = arm.wrist - arm.fourth
        total = joints[..., 1] + sign_3 * joints[..., 2] + sign_4 * joints[..., 3]
        out = out + np.hypot(last @ x, last @ z) * np.sin(np.arctan2(last @ x, last @ z) + total)
    return np.minimum.reduce([np.abs(np.sin(wrist)), np.abs(np.sin(bend)), np.abs(out) / sum(arm.lengths)])
