# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands ``./ffds seams`` and ``./ffds carry``."""
from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from .inputs import take_negative_numbers
from .terminal import ProgressLine

if TYPE_CHECKING:
    from .. import api

LIMITS = ("lateral", "normal", "longitudinal", "gap", "opening", "rotation")


def add(commands: argparse._SubParsersAction) -> None:
    """Add both commands to the command line's parser."""
    _add_seams(commands)
    _add_carry(commands)


def _add_seams(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("seams", help="weld seams of the as-built model, and the robot's program")
    command.add_argument("model", type=Path, metavar="AS_BUILT", help=".step .stp .iges .igs .brep or .FCStd")
    command.add_argument("--object", metavar="LABEL", help="the object of an .FCStd that holds several")
    compare = command.add_argument_group("what to compare with")
    compare.add_argument("--nominal", type=Path, metavar="MODEL", help="the model that the as-built one was made from")
    compare.add_argument("--bands", type=Path, metavar="REPORT.json", help="the report that register wrote")
    add_options(command)
    command.add_argument("--robot", metavar="NAME|FILE.urdf", help="the robot that welds: whether it can, and how")
    add_robot_options(command)
    command.add_argument("--out", nargs="+", action="extend", type=Path, required=True, metavar="PATH",
                         help=".csv, .src (KUKA), .mod (ABB), .script (Universal Robots), .ls (FANUC), .jbi (Yaskawa), "
                              ".as (Kawasaki), .FCStd (FreeCAD's robots)")
    command.add_argument("--report", type=Path, metavar="OUT.json", help="the figures, as JSON")
    command.add_argument("--picture", type=Path, metavar="OUT.png", help="the seams and their figures along the length")
    command.set_defaults(run=seams)


def add_options(command: argparse.ArgumentParser) -> None:
    """Add what says which seams, how to weld them, what passes, and for which tool and base."""
    take_negative_numbers(command)
    which = command.add_argument_group("which seams")
    which.add_argument("--edge", nargs="+", action="extend", default=[], metavar="EdgeN",
                       help="edges, joined where they continue tangentially; with --auto, only the joints along them")
    which.add_argument("--auto", type=float, metavar="TOL", help="find the joints of parts that touch within TOL mm")
    which.add_argument("--chain", action="store_true",
                       help="add the edges that continue the named ones tangentially")
    which.add_argument("--start", type=_numbers(3), metavar="X,Y,Z",
                       help="where a closed seam starts, or the end to start at")
    which.add_argument("--reverse", action="store_true", help="weld in the other direction")
    which.add_argument("--limit", nargs="+", action="extend", default=[], type=_limit, metavar="NAME=VALUE",
                       help=f"what passes: {', '.join(LIMITS)}, in mm and degrees (default: 1, 1, 2, 0.5, 5, 5)")
    torch = command.add_argument_group("stations and torch")
    torch.add_argument("--step", type=float, default=5.0, metavar="MM",
                       help="largest distance of stations (default: 5)")
    torch.add_argument("--chord", type=float, default=0.05, metavar="MM",
                       help="largest distance of the seam from the straight line between stations (default: 0.05)")
    torch.add_argument("--work-angle", type=float, default=0.0, metavar="DEG", help="lean about the travel direction")
    torch.add_argument("--travel-angle", type=float, default=0.0, metavar="DEG",
                       help="lean forwards (push) or back (drag)")
    robot = command.add_argument_group("robot")
    robot.add_argument("--tool", metavar="TOOL",
                       help="its number (KUKA), its name (ABB), or X,Y,Z,A,B,C in mm and degrees")
    robot.add_argument("--base", metavar="BASE", help="where the model stands, given like the tool")
    robot.add_argument("--velocity", type=float, default=10.0, metavar="MM/S", help="along the seam (default: 10)")
    robot.add_argument("--approach", type=float, default=50.0, metavar="MM",
                       help="distance to approach from and retract to (default: 50)")
    robot.add_argument("--keep-failing", action="store_true",
                       help="write programs for seams beyond their limits as well (default: leave them out)")


def add_robot_options(command: argparse.ArgumentParser) -> None:
    """Add what tells of the robot's cell."""
    command.add_argument("--cell", type=Path, metavar="CELL.json",
                         help="where the robot stands, its torch and what is around (default: behind the part, free)")
    command.add_argument("--process", type=Path, metavar="PROCESS.json",
                         help="speeds, jobs and weaves by joint and gap, for a robot")
    command.add_argument("--searches", choices=("auto", "none"), default="auto",
                         help="touch the seams that are less sure than the process allows, or none (default: auto)")


def robot_cell(robot: str | None, options: argparse.Namespace) -> api.Cell | None:
    """The cell that the options tell of; None where no robot is named."""
    from .. import api

    if robot is None and options.cell is None:
        if options.process is not None:
            raise InputError("A process needs a robot: name it with --robot, or in the cell.")
        return None
    return api.read_cell(robot, options.cell)


def _add_carry(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("carry", help="transfer a path taught on the nominal model to the as-built one")
    command.add_argument("nominal", type=Path, metavar="NOMINAL", help="the model that the path was taught on")
    command.add_argument("as_built", type=Path, metavar="AS_BUILT", help="the model that register made of it")
    command.add_argument("path", type=Path, metavar="PATH",
                         help=".csv, or .src with its .dat, in the frame of the model")
    command.add_argument("--out", type=Path, required=True, metavar="NEW_PATH", help="in the format of PATH")
    command.set_defaults(run=carry)


def _numbers(count: int) -> Callable[[str], tuple[float, ...]]:
    def read(text: str) -> tuple[float, ...]:
        try:
            values = tuple(float(part) for part in text.split(","))
        except ValueError:
            values = ()
        if len(values) != count or not all(map(math.isfinite, values)):
            raise argparse.ArgumentTypeError(f"'{text}' is not {count} numbers parted by commas")
        return values

    return read


def _limit(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if name not in LIMITS or not number >= 0.0:
        raise argparse.ArgumentTypeError(f"'{text}' is no limit: write NAME=VALUE with one of {', '.join(LIMITS)}")
    return name, number


def seams(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds seams``: the table to print."""
    from .. import api

    inputs = [path for path in (options.model, options.nominal, options.bands, options.cell, options.process)
              if path is not None]
    api.check_seam_outputs(options.out, (options.report, options.picture), inputs)
    robot, settings, limits = read_options(options)
    cell = robot_cell(options.robot, options)
    progress(f"Reading {options.model}")
    as_built = api.read_model(options.model, options.object)
    nominal = None
    if options.nominal is not None:
        progress(f"Reading {options.nominal}")
        nominal = api.read_model(options.nominal)
    progress("Finding and measuring the seams")
    plan = api.plan_seams(as_built, options.edge, options.auto, nominal, options.chain, options.bands, settings, limits)
    planned = None if cell is None else api.plan_robot(plan, cell, robot, options.bands, options.process,
                                                       options.searches == "auto", progress)[1]
    progress(f"Writing {options.out[0]}")
    notes = [*plan.notes, *api.write_seams(plan, options.out, robot, options.report, options.picture, inputs, planned)]
    return "\n\n".join([plan.table(), *(["\n".join(f"Note: {note}" for note in notes)] if notes else []),
                        _written(options)])


def read_options(options: argparse.Namespace) -> tuple[api.RobotSettings, api.SeamSettings, api.SeamLimits]:
    """The settings that `add_options` asks for; InputError where they make no sense."""
    from .. import api

    tool, base = (None if text is None else api.read_frame_choice(text) for text in (options.tool, options.base))
    settings = api.SeamSettings(step=options.step, chord=options.chord, work_angle=math.radians(options.work_angle),
                                travel_angle=math.radians(options.travel_angle), start=options.start,
                                reverse=options.reverse)
    return (api.RobotSettings(tool, base, options.velocity, options.approach, options.keep_failing), settings,
            api.SeamLimits(**dict(options.limit)))


def _written(options: argparse.Namespace) -> str:
    paths = [*options.out, *(path for path in (options.report, options.picture) if path is not None)]
    return "Written: " + ", ".join(f"{path} (and .dat)" if path.suffix.lower() == ".src" else str(path)
                                   for path in paths)


def carry(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds carry``: what was moved, in words."""
    from .. import api

    if not options.path.is_file():
        raise InputError(f"The path {options.path} does not exist.")
    progress(f"Reading {options.nominal}")
    nominal = api.read_model(options.nominal)
    progress(f"Reading {options.as_built}")
    as_built = api.read_model(options.as_built)
    progress("Carrying the path along")
    result = api.carry(nominal, as_built, options.path, options.out, (options.nominal, options.as_built))
    return f"{result.table()}\n\nWritten: {options.out}"
