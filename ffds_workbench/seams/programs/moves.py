# SPDX-License-Identifier: LGPL-2.1-or-later
"""The moves that weld a seam, independent of any dialect: down to it, along it, and away."""
from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from ...registration.motions import motion
from ..measured import MeasuredSeam

FrameChoice = int | str | tuple[float, ...] | None
"""A tool or a base: its number or name on the controller, or X, Y, Z, A, B, C in mm and degrees; None: the default."""

AIR_VELOCITY = 100.0
"""Speed of approach and retract in mm/s."""
BEFORE = -1
"""The station of statements that come before the robot goes down to the seam."""
_LARGEST_BLEND = 1.0


@dataclass(frozen=True)
class RobotSettings:
    """What the programs need besides the poses.

    Attributes
    ----------
    tool, base : see `FrameChoice`; ``base`` is where the model's frame stands for the robot
    velocity : along the seam in mm/s
    approach : distance in mm from which the torch comes down to the seam's start, and to which it leaves the end
    keep_failing : seams beyond their limits are in the programs as well
    """

    tool: FrameChoice = None
    base: FrameChoice = None
    velocity: float = 10.0
    approach: float = 50.0
    keep_failing: bool = False

    def __post_init__(self) -> None:
        if not 0.01 <= self.velocity <= 2000.0:
            raise InputError(f"The velocity must lie between 0.01 and 2000 mm/s, not {self.velocity:g}.")
        if not 0.0 <= self.approach <= 2000.0:
            raise InputError(f"The approach must lie between 0 and 2000 mm, not {self.approach:g}.")


def read_frame_choice(text: str) -> FrameChoice:
    """A tool or a base as a user writes it.

    Parameters
    ----------
    text : a number as "3", a name as "tWeldGun", or "X,Y,Z,A,B,C" in mm and degrees

    Raises
    ------
    InputError : it is none of these
    """
    if text.isdecimal():
        return int(text)
    if re.fullmatch(r"[A-Za-z_]\w{0,31}", text, re.ASCII):
        return text
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    if len(values) != 6 or not all(map(math.isfinite, values)):
        raise InputError(f"'{text}' is no tool or base: give a number, a name, or X,Y,Z,A,B,C in mm and degrees.")
    return values


@dataclass(frozen=True)
class SeamMoves:
    """One seam.

    Attributes
    ----------
    name : the seam's; ``title``: with more about it, for comments
    approach, retract : (4, 4) poses before the first and after the last station
    poses : (n, 4, 4) torch frames at the stations
    blend : radius in mm within which the robot may round the stations between the first and the last
    way : (k, 4, 4) poses through the air to the approach
    joints : (k + 1, 6) in degrees, as ``maker``'s controller counts them: of the way and the approach; None: unknown
    arcs : stations (start, middle, end) between which the poses lie on a circle
    configurations : (k + n + 2,) of the arm, as ``maker``'s controller writes them; empty where it writes none
    velocities : (n − 1,) in mm/s, to each station from the one before; None: the settings' throughout
    statements : of the process, by dialect and station: what is written when that station is reached
    """

    name: str
    title: str
    approach: Array
    poses: Array
    retract: Array
    blend: float
    way: Array = field(default_factory=lambda: np.empty((0, 4, 4)))
    joints: Array | None = None
    maker: str = ""
    arcs: tuple[tuple[int, int, int], ...] = ()
    configurations: tuple[str, ...] = ()
    velocities: Array | None = None
    statements: Mapping[str, Mapping[int, Sequence[str]]] = field(default_factory=dict)

    @property
    def whole_way(self) -> Array:
        """(k + n + 2, 4, 4), with the way through the air."""
        return np.concatenate([self.way, self.all_poses])

    def joints_for(self, maker: str) -> Array | None:
        """The joints for a maker's controller; None where they are another's or unknown."""
        return self.joints if maker == self.maker else None

    def lines_at(self, station: int, dialect: str, form: str = "{}") -> list[str]:
        """The process's statements at a station, each put into ``form``."""
        return [form.format(line) for line in self.statements.get(dialect, {}).get(station, ())]

    def velocity_to(self, station: int, settings: RobotSettings) -> float:
        """In mm/s."""
        return settings.velocity if self.velocities is None else float(self.velocities[station - 1])

    @property
    def sections(self) -> Iterator[tuple[int, int | None]]:
        """How the first to the last station are passed: to which one, and by which on a circle (None: straight)."""
        arcs = {start: (middle, end) for start, middle, end in self.arcs}
        station = 0
        while station < len(self.poses) - 1:
            middle, station = arcs.get(station, (None, station + 1))
            yield station, middle

    @property
    def all_poses(self) -> Array:
        """(n + 2, 4, 4), in the order in which the robot passes them."""
        return np.concatenate([self.approach[None], self.poses, self.retract[None]])


@dataclass(frozen=True)
class PlannedMoves:
    """What a robot makes of seams.

    Attributes
    ----------
    seams : those that are in the programs, in the order in which they are welded
    settings : with its tool and base
    record : the report's ``robot``
    notes : what the user must know of the programs
    refusal : why there is no program, where there is none
    """

    seams: tuple[SeamMoves, ...]
    settings: RobotSettings
    record: Mapping[str, Any]
    notes: tuple[str, ...]
    refusal: str


def moves(seam: MeasuredSeam, settings: RobotSettings) -> SeamMoves:
    """The moves along a seam."""
    stations = seam.stations
    poses = motion(stations.torch, stations.positions)
    spacing = float(np.linalg.norm(np.diff(stations.positions, axis=0), axis=1).min())
    title = f"{seam.name} ({stations.seam.kind}), {stations.length:.1f} mm"
    return SeamMoves(seam.name, title, _above(poses[0], settings.approach), poses,
                     _above(poses[-1], settings.approach), min(_LARGEST_BLEND, 0.25 * spacing))


def _above(pose: Array, distance: float) -> Array:
    """The pose, moved back against its approach direction."""
    moved = pose.copy()
    moved[:3, 3] -= distance * pose[:3, 2]
    return moved


def table_numbers(maker: str, settings: RobotSettings) -> tuple[int, int]:
    """The numbers of base and tool in a controller's tables: the given ones, or 1 where a pose must be put there.

    Raises
    ------
    InputError : one of them is a name
    """
    return _table_number(maker, "base", settings.base), _table_number(maker, "tool", settings.tool)


def _table_number(maker: str, what: str, choice: FrameChoice) -> int:
    if isinstance(choice, str):
        raise InputError(f"{maker} controllers number their {what}s: give a number or X,Y,Z,A,B,C instead of "
                         f"'{choice}'.")
    return choice if isinstance(choice, int) else 1


def program_name(stem: str, limit: int) -> str:
    """A name that every controller takes, from that of the file."""
    name = re.sub(r"\W", "_", stem, flags=re.ASCII)
    return (name if name[:1].isalpha() else "s" + name)[:limit]


def plain(text: str) -> str:
    """Text for a comment: ASCII, one line."""
    return " ".join(text.encode("ascii", "replace").decode().split())


def numbers(values: Sequence[float] | Array, digits: int) -> list[str]:
    """Numbers of fixed digits, without a minus zero."""
    return [f"{round(value, digits) + 0.0:.{digits}f}" for value in map(float, values)]
