# SPDX-License-Identifier: LGPL-2.1-or-later
"""What comes into the programs of a robot's plan: seams with the poses that were found, the tool and the base."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..registration.arrays import Array
from ..seams.programs.angles import kuka_angles
from ..seams.programs.arcs import arcs_of
from ..seams.programs.moves import BEFORE, PlannedMoves, RobotSettings, SeamMoves, moves
from .arms import Arm
from .configurations import configurations
from .job import PlannedSeam, RobotPlan
from .process import search_lines, statements, usual_templates


def planned_moves(robot: RobotPlan, settings: RobotSettings) -> PlannedMoves:
    """The programs' contents.

    Seams come in the order in which the robot welds them; those that it cannot weld are left out unless the settings
    keep them: then they come last, as they were measured.

    Parameters
    ----------
    robot : planned with the same settings
    settings : tool and base that they name count; else those of the cell do
    """
    arm = robot.cell.arm
    settings = replace(settings, tool=_frame(robot.cell.torch.tcp) if settings.tool is None else settings.tool,
                       base=_frame(_model_in_world(robot)) if settings.base is None else settings.base)
    found = [_moves(robot.seams[number], part, robot, settings) for number, part in robot.order]
    failing = [seam for seam in robot.seams if not seam.pieces]
    notes = [seam.line() for seam in robot.seams]
    notes += [f"{seam.seam.name} is not welded from station {first + 1} to {last + 1}: {said}." for seam in robot.seams
              if seam.welding is not None and seam.pieces for first, last, said in seam.welding.refused]
    notes += [f"{seam.seam.name} is less sure than it must be: {len(seam.searches)} touches come before it."
              for seam in robot.seams if seam.searches]
    if failing and settings.keep_failing:
        found += [moves(seam.seam, settings) for seam in failing]
        notes.append(f"The {arm.name} cannot weld them, and they are in the programs all the same: {_names(failing)}.")
    elif failing:
        notes.append(f"The {arm.name} cannot weld them, and therefore they are left out of the programs: "
                     f"{_names(failing)}.")
    notes += [f"Of the {arm.name}: {text}" for text in arm.unsure]
    refusal = (f"The {arm.name} can weld no seam, so no program was written; {'; '.join(s.line() for s in failing)}. "
               "Change the cell, or keep failing seams (--keep-failing)." if failing else
               "No seam is within its limits, so no program was written: look at the report, set other limits, or keep "
               "failing seams (--keep-failing).")
    return PlannedMoves(tuple(found), settings, robot.record(), tuple(notes), refusal)


def _names(seams: list[PlannedSeam]) -> str:
    return ", ".join(seam.seam.name for seam in seams)


def _moves(seam: PlannedSeam, part: int, robot: RobotPlan, settings: RobotSettings) -> SeamMoves:
    piece, arm = seam.pieces[part], robot.cell.arm
    stations = slice(piece.first, piece.last + 1)
    air = np.concatenate([piece.way, piece.approach[None]])
    tips = robot.moving.tips(np.concatenate([air, piece.retract[None]]))
    found = replace(moves(seam.seam, settings), approach=tips[-2], poses=seam.path.tips[stations], retract=tips[-1],
                    way=tips[:-2], joints=controller_joints(arm, air), maker=arm.maker,
                    configurations=configurations(arm, np.concatenate([
                        air, seam.path.joints[stations], piece.retract[None]])))
    breaks: set[int] = set()
    if robot.process is not None and seam.welding is not None:
        welding = seam.welding
        speeds = [welding.rows[row].speed for row in welding.row[piece.first : piece.last].tolist()]
        said = statements(robot.process, welding, piece.first, piece.last)
        breaks = {station for lines in said.values() for station in lines}
        found = replace(found, velocities=np.array(speeds), statements=said)
    if seam.searches and not part:
        found = replace(found, statements=_with_searches(seam, robot, found.statements))
    return replace(found, arcs=arcs_of(found.poses, breaks))


def _with_searches(seam: PlannedSeam, robot: RobotPlan, said: Mapping[str, Mapping[int, Sequence[str]]]
                   ) -> dict[str, dict[int, Sequence[str]]]:
    """The statements, with those of the touches before them."""
    templates = usual_templates() if robot.process is None else robot.process.templates
    return {dialect: {**said.get(dialect, {}), BEFORE: [line for number, search in enumerate(seam.searches, 1)
                                                        for line in search_lines(dialect, lines, number, search)]}
            for dialect, lines in templates.items()}


def controller_joints(arm: Arm, joints: Array) -> Array:
    """Joints (n, 6) in rad as the maker's controller counts them, in degrees."""
    counted = np.degrees(joints)
    if arm.coupled_third_joint:
        counted[:, 2] -= counted[:, 1]
    return counted


def _model_in_world(robot: RobotPlan) -> Array:
    """The model's frame as the controller sees it."""
    pose: Array = np.linalg.inv(robot.cell.base)
    pose[:3, 3] -= robot.cell.arm.controller_origin
    return pose


def _frame(pose: Array) -> tuple[float, ...]:
    """X, Y, Z, A, B, C in mm and degrees."""
    return (*np.round(pose[:3, 3], 4).tolist(), *np.round(kuka_angles(pose[None, :3, :3])[0], 5).tolist())
