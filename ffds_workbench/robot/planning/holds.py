# SPDX-License-Identifier: LGPL-2.1-or-later
"""All ways of holding the torch at each station of a seam, and what stands against each of them.

A way is a lean (work and travel angle), a yaw about the wire and a branch of the arm. Arrays over ways have the axes
stations, leans, yaws, branches.
"""
from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ...registration.arrays import Array, Index
from ...registration.motions import motion
from ..cells import Cell
from ..clearance import Moving
from ..kinematics import BRANCHES, distance_to_singularity, inverse
from .course import Course

Flags = NDArray[np.bool_]

YAWS = 72
"""Yaws about the wire if it is free: steps of 5° (unit: what time is worth; a way found on them is smoothed)."""
LEAST_SINGULARITY = 0.05
"""Distance from singularity below which the arm is not led (unit): its joints would race where the wire creeps."""
CARED_FOR = 20.0
"""Clearance in mm beyond which more of it is worth nothing (unit: about as wide as a nozzle)."""
_OFTEN = 0.7
"""A lean is tried that is clear at this share of the stations at which the best lean is (unit: what time is worth)."""
_CHUNK = 20_000
"""Poses whose joints are sought at once (unit: what memory is worth; each takes a few kB on the way)."""
_TURN = 2.0 * np.pi


Turns = tuple[Array, Flags]
"""From which angle on joints are counted, and which of them go round freely."""


@dataclass(frozen=True)
class Holds:
    """The ways of holding the torch.

    Attributes
    ----------
    leans : (a, 2) work and travel angles in rad
    yaws : (y,) in rad; ``around``: whether the last is beside the first
    tips : (n, a, y, 4, 4) poses of the wire's tip in the frame of the model
    joints : (n, a, y, b, 6), each at its lowest turn within limits, or in (−π, π] where there is none
    reached, within : (n, a, y, b) whether there are joints, and whether they are within limits
    singularity : (n, a, y, b) distances from it
    torch, touched : (n, a, y) clearance in mm up to `CARED_FOR`, and of what
    """

    leans: Array
    yaws: Array
    around: bool
    tips: Array
    joints: Array
    reached: Flags
    within: Flags
    singularity: Array
    torch: Array
    touched: Index


def leans_of(moving: Moving, cell: Cell, torch: Array, positions: Array) -> Array:
    """The leans that are worth a try, (a, 2).

    Of a grid over what the cell allows, those that keep nozzle and neck clear at most of the stations.
    """
    grid = np.array(list(itertools.product(*(sorted({low, 0.5 * low, 0.0, 0.5 * high, high})
                                             for low, high in (cell.work, cell.travel)))))
    tips = tips_at(torch, positions, grid, np.zeros(1)).reshape(-1, 4, 4)
    clear = moving.wire(tips, cell.clearance + 1.0).distances.reshape(len(torch), len(grid)) >= cell.clearance
    often = clear.mean(axis=0)
    return grid[often >= _OFTEN * often.max()] if often.any() else grid[:0]


def yaws_of(cell: Cell) -> tuple[Array, bool]:
    """The yaws to try, and whether they go all around."""
    low, high = cell.yaw
    if high - low >= _TURN - 1e-9:
        return low + _TURN / YAWS * np.arange(YAWS), True
    count = 1 + int(np.ceil((high - low) / (_TURN / YAWS) - 1e-9))
    return np.linspace(low, high, count), False


def tips_at(torch: Array, positions: Array, leans: Array, yaws: Array) -> Array:
    """Poses (n, a, y, 4, 4) of the tip from torch frames (n, 3, 3) and positions (n, 3)."""
    lean = Rotation.from_euler("XY", leans).as_matrix()
    yaw = Rotation.from_euler("z", yaws).as_matrix()
    turned = np.einsum("nij,ajk,ykl->nayil", torch, lean, yaw, optimize=True)
    return motion(turned, np.broadcast_to(positions[:, None, None], turned.shape[:-1]))


def tips_along(course: Course, leans: Array, yaws: Array) -> Array:
    """Poses (n, 4, 4) of the tip at the first n stations, with a lean (n, 2) and a yaw (n,) of its own at each."""
    count = len(yaws)
    lean, yaw = Rotation.from_euler("XY", leans).as_matrix(), Rotation.from_euler("z", yaws).as_matrix()
    return motion(course.torch[:count] @ lean @ yaw, course.positions[:count])


def holds_of(moving: Moving, cell: Cell, torch: Array, positions: Array, leans: Array) -> Holds:
    """All ways of holding the torch along a seam.

    Parameters
    ----------
    torch : (n, 3, 3) the seam's torch frames, x along the travel, in the frame of the model
    positions : (n, 3) in mm
    leans : (a, 2) of `leans_of`
    """
    yaws, around = yaws_of(cell)
    tips = tips_at(torch, positions, leans, yaws)
    shape = tips.shape[:3]
    flat = tips.reshape(-1, 4, 4)
    found = np.concatenate([inverse(moving.arm.family, moving.flange(flat[start : start + _CHUNK]))
                            for start in range(0, len(flat), _CHUNK)])
    reached = ~np.isnan(found[..., 0])
    joints = lowest(found, moving.arm.limits[:, 0])
    within = reached & (joints <= moving.arm.limits[:, 1] + 1e-12).all(axis=-1)
    singularity = np.where(within, distance_to_singularity(moving.arm.family, joints), 0.0)
    # However it is turned about the wire, nozzle and neck are where they are.
    wire = moving.wire(tips[:, :, 0].reshape(-1, 4, 4), CARED_FOR)
    distance, touched = (np.broadcast_to(values.reshape(*shape[:2], 1), shape).copy()
                         for values in (wire.distances, wire.what))
    # Where nothing can be held the body need not be measured.
    worth = (within.any(axis=-1) & (distance.ravel() >= cell.clearance)).nonzero()[0]
    body = moving.body(flat[worth], CARED_FOR)
    nearer = body.distances < distance.ravel()[worth]
    distance.ravel()[worth[nearer]] = body.distances[nearer]
    touched.ravel()[worth[nearer]] = body.what[nearer]
    ways = (*shape, BRANCHES)
    return Holds(leans, yaws, around, tips, joints.reshape(*ways, 6), reached.reshape(ways), within.reshape(ways),
                 singularity.reshape(ways), distance, touched)


def lowest(joints: Array, low: Array) -> Array:
    """The lowest turn of each joint that is not below ``low`` (6,)."""
    result: Array = low - 1e-12 + np.mod(joints - low + 1e-12, _TURN)
    return result


def turns_of(limits: Array) -> list[Turns]:
    """How to choose the turns of joints with more than one turn of room, in the order in which to try it.

    First they go round freely, and the turn is chosen for the whole way at the end. If then one of them leaves its
    limits, those with little room stay within the lowest turn that they have, or the highest.

    Returns
    -------
    lows : (6,) from which angle on joints are counted; ``free``: (6,) which ones go round
    """
    low, high = limits.T
    room = high - low
    little = (room > _TURN + 1e-9) & (room < 1.5 * _TURN)
    found = [(low, room > _TURN + 1e-9)]
    if little.any():
        found += [(low, room >= 1.5 * _TURN), (np.where(little, high - _TURN, low), room >= 1.5 * _TURN)]
    return found
