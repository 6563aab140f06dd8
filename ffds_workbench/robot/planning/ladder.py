# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cheapest way along a seam: one hold per station, each near the one before, by dynamic programming.

A ladder graph, as in Descartes (ROS-Industrial): rungs are stations, and only holds of one branch whose leans and yaws
are neighbours are joined, so that a step is a few shifted arrays and not a matrix of all pairs.
"""
from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from ...registration.arrays import Array, Index
from .course import Course
from .holds import CARED_FOR, YAWS, Flags, Holds, Turns, lowest

_SPEED_SHARE = 0.9
"""Share of the joints' speeds that a way along the grid of yaws may take; what comes of it is smoother still (unit)."""
_TURN = 2.0 * np.pi
_YAW_COST = 0.0005
"""Of a step of yaw, beside the joints' own motion, whose cost is its length in rad (unit: small, so that
of equal ways that is taken which turns the torch less)."""
_LEAN_COST, _CLEARANCE_COST, _SINGULAR_COST = 20.0, 3.0, 3.0
"""Of holding the torch so along the whole seam, in rad of joint motion: per rad² of lean, at no clearance, and at no
distance from singularity; the latter fall to none at `CARED_FOR` and `_SOUND` (unit: what one is worth in terms of the
other)."""
_SOUND = 0.3
"""Distance from singularity beyond which more of it is worth nothing (unit)."""


@dataclass(frozen=True)
class Way:
    """One hold per station: indices (n,) of lean, yaw and branch, and the ``cost`` of it all; it may end early."""

    lean: Index
    yaw: Index
    branch: Index
    cost: float

    @property
    def length(self) -> int:
        """How many stations it gets along."""
        return len(self.yaw)


def cheapest(holds: Holds, usable: Flags, course: Course, speeds: Array, turns: Turns) -> Way:
    """The cheapest way, or that which gets farthest.

    Parameters
    ----------
    usable : (n, a, y, b) which holds may be used
    course : its times, and how much it turns: the yaw may follow that
    speeds : (6,) of the joints in rad/s
    turns : one of `turns_of`
    """
    times, turning = course.times, course.turning
    holds, free = replace(holds, joints=lowest(holds.joints, turns[0])), turns[1]
    place = _cost_of_place(holds)
    best = np.where(usable[0], place[0], np.inf)
    came: list[Index] = []
    for station in range(1, len(usable)):
        reach = 2 + int(np.ceil(turning[station - 1] / (_TURN / YAWS)))
        total, origin = _step(holds, best, station, times[station - 1], speeds, free, reach)
        total = np.where(usable[station], total + place[station], np.inf)
        if not np.isfinite(total).any():
            break
        came.append(origin)
        best = total
    return _traced(best, came)


def _cost_of_place(holds: Holds) -> Array:
    lean = _LEAN_COST * np.square(holds.leans).sum(axis=1)
    near = _CLEARANCE_COST * np.square(1.0 - np.clip(holds.torch / CARED_FOR, 0.0, 1.0))
    singular = _SINGULAR_COST * np.square(1.0 - np.clip(holds.singularity / _SOUND, 0.0, 1.0))
    return (lean[:, None, None] + near[..., None] + singular) / len(near)


def _step(holds: Holds, best: Array, station: int, time: float, speeds: Array, free: Flags, reach: int
          ) -> tuple[Array, Index]:
    """Costs (a, y, b) of getting to each hold of a station, and the flat indices of those they come from."""
    before, here = holds.joints[station - 1], holds.joints[station]
    total, origin = np.full(best.shape, np.inf), np.zeros(best.shape, dtype=np.intp)
    numbers = np.arange(best.size).reshape(best.shape)
    for lean in _neighbours(holds.leans):
        for shift in range(-reach, reach + 1) if len(holds.yaws) > 1 else (0,):
            moved = [np.roll(values[lean], shift, axis=1) for values in (best, before, numbers)]
            if shift and not holds.around:
                moved[0][:, (slice(None, shift) if shift > 0 else slice(shift, None))] = np.inf
            apart = here - moved[1]
            apart = np.where(free, apart - _TURN * np.round(apart / _TURN), apart)
            share = np.abs(apart) / (speeds * time)
            cost = moved[0] + np.sqrt(np.square(apart).sum(axis=-1)) + _YAW_COST * abs(shift)
            better = (share.max(axis=-1) <= _SPEED_SHARE) & (cost < total)
            total, origin = np.where(better, cost, total), np.where(better, moved[2], origin)
    return total, origin


def _neighbours(leans: Array) -> list[Index]:
    """For each of the up to nine steps on the grid of leans, which lean each one comes from; itself where none is."""
    steps = np.stack([np.unique(column, return_inverse=True)[1] for column in leans.T], axis=1)
    at = {tuple(step): number for number, step in enumerate(steps.tolist())}
    found = {tuple(at.get((up + i, aside + j), number) for number, (up, aside) in enumerate(steps.tolist()))
             for i, j in itertools.product((-1, 0, 1), repeat=2)}
    return [np.array(item) for item in sorted(found)]


def _traced(best: Array, came: list[Index]) -> Way:
    """Back from the cheapest end."""
    if not np.isfinite(best).any():
        none = np.empty(0, dtype=np.intp)
        return Way(none, none, none, np.inf)
    at = int(best.argmin())
    ways = [at]
    for origin in reversed(came):
        at = int(origin.ravel()[at])
        ways.append(at)
    lean, yaw, branch = np.unravel_index(np.array(ways[::-1]), best.shape)
    return Way(lean, yaw, branch, float(best.min()))
