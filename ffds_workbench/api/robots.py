# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams for a robot in its cell: whether it can weld them, and how."""
from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..robot.cells import Cell
from ..robot.cells import read_cell as _read_cell
from ..robot.job import Progress, RobotPlan
from ..robot.job import plan_robot as _plan_robot
from ..robot.process import read_process
from ..robot.programs import planned_moves
from ..seams.plan import SeamPlan
from ..seams.programs.moves import PlannedMoves, RobotSettings


def read_cell(robot: str | Path | None = None, path: str | Path | None = None) -> Cell:
    """The cell that a robot stands in.

    Parameters
    ----------
    robot : its name, as "UR10e" or "KR 8 R1440-2", or a URDF file; None: the cell names it
    path : of ``cell.json``; without one the robot stands 0.6 of its reach behind the model, with nothing around

    Raises
    ------
    InputError : there is no such robot, or the file makes no sense
    """
    return _read_cell(None if path is None else Path(path), robot)


def plan_robot(plan: SeamPlan, cell: Cell, settings: RobotSettings | None = None,
               bands: str | Path | Mapping[str, Any] | None = None, process: str | Path | None = None,
               searching: bool = True, progress: Progress = lambda text: None) -> tuple[RobotPlan, PlannedMoves]:
    """What a robot makes of the seams of a plan, and what of it comes into programs (for `write_seams`).

    Parameters
    ----------
    plan : of `plan_seams`
    cell : of `read_cell`
    settings : velocity, approach, and which seams are kept
    bands : the registration's report or its JSON file: the part is taken to stand out by its bands
    process : the file of speeds, jobs and weaves by joint and gap
    searching : plan touches where a seam's band is wider than the process allows
    progress : told what is being done
    """
    settings = settings or RobotSettings()
    found = _plan_robot(plan, cell, settings, bands, None if process is None else read_process(Path(process)),
                        searching, progress)
    return found, planned_moves(found, settings)
