# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds prepare``: its options and what it prints."""
from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from ..errors import InputError
from ..scan.units import MILLIMETRES
from .inputs import take_negative_numbers
from .outputs import written
from .terminal import Progress


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line."""
    command = commands.add_parser("prepare", help="clean a scan: crop it, remove the table, clutter and outliers, "
                                                         "thin it",
                                  epilog="The steps are done in the order in which they are listed.")
    command.add_argument("scan", type=Path, nargs="+", metavar="SCAN", help="one, or several of one part")
    command.add_argument("--out", type=Path, required=True, metavar="CLEAN.ply", help="the prepared scan, in mm")
    command.add_argument("--report", type=Path, metavar="OUT.json", help="each step, with its points before and after")
    command.add_argument("--scan-unit", choices=list(MILLIMETRES), default="mm", help="unit of the scan (default: mm)")
    command.add_argument("--poses", type=Path, metavar="POSES.json",
                         help="where several scans belong: a list of (4, 4) matrices in mm, one per scan; refined")
    command.add_argument("--box", type=_numbers(6), metavar="X0,Y0,Z0,X1,Y1,Z1", help="keep what is inside, mm")
    command.add_argument("--near", nargs=2, metavar=("MODEL", "MM"), help="keep only points this near to the model")
    command.add_argument("--object", metavar="LABEL", help="the object of an .FCStd that holds several")
    command.add_argument("--remove-plane", action="store_true", help="remove the table and what is behind it")
    command.add_argument("--remove-clutter", action="store_true", help="remove what stands apart from the part")
    command.add_argument("--remove-outliers", action="store_true", help="take single points away")
    command.add_argument("--normals", action="store_true", help="estimate normals, towards the sensor")
    command.add_argument("--view", type=_numbers(3), metavar="X,Y,Z",
                         help="where the sensor was, mm (default: at the origin of each scan's own coordinates)")
    command.add_argument("--spacing", type=float, metavar="MM", help="average the points in cubes of this edge")
    take_negative_numbers(command)
    command.set_defaults(run=run)


def run(options: argparse.Namespace, progress: Progress) -> str:
    """``ffds prepare``: the steps to print."""
    from .. import api

    near, model_file = _near(options.near)
    inputs = [*options.scan, *([] if model_file is None else [model_file])]
    api.check_outputs((options.out, options.report), inputs)
    if options.out.suffix.lower() != ".ply":
        raise InputError(f"A prepared scan is written as .ply, not as '{options.out.suffix}'.")
    poses = None if options.poses is None else api.read_poses(options.poses)
    scans = []
    for path in options.scan:
        progress(f"Reading {path}")
        scans.append(api.read_scan(path, options.scan_unit))
    model = None if model_file is None else api.read_model(model_file, options.object)
    prepared = api.prepare(
        scans, model, progress, poses=poses, box=options.box, near=near, remove_plane=options.remove_plane,
        remove_clutter=options.remove_clutter, remove_outliers=options.remove_outliers, normals=options.normals,
        view=options.view, spacing=options.spacing)
    api.write_prepared(prepared, options.out, options.report, inputs)
    return f"{prepared.table()}\n\n{written(options.out, options.report)}"


def _near(words: list[str] | None) -> tuple[float | None, Path | None]:
    """The distance and the model of ``--near``."""
    if words is None:
        return None, None
    try:
        return float(words[1]), Path(words[0])
    except ValueError as error:
        raise InputError(f"--near takes a model and a distance in mm, not '{words[1]}'.") from error


def _numbers(count: int) -> Callable[[str], tuple[float, ...]]:
    def read(text: str) -> tuple[float, ...]:
        try:
            values = tuple(map(float, text.split(",")))
        except ValueError:
            values = ()
        if len(values) != count:
            raise argparse.ArgumentTypeError(f"'{text}' is not {count} numbers with commas between them")
        return values

    return read
