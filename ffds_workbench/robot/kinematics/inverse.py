# SPDX-License-Identifier: LGPL-2.1-or-later
"""All joint vectors that bring the flange to a pose, in closed form, for many poses at once.

Eight branches: two shoulders (axis 1 turned so that the wrist is before or behind), two elbows, two wrists. Branch
4·shoulder + 2·elbow + wrist is the same configuration at every pose, so that neighbours of one branch are near.
The steps are the geometric sub-problems of Paden and Kahan (Murray, Li, Sastry 1994, section 3.2), with the axes as
they lie at zero.
"""
from __future__ import annotations

import numpy as np

from ...registration.arrays import Array
from .families import Family, link_angles, turn, wrist_height, wrist_start

BRANCHES = 8
_TOUCHING, _FREE = 1e-12, 1e-12
"""By how much a cosine may exceed 1 through rounding: a pose at the very end of the reach is still reached. And the
sine below which two axes of the wrist lie on one line (theory: some thousand times the rounding of doubles)."""


def inverse(arm: Family, poses: Array) -> Array:
    """Joints (n, 8, 6) in (−π, π] for poses (n, 4, 4) of the flange; NaN where a branch does not reach.

    At a singular pose, where one of two joints is free, the first of them is given as zero.
    """
    moved = poses @ np.linalg.inv(arm.chain.home)
    wrists = np.einsum("nij,j->ni", moved[:, :3, :3], arm.wrist) + moved[:, :3, 3]
    first = _first_joint(arm, wrists)
    joints = np.full((len(poses), 2, 2, 2, 6), np.nan)
    joints[..., 0] = first[:, :, None, None]
    # Without the first joint: what the other five have to do.
    back = turn(arm, 0, -first)
    rotation = back @ moved[:, None, :3, :3]
    axis = arm.chain.points[0]
    shift = np.einsum("nsij,nj->nsi", back, moved[:, :3, 3] - axis) + axis
    (_spherical if arm.spherical else _parallel)(arm, rotation, shift, joints)
    bad = np.isnan(joints).any(axis=-1)
    joints[bad] = np.nan
    return wrapped(joints).reshape(len(poses), BRANCHES, 6)


def wrapped(angles: Array) -> Array:
    """Angles in rad brought into (−π, π]."""
    result: Array = np.pi - np.mod(np.pi - angles, 2.0 * np.pi)
    return result


def _first_joint(arm: Family, wrists: Array) -> Array:
    """Joint 1, (n, 2), that leaves the wrist (n, 3) as far along axis 2 as the other joints keep it."""
    x, y, z = arm.frame.T
    off = wrists - arm.chain.points[0]
    ahead, beside = off @ x, off @ y
    opening = _arccos(np.divide(wrist_height(arm), np.maximum(np.hypot(ahead, beside), 1e-12)))
    return -np.arctan2(ahead, beside)[:, None] + np.stack([opening, -opening], axis=1)


def _spherical(arm: Family, rotation: Array, shift: Array, joints: Array) -> None:
    """Joints 2 and 3 bring the wrist into place, 4 to 6 turn it."""
    second, third = _two_links(arm, np.einsum("nsij,j->nsi", rotation, arm.wrist) + shift)
    joints[..., 1], joints[..., 2] = second[..., None], third[..., None]
    rest = np.swapaxes(turn(arm, 1, second) @ turn(arm, 2, third), -1, -2) @ rotation[:, :, None]
    w4, w5, w6 = arm.chain.directions[3:]
    across = np.cross(w5, w4)
    tip = rest @ w6
    along, side, up = tip @ w4, tip @ across, tip @ w5
    out = np.hypot(side, up)
    for branch, sign in enumerate((1.0, -1.0)):
        fourth = np.where(out > _FREE, np.arctan2(sign * up, sign * side), 0.0)
        fifth = np.arctan2(sign * out, along) - wrist_start(arm)
        inner = turn(arm, 3, fourth) @ turn(arm, 4, fifth)
        joints[..., branch, 3], joints[..., branch, 4] = fourth, fifth
        joints[..., branch, 5] = _angle_about(np.swapaxes(inner, -1, -2) @ rest, w6)


def _parallel(arm: Family, rotation: Array, shift: Array, joints: Array) -> None:
    """Joint 5 from the height of axis 6's direction, then 6, then the sum of 2, 3 and 4, then these."""
    y, w6 = arm.frame[:, 1], arm.chain.directions[5]
    opening = _arccos(np.einsum("i,nsij,j->ns", y, rotation, w6))
    sign_3, sign_4 = (float(np.sign(arm.chain.directions[i] @ y)) for i in (2, 3))
    after = np.einsum("nsji,j->nsi", rotation, y)
    for branch, sign in enumerate((1.0, -1.0)):
        fifth = wrist_start(arm) + sign * opening
        bent = turn(arm, 4, fifth)
        sixth = np.where(np.sin(opening) > _FREE, _angle_between(after, np.swapaxes(bent, -1, -2) @ y, w6), 0.0)
        wrist = bent @ turn(arm, 5, sixth)
        total = _angle_about(rotation @ np.swapaxes(wrist, -1, -2), y)
        at = arm.wrist + np.einsum("nsji,j->nsi", turn(arm, 5, sixth), arm.fourth - arm.wrist)
        second, third = _two_links(arm, np.einsum("nsij,nsj->nsi", rotation, at) + shift)
        joints[:, :, :, branch, 1], joints[:, :, :, branch, 2] = second, third
        joints[:, :, :, branch, 3] = sign_4 * (total[..., None] - second - sign_3 * third)
        joints[:, :, :, branch, 4], joints[:, :, :, branch, 5] = fifth[..., None], sixth[..., None]


def _two_links(arm: Family, goals: Array) -> tuple[Array, Array]:
    """Joints 2 and 3, (n, s, 2) each, that bring the forearm's end to goals (n, s, 3), by the law of cosines."""
    sideways, up = arm.frame[:, 0], arm.frame[:, 2]
    off = goals - arm.shoulder
    ahead, above = off @ sideways, off @ up
    first, second = arm.lengths
    bend = _arccos((ahead**2 + above**2 - first**2 - second**2) / (2.0 * first * second))
    bends = np.stack([bend, -bend], axis=-1)
    upper = np.arctan2(ahead, above)[..., None] - np.arctan2(second * np.sin(bends), first + second * np.cos(bends))
    start_1, start_2 = link_angles(arm)
    return upper - start_1, np.sign(arm.chain.directions[2] @ arm.frame[:, 1]) * (bends - start_2 + start_1)


def _arccos(cosines: Array) -> Array:
    """NaN where there is none."""
    kept = np.where(np.abs(cosines) < 1.0 + _TOUCHING, np.clip(cosines, -1.0, 1.0), np.nan)
    result: Array = np.arccos(kept)
    return result


def _angle_about(rotations: Array, axis: Array) -> Array:
    """Angles (…) of rotations (…, 3, 3) about the axis that they have."""
    sine = 0.5 * sum(axis[i] * (rotations[..., (i + 2) % 3, (i + 1) % 3] - rotations[..., (i + 1) % 3, (i + 2) % 3])
                     for i in range(3))
    result: Array = np.arctan2(sine, 0.5 * (np.trace(rotations, axis1=-2, axis2=-1) - 1.0))
    return result


def _angle_between(start: Array, end: Array, axis: Array) -> Array:
    """Angles (…) by which ``start`` (…, 3) turns about the axis to lie over ``end``."""
    result: Array = np.arctan2(np.cross(start, end) @ axis,
                               np.einsum("...i,...i->...", start, end) - (start @ axis) * (end @ axis))
    return result
