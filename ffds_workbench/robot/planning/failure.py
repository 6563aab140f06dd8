# SPDX-License-Identifier: LGPL-2.1-or-later
"""Why a seam cannot be welded, said by station and reason."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...registration.arrays import Array
from ..cells import Cell
from ..clearance import Moving
from ..kinematics import BRANCHES, inverse
from .holds import LEAST_SINGULARITY, Flags, Holds

REACH, LIMIT, SINGULARITY, COLLISION, MOTION = "reach", "limit", "singularity", "collision", "motion"
APPROACH, TRANSFER, PROCESS, SEARCH = "approach", "transfer", "process", "search"


@dataclass(frozen=True)
class Failure:
    """Where and why a seam cannot be welded.

    Attributes
    ----------
    station : index from 0 on
    reason : "reach", "limit", "singularity", "collision", "motion" (of the joints from station to station),
        "approach", "transfer", "process" or "search"
    said : in words
    remedy : what would help, in words; None where nothing that was tried does
    """

    station: int
    reason: str
    said: str
    remedy: str | None = None

    def record(self) -> dict[str, Any]:
        """For the report."""
        return dict(vars(self))


def why(moving: Moving, cell: Cell, holds: Holds, arm_clear: Flags, station: int) -> Failure:
    """Why no way gets to a station, from what is told there of all holds.

    Parameters
    ----------
    arm_clear : (n, a, y, b) False where the arm is known to be too near to something
    """
    reached, within = holds.reached[station], holds.within[station]
    sound = within & (holds.singularity[station] >= LEAST_SINGULARITY)
    torch = sound & (holds.torch[station] >= cell.clearance)[..., None]
    at = f"station {station + 1}"
    if not reached.any():
        return Failure(station, REACH, f"{at} is out of reach{_how_far(moving, holds, station)}")
    if not within.any():
        return Failure(station, LIMIT, f"{at} is beyond the limit of {_limit(moving, holds, station)}")
    if not sound.any():
        return Failure(station, SINGULARITY, f"at {at} the arm is singular however the torch is held "
                       f"({holds.singularity[station][within].max():.3f} of {LEAST_SINGULARITY:g})")
    if not torch.any():
        return _torch(moving, cell, holds, sound.any(axis=-1), station)
    if not (torch & arm_clear[station]).any():
        ways = holds.joints[station][torch]
        found = moving.links(ways, cell.clearance)
        best = int(found.distances.argmax())
        return Failure(station, COLLISION, f"at {at} arm against {moving.surroundings.name(int(found.what[best]))} "
                       f"{_by(found.distances[best], cell.clearance)}")
    return Failure(station, MOTION, f"the joints cannot follow to {at}: every hold there is too far from those before, "
                   "or in another configuration")


def _torch(moving: Moving, cell: Cell, holds: Holds, sound: Array, station: int) -> Failure:
    apart = np.where(sound, holds.torch[station], -np.inf)
    best = np.unravel_index(int(apart.argmax()), apart.shape)
    what = moving.surroundings.name(int(holds.touched[station][best]))
    return Failure(station, COLLISION, f"at station {station + 1} torch against {what} "
                   f"{_by(float(apart[best]), cell.clearance)}")


def _by(distance: float, clearance: float) -> str:
    if distance < 0.0:
        return f"by {-distance:.1f} mm"
    return f"at {distance:.1f} mm, where {clearance:g} mm are kept"


def _how_far(moving: Moving, holds: Holds, station: int) -> str:
    """By how many mm the wrist is too far at best, where it is too far and not too near."""
    arm = moving.arm.family
    flange = moving.flange(holds.tips[station].reshape(-1, 4, 4)) @ np.linalg.inv(arm.chain.home)
    wrist = np.einsum("nij,j->ni", flange[:, :3, :3], arm.wrist) + flange[:, :3, 3]
    shoulder = (arm.shoulder - arm.chain.points[0]) @ arm.frame[:, 0]
    off = wrist - arm.chain.points[0]
    out, up = np.linalg.norm(off - (off @ arm.frame[:, 2])[:, None] * arm.frame[:, 2], axis=1), off @ arm.frame[:, 2]
    height = (arm.shoulder - arm.chain.points[0]) @ arm.frame[:, 2]
    beyond = np.hypot(np.maximum(out - abs(shoulder), 0.0), up - height) - sum(arm.lengths)
    if not arm.spherical:
        beyond -= np.linalg.norm(arm.wrist - arm.fourth)
    return f" by {beyond.min():.0f} mm" if beyond.min() > 0.5 else ""


def _limit(moving: Moving, holds: Holds, station: int) -> str:
    """The joint, and by how many degrees, of the hold that is beyond limits by least."""
    flat = holds.tips[station].reshape(-1, 4, 4)
    joints = inverse(moving.arm.family, moving.flange(flat)).reshape(-1, BRANCHES, 6)
    low, high = moving.arm.limits.T
    middle = 0.5 * (low + high)
    near = middle + (np.mod(joints - middle + np.pi, 2.0 * np.pi) - np.pi)
    beyond = np.maximum(np.maximum(low - near, near - high), 0.0)
    worst = np.where(np.isnan(beyond).any(axis=-1), np.inf, beyond.max(axis=-1))
    least = np.unravel_index(int(worst.argmin()), worst.shape)
    joint = int(beyond[least].argmax())
    return f"joint {joint + 1} by {np.degrees(worst[least]):.1f}°"
