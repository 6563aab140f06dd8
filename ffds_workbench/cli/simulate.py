# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds simulate``: its options and what it prints."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from .inputs import direction, number, take_negative_numbers
from .outputs import written
from .terminal import ProgressLine

if TYPE_CHECKING:
    from ..scan.sensor import SensorSettings


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line."""
    command = commands.add_parser("simulate", help="scan a model with the virtual sensor")
    command.add_argument("model", type=Path, metavar="MODEL", help=".step .stp .iges .igs .brep or .FCStd")
    command.add_argument("--object", metavar="LABEL", help="the object of an .FCStd that holds several")
    command.add_argument("--out", type=Path, required=True, metavar="SCAN.ply", help="the scan, in mm")
    command.add_argument("--truth", type=Path, metavar="OUT.npz", help="the ground truth, as arrays")
    command.add_argument("--spacing", type=number, default=0.2, metavar="MM",
                         help="mean distance of the points (default: 0.2)")
    command.add_argument("--noise", type=number, default=0.13, metavar="MM",
                         help="standard deviation along the line of sight (default: 0.13)")
    command.add_argument("--correlation", type=number, default=0.0, metavar="MM",
                         help="filter width that correlates the noise (default: white noise)")
    command.add_argument("--view", nargs="+", action="extend", default=[], type=direction, metavar="X,Y,Z",
                         help="direction from the part to the camera; several shots are fused (default: no camera, the "
                              "whole surface is seen)")
    command.add_argument("--outliers", type=number, default=0.0, metavar="SHARE", help="gross outliers, 0 to 1")
    command.add_argument("--dropout", type=number, default=0.0, metavar="SHARE",
                         help="share of the points lost beside edges, 0 to 1")
    command.add_argument("--holes", type=int, default=0, metavar="N", help="round gaps of 3 to 7 mm radius")
    command.add_argument("--table", type=number, metavar="MM", help="a flat background this far behind the part")
    command.add_argument("--pose-error", type=_numbers, default=(0.0,), metavar="MM[,RAD]",
                         help="how badly the shots fit together: shift, and rotation, per axis")
    command.add_argument("--seed", type=int, default=0, metavar="N", help="the same seed gives the same scan")
    take_negative_numbers(command)
    command.set_defaults(run=run)


def settings(options: argparse.Namespace) -> SensorSettings:
    """The sensor that the options describe."""
    from ..scan.sensor import SensorSettings, View

    shift, angle = (*options.pose_error, 0.0)[:2]
    if options.seed < 0:
        raise InputError(f"A seed is not negative, as {options.seed} is.")
    return SensorSettings(spacing=options.spacing, noise=options.noise, correlation=options.correlation,
                          views=tuple(View(towards) for towards in options.view), outliers=options.outliers,
                          edge_dropout=options.dropout, holes=options.holes, table=options.table,
                          pose_error=shift, pose_error_angle=angle,
                          seed=options.seed)


def run(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds simulate``: the line to print."""
    sensor = settings(options)
    from .. import api

    api.check_outputs((options.out, options.truth), [options.model])
    if options.out.suffix.lower() != ".ply":
        raise InputError(f"A simulated scan is written as .ply, not as '{options.out.suffix}'.")
    progress(f"Reading {options.model}")
    model = api.read_model(options.model, options.object)
    progress("Scanning")
    result = api.simulate(model, sensor)
    api.write_simulation(result, options.out, options.truth, [options.model])
    shots = f" from {len(sensor.views)} views" if sensor.views else ""
    return f"{len(result.scan.points)} points{shots}\n\n{written(options.out, options.truth)}"


def _numbers(text: str) -> tuple[float, ...]:
    values = tuple(number(part) for part in text.split(","))
    if len(values) > 2:
        raise argparse.ArgumentTypeError(f"'{text}' is more than a shift in mm and a rotation in rad")
    return values
