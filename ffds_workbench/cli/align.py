# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds align``: its options and what it prints."""
from __future__ import annotations

import argparse
from pathlib import Path

from ..errors import InputError
from ..scan.units import MILLIMETRES
from .terminal import ProgressLine


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line."""
    command = commands.add_parser("align", help="bring the scan onto the model by a rigid motion")
    command.add_argument("model", type=Path, metavar="MODEL", help=".step .stp .iges .igs .brep or .FCStd")
    command.add_argument("scan", type=Path, nargs="+", metavar="SCAN",
                         help=".ply .pcd .xyz .asc .txt .csv .pts .e57 .stl .las .laz or .obj; several of one part are "
                              "fused")
    command.add_argument("--object", metavar="LABEL", help="the object of an .FCStd that holds several")
    command.add_argument("--scan-unit", choices=list(MILLIMETRES), default="mm",
                         help="unit of the scan (default: mm; one that is off is recognised)")
    command.add_argument("--out", type=Path, required=True, metavar="ALIGNED.ply", help="the aligned scan, in mm")
    command.add_argument("--pose", type=Path, metavar="POSE.json", help="the pose, its verdict and its rivals")
    command.add_argument("--mode", choices=["fine", "global"], default="global",
                         help="fine: from where the scan lies; global: from anywhere (default)")
    command.set_defaults(run=run)


def run(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds align``: the verdict to print."""
    from .. import api

    inputs = [options.model, *options.scan]
    api.check_outputs((options.out, options.pose), inputs)
    if options.out.suffix.lower() != ".ply":
        raise InputError(f"An aligned scan is written as .ply, not as '{options.out.suffix}'.")
    progress(f"Reading {', '.join(str(path) for path in options.scan)}")
    scan = api.read_scan(options.scan, options.scan_unit)
    progress(f"Reading {options.model}")
    model = api.read_model(options.model, options.object)
    aligned = api.align_scan(model, scan, options.mode, progress)
    api.write_alignment(aligned, options.out, options.pose, inputs)
    names = ", ".join(str(path) for path in (options.out, options.pose) if path is not None)
    return f"{aligned.table()}\n\nWritten: {names}"
