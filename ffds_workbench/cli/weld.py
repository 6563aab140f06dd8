# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``./ffds weld``: from a scan to the robot's program, with one page that shows each step."""
from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from ..output import replacing
from ..report.page import Step, page
from . import seams as seam_options
from .inputs import add_inputs, add_registration, read_inputs, read_request
from .outputs import make_folder
from .terminal import Progress

if TYPE_CHECKING:
    from .. import api

DIALECTS = {"kuka": "seams.src", "abb": "seams.mod", "ur": "seams.script"}
"""Those that are written where nothing is said."""
MORE_DIALECTS = {"fanuc": "seams.ls", "yaskawa": "seams.jbi", "kawasaki": "seams.as"}
ALL_DIALECTS = DIALECTS | MORE_DIALECTS
"""Those that are written for a robot, in which its cell gives tool and base."""
PAGE = "report.html"


@dataclass(frozen=True)
class Wanted:
    """Which seams to weld, and how.

    Attributes
    ----------
    edges, auto, chain : as for ``api.plan_seams``
    robot, settings, limits : for the programs, the stations and the verdict
    dialects : of `ALL_DIALECTS`
    cell : the robot that welds, where it stands; None: none is known
    process, searching : its process, and whether touches are planned
    """

    edges: Sequence[str]
    auto: float | None
    chain: bool
    robot: api.RobotSettings
    settings: api.SeamSettings
    limits: api.SeamLimits
    dialects: Sequence[str] = tuple(DIALECTS)
    cell: api.Cell | None = None
    process: Path | None = None
    searching: bool = True


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line's parser."""
    command = commands.add_parser("weld",
                                  help="all in one: scan, as-built model, seams, robot programs, and a page about it")
    add_inputs(command)
    add_registration(command)
    seam_options.add_options(command)
    command.add_argument("--robot", nargs="+", default=[], metavar="NAME|FILE.urdf",
                         help=f"the robot that welds, and in which dialects: {', '.join(ALL_DIALECTS)} (default: "
                              "the first three, all for a robot)")
    seam_options.add_robot_options(command)
    command.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for all that comes of it")
    command.set_defaults(run=weld)


def weld(options: argparse.Namespace, progress: Progress) -> str:
    """``ffds weld``: the tables to print."""
    from .. import api

    if not options.edge and options.auto is None:
        raise InputError("No seam was named: give --edge, or --auto with the distance within which parts count as "
                         "touching.")
    robot, settings, limits = seam_options.read_options(options)
    request = read_request(options)
    name, dialects = read_robot(options.robot)
    cell = seam_options.robot_cell(name, options)
    folder = make_folder(options.out)
    wanted = Wanted(options.edge, options.auto, options.chain, robot, settings, limits, dialects, cell,
                    options.process, options.searches == "auto")
    model, scan = read_inputs(options, progress)
    as_built = "as_built.step" if api.step_keeps_numbers(model) else "as_built.FCStd"
    result = api.run(request, model, scan, progress)
    inputs = [options.model, *options.scan, *(path for path in (options.cell, options.process) if path)]
    text = write_chain(result, wanted, folder, as_built, inputs, progress)
    return f"{text}\n\nWritten: {folder / PAGE} and what it shows"


def read_robot(words: Sequence[str]) -> tuple[str | None, list[str]]:
    """The robot's name, None where there is none, and the dialects that are named, or those that are usual."""
    dialects = [word for word in words if word in ALL_DIALECTS]
    name = " ".join(word for word in words if word not in ALL_DIALECTS)
    return name or None, dialects or list(ALL_DIALECTS if name else DIALECTS)


def write_chain(result: api.Result, wanted: Wanted, folder: Path, as_built: str, inputs: Sequence[Path],
                progress: Progress) -> str:
    """Write an as-built model, its report and picture, and find, measure and write its seams; the tables to print."""
    from .. import api

    report, picture = folder / "report.json", folder / "deviation.png"
    progress(f"Writing {folder / as_built}")
    api.write(result, folder / as_built, report, picture, inputs)
    progress("Finding and measuring the seams")
    plan = api.plan_seams(result.model, wanted.edges, wanted.auto, result.nominal, wanted.chain, report,
                          wanted.settings, wanted.limits)
    planned = None if wanted.cell is None else api.plan_robot(
        plan, wanted.cell, wanted.robot, report, wanted.process, wanted.searching, progress)[1]
    weldable = bool(api.programmed_seams(plan, wanted.robot) if planned is None else planned.seams)
    programs = [*(ALL_DIALECTS[dialect] for dialect in wanted.dialects), "seams.FCStd"] if weldable else []
    outs = [folder / name for name in ("seams.csv", *programs)]
    written = api.write_seams(plan, outs, wanted.robot, folder / "seams.json", folder / "seams.png", inputs,
                              planned)
    notes = [*plan.notes, *written]
    seams = "\n".join([plan.table(), *(f"Note: {note}" for note in notes)])
    if DIALECTS["kuka"] in programs:
        programs.insert(-1, "seams.dat")
    steps = [
        *([] if result.aligned is None else [Step(
            "Alignment", "The scan brought onto the model by a rigid motion.", result.aligned.table())]),
        Step("Scan", "What the scanner saw, in the model's coordinates.", _about_scan(result.scan)),
        Step("As-built model", "The nominal model deformed to the scan, with its topology unchanged.",
             result.deviation_table(), picture.name, [as_built, report.name]),
        Step("Weld seams", "Where the torch has to go, against the nominal model: largest offsets, gaps and turns.",
             seams, "seams.png", ["seams.csv", "seams.json"]),
        Step("Robot programs", "The same poses in each dialect, in the frame of the model.",
             _about_robot(wanted.robot if planned is None else planned.settings), None, programs)]
    with replacing(folder / PAGE) as (temporary,):
        temporary.write_text(page(result.nominal.label, "From the scan to the robot's program.", steps), "utf-8")
    return "\n\n".join([result.table(), seams])


def _about_scan(scan: api.PointCloud) -> str:
    low, high = scan.points.min(axis=0), scan.points.max(axis=0)
    size = " × ".join(f"{length:.1f}" for length in high - low)
    return f"{len(scan.points)} points over {size} mm" + (f", {scan.dropped} dropped" if scan.dropped else "")


def _about_robot(robot: api.RobotSettings) -> str:
    return (f"{robot.velocity:g} mm/s along the seams; approach and retract over {robot.approach:g} mm; "
            f"tool {robot.tool if robot.tool is not None else 'of the controller'}; "
            f"base {robot.base if robot.base is not None else 'of the robot'}")
