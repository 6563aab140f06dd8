# SPDX-License-Identifier: LGPL-2.1-or-later
"""One seam: how the torch is held along it, or where and why it cannot be."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solveh_banded
from scipy.sparse import diags
from scipy.spatial.transform import Rotation, Slerp

from ...registration.arrays import Array
from ...registration.motions import motion
from ..cells import Cell
from ..clearance import Moving
from ..kinematics import distance_to_singularity, inverse, wrapped
from .course import Course
from .failure import LIMIT, MOTION, REACH, Failure, why
from .holds import LEAST_SINGULARITY, Flags, Holds, Turns, holds_of, leans_of, tips_along, turns_of
from .ladder import Way, cheapest

TOLD_CLEARANCE = 100.0
"""Clearance in mm up to which it is measured for the report (unit: farther off is free)."""
_SMOOTHINGS = (300.0, 30.0, 3.0)
"""Weights of the second differences of yaw and lean, the smoothest first: the first that keeps all limits is taken
(unit: how many are tried is what time is worth)."""


@dataclass(frozen=True)
class SeamPath:
    """How a seam is welded, or as far as it can be.

    Attributes
    ----------
    tips : (n, 4, 4) poses of the wire's tip in the frame of the model
    joints : (n, 6) in rad; NaN from where it cannot be welded
    yaws : (n,) in rad; ``leans``: (n, 2) in rad
    singularity : (n,) distance from it, 0 to 1; ``clearance``: (n,) in mm, up to `TOLD_CLEARANCE`
    failure : None where the whole seam can be welded
    """

    tips: Array
    joints: Array
    yaws: Array
    leans: Array
    singularity: Array
    clearance: Array
    failure: Failure | None = None


def plan_path(moving: Moving, cell: Cell, course: Course) -> SeamPath:
    """Hold the torch as the seam says, and only where that fails lean it as far as the cell allows."""
    path = _planned(moving, cell, course, np.zeros((1, 2)))
    if path.failure is None or path.failure.reason == REACH:
        return path
    leans = leans_of(moving, cell, course.torch, course.positions)
    if not len(leans):
        return path
    leaning = _planned(moving, cell, course, leans)
    return leaning if leaning.failure is None or leaning.failure.station > path.failure.station else path


def _planned(moving: Moving, cell: Cell, course: Course, leans: Array) -> SeamPath:
    holds = holds_of(moving, cell, course.torch, course.positions, leans)
    sound = holds.within & (holds.singularity >= LEAST_SINGULARITY) & (holds.torch >= cell.clearance)[..., None]
    arm_clear = np.ones(sound.shape, dtype=bool)
    best: SeamPath | None = None
    for turns in turns_of(moving.arm.limits):
        path = _one_way(moving, cell, course, holds, sound, arm_clear, turns)
        if path.failure is None:
            return path
        if best is None or best.failure is None or path.failure.station > best.failure.station:
            best = path
        if path.failure.reason not in (LIMIT, MOTION):
            break
    assert best is not None
    return best


def _one_way(moving: Moving, cell: Cell, course: Course, holds: Holds, sound: Flags, arm_clear: Flags,
             turns: Turns) -> SeamPath:
    """The cheapest way with one choice of turns, smoothed as far as nothing speaks against it."""
    way = _clear_way(moving, cell, course, holds, sound, arm_clear, turns)
    yaws, lean = np.unwrap(holds.yaws[way.yaw]), holds.leans[way.lean]
    if way.length < len(course.positions):
        return _ended(moving, course, way, yaws, lean, why(moving, cell, holds, arm_clear, way.length))
    branch = int(way.branch[0])
    rough = _followed(moving, course, yaws, lean, branch)
    trouble = _trouble(moving, cell, course, rough)
    for weight in _SMOOTHINGS if len(holds.yaws) > 1 or len(holds.leans) > 1 else ():
        smooth = _followed(moving, course, _smoothed(yaws, weight), _smoothed(lean, weight), branch)
        if _trouble(moving, cell, course, smooth) is None:
            return smooth
    return rough if trouble is None else replace(rough, failure=trouble)


def _clear_way(moving: Moving, cell: Cell, course: Course, holds: Holds, sound: Flags, arm_clear: Flags,
               turns: Turns) -> Way:
    """The cheapest way on which the arm keeps clear; ``arm_clear`` learns of it.

    Only branches that a way leads through are measured.
    """
    measured: set[int] = set()
    while True:
        way = cheapest(holds, sound & arm_clear, course, moving.arm.speeds, turns)
        stations = np.arange(way.length)
        joints = holds.joints[stations, way.lean, way.yaw, way.branch]
        new = set(way.branch.tolist()) - measured
        if not new or (moving.links(joints, cell.clearance).distances >= cell.clearance).all():
            return way
        for branch in new:
            ways = np.nonzero(sound[..., branch])
            near = moving.links(holds.joints[(*ways, branch)], cell.clearance).distances < cell.clearance
            arm_clear[tuple(index[near] for index in ways) + (branch,)] = False
        measured |= new


def _followed(moving: Moving, course: Course, yaws: Array, leans: Array, branch: int) -> SeamPath:
    """The path with given yaws (n,) and leans (n, 2), its joints without jumps."""
    tips = tips_along(course, leans, yaws)
    joints = led(moving, tips, branch)
    return SeamPath(tips, joints, wrapped(yaws), leans, distance_to_singularity(moving.arm.family, joints),
                    moving.all(joints, TOLD_CLEARANCE).distances)


def led(moving: Moving, tips: Array, branch: int) -> Array:
    """Joints (n, 6) of one branch along poses of the tip, without jumps, in the turn that keeps the limits best."""
    joints = np.unwrap(inverse(moving.arm.family, moving.flange(tips))[:, branch], axis=0)
    low, high = moving.arm.limits.T
    middle = 0.5 * (joints.min(axis=0) + joints.max(axis=0))
    turns = np.round((0.5 * (low + high) - middle) / (2.0 * np.pi))
    result: Array = joints + 2.0 * np.pi * turns
    return result


def branch_of(moving: Moving, joints: Array) -> int:
    """Which branch joints (6,) belong to."""
    found = inverse(moving.arm.family, moving.arm.chain.flange(joints[None]))[0]
    return int(np.nan_to_num(np.abs(wrapped(found - joints)).max(axis=1), nan=np.inf).argmin())


def _trouble(moving: Moving, cell: Cell, course: Course, path: SeamPath) -> Failure | None:
    """What speaks against a path, also half-way between stations; None: nothing."""
    low, high = moving.arm.limits.T
    beyond = np.isnan(path.joints).any(axis=1) | ((path.joints < low - 1e-9) | (path.joints > high + 1e-9)).any(axis=1)
    if beyond.any():
        station = int(beyond.argmax())
        return Failure(station, LIMIT, f"at station {station + 1} a joint has turned as far as it goes")
    between = halfway(path.tips)
    joints = led(moving, np.concatenate([path.tips[:1], between]), branch_of(moving, path.joints[0]))[1:]
    close = path.clearance < cell.clearance - 1e-6
    close[:-1] |= np.isnan(joints).any(axis=1) | (moving.all(np.nan_to_num(joints), cell.clearance + 1.0).distances
                                                  < 0.9 * cell.clearance)
    close |= path.singularity < LEAST_SINGULARITY
    if close.any():
        station = int(close.argmax())
        return Failure(station, MOTION, f"between station {station + 1} and the next the torch comes too near")
    speed = np.diff(path.joints, axis=0) / course.times[:, None]
    change = np.abs(np.diff(speed, axis=0)) / (0.5 * (course.times[1:] + course.times[:-1]))[:, None]
    fast = (np.abs(speed) > moving.arm.speeds).any(axis=1)
    fast[1:] |= (change > moving.arm.accelerations).any(axis=1)
    if fast.any():
        station = int(fast.argmax()) + 1
        return Failure(station, MOTION, f"the joints are too slow to follow to station {station + 1}: weld more slowly")
    return None


def halfway(tips: Array) -> Array:
    """Poses (n − 1, 4, 4) in the middle of the straight moves between poses (n, 4, 4)."""
    times = np.arange(len(tips), dtype=float)
    return moved_along(tips, times, times[:-1] + 0.5)


def moved_along(tips: Array, times: Array, at: Array) -> Array:
    """Poses at the times ``at`` (m,) of moves that pass poses (n, 4, 4) at ``times`` (n,), straight in between."""
    turned = Slerp(times, Rotation.from_matrix(tips[:, :3, :3]))(at).as_matrix()
    return motion(turned, np.stack([np.interp(at, times, column) for column in tips[:, :3, 3].T], axis=1))


def _ended(moving: Moving, course: Course, way: Way, yaws: Array, leans: Array, failure: Failure) -> SeamPath:
    """As far as a way gets; beyond, the torch is held as the seam says."""
    count, got = len(course.positions), way.length
    path = SeamPath(motion(course.torch, course.positions), np.full((count, 6), np.nan), np.zeros(count),
                    np.zeros((count, 2)), np.zeros(count), np.full(count, np.nan), failure)
    if got:
        begun = _followed(moving, course, yaws, leans, int(way.branch[0]))
        for name in ("tips", "joints", "yaws", "leans", "singularity", "clearance"):
            getattr(path, name)[:got] = getattr(begun, name)
    return path


def _smoothed(values: Array, weight: float) -> Array:
    """Values (n,) or (n, k) with their second differences weighed (Whittaker 1923, Hodrick and Prescott 1997)."""
    count = len(values)
    if count < 3:
        return values
    second = diags((1.0, -2.0, 1.0), (0, 1, 2), (count - 2, count))
    roughness = second.T @ second
    band = np.stack([np.append(weight * roughness.diagonal(k), np.zeros(k)) for k in range(3)])
    band[0] += 1.0
    result: Array = solveh_banded(band, values, lower=True)
    return result


def replay(moving: Moving, path: SeamPath, times: Array, step: float = 0.004) -> tuple[Array, Array]:
    """The path as a controller runs it: joints (m, 6) and poses (m, 4, 4) every ``step`` seconds.

    Parameters
    ----------
    times : (n − 1,) seconds from station to station
    """
    passed = np.append(0.0, np.cumsum(times))
    tips = moved_along(path.tips, passed, np.arange(0.0, passed[-1], step))
    return led(moving, tips, branch_of(moving, path.joints[0])), tips
