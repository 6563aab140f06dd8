# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``./ffds compensate``."""
from __future__ import annotations

import argparse
from pathlib import Path

from ...registration.request import ALIGN, ISOMETRY
from ...scan.units import MILLIMETRES
from ..inputs import take_negative_numbers
from ..outputs import read_back, written
from ..terminal import ProgressLine


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line."""
    command = commands.add_parser("compensate", help="the model of the tool whose parts come out as the nominal model")
    take_negative_numbers(command)
    command.add_argument("model", type=Path, metavar="NOMINAL", help=".step .stp .iges .igs .brep or .FCStd")
    command.add_argument("scan", type=Path, nargs="+", metavar="SCAN",
                         help="one scan of each part: .ply .pcd .xyz .asc .txt .csv .pts .e57 .stl .las .laz or .obj")
    command.add_argument("--object", metavar="LABEL", help="the object of an .FCStd that holds several")
    command.add_argument("--scan-unit", choices=list(MILLIMETRES), default="mm", help="unit of the scans (default: mm)")
    command.add_argument("--align", choices=ALIGN, default="none", help="bring each scan onto the model first "
                                                                       "(default: none)")
    command.add_argument("--factor", type=float, default=-1.0, metavar="F",
                         help="of the parts' mean deviation (default: -1, which turns it round)")
    command.add_argument("--previous", type=Path, metavar="TOOL",
                         help="the tool that the parts came out of (default: the nominal model)")
    command.add_argument("--previous-scan", type=Path, nargs="+", action="extend", default=[], metavar="SCAN",
                         help="of the parts of one more trial; of the two trials the one nearer to the nominal model "
                              "is taken as what came out of TOOL")
    command.add_argument("--fixed", "--freeze", nargs="+", action="extend", default=[], metavar="FaceN",
                         help="faces that must not move")
    command.add_argument("--isometry", choices=ISOMETRY, default="auto",
                         help="whether a sheet part keeps its lengths (default: decided from the scan)")
    command.add_argument("--out", type=Path, required=True, metavar="TOOL", help="the tool: .step, .brep or .FCStd")
    command.add_argument("--report", type=Path, metavar="OUT.json", help="the figures, as JSON")
    command.set_defaults(run=run)


def run(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds compensate``: the table to print."""
    from ... import api

    inputs = [path for path in (options.model, *options.scan, options.previous, *options.previous_scan) if path]
    api.check_outputs((options.out, options.report), inputs)
    api.check_model_output(options.out)
    scans, earlier = ([api.read_scan(path, options.scan_unit) for path in paths]
                      for paths in (options.scan, options.previous_scan))
    progress(f"Reading {options.model}")
    model = api.read_model(options.model, options.object)
    api.check_model_output(options.out, model)
    result = api.compensate(model, scans, options.factor, options.previous, earlier, progress, freeze=options.fixed,
                            isometry=options.isometry, align=options.align)
    progress(f"Writing {options.out}")
    certificate = api.write_deformed(result, options.out, options.report, inputs)
    return "\n\n".join([result.table(), read_back(certificate), written(options.out, options.report)])
