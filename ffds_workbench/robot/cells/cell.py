# SPDX-License-Identifier: LGPL-2.1-or-later
"""A cell: the robot where it stands, its torch, what is around, and how freely the torch may be held."""
from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...registration.arrays import Array
from ..arms import Arm
from ..clearance import Solid, Facets
from .torch import Torch

FREE = (-math.pi, math.pi)


@dataclass(frozen=True)
class Cell:
    """See `read_cell` for the file. The defaults (unit) are assumptions for a cell of which nothing is known.

    Attributes
    ----------
    arm : the robot
    base : (4, 4) pose of its base in the frame of the model
    torch : on its flange
    solids : names, and boxes and cylinders in the frame of the model; ``meshes``: names, and triangles
    clearance : the least distance in mm that torch and arm keep from everything
    yaw : from and to in rad: how the torch may be turned about its wire, 0 having its x along the travel
    work, travel : from and to in rad: by how much the torch may lean more than the seam's settings say
    home : (6,) joints in rad where the robot comes from and goes to; None: it starts over the first seam
    """

    arm: Arm
    base: Array
    torch: Torch = field(default_factory=Torch)
    solids: tuple[tuple[str, Solid], ...] = ()
    meshes: tuple[tuple[str, Facets], ...] = ()
    clearance: float = 1.0
    yaw: tuple[float, float] = FREE
    work: tuple[float, float] = (-math.radians(20.0), math.radians(20.0))
    travel: tuple[float, float] = (-math.radians(15.0), math.radians(15.0))
    home: Array | None = None


def default_base(arm: Arm) -> Array:
    """Where a robot stands that no cell tells of: 0.6 of its reach behind the model's origin, upright
    (unit: well within it)."""
    pose = np.eye(4)
    pose[0, 3] = -0.6 * arm.reach
    return pose
