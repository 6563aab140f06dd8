# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds align``: its options and what it prints."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from ..scan.units import MILLIMETRES
from .outputs import written
from .terminal import ProgressLine

if TYPE_CHECKING:
    from .. import api


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
    which = command.add_mutually_exclusive_group()
    which.add_argument("--datum", nargs="+", metavar="FaceN",
                       help="datum faces, the primary one first: planes, cylinders or spheres, met by least squares")
    which.add_argument("--rps", type=Path, metavar="FILE.csv",
                       help="reference points that hold along their directions: x,y,z,nx,ny,nz and maybe tolerance")
    command.add_argument("--lock", type=lambda text: text.split(","), default=[], metavar="tx,ty,tz,rx,ry,rz",
                         help="degrees of freedom of the model's frame that stay as they are, with --datum or --rps")
    command.set_defaults(run=run)


def run(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds align``: the verdict to print."""
    from .. import api

    inputs = [path for path in (options.model, *options.scan, options.rps) if path is not None]
    api.check_outputs((options.out, options.pose), inputs)
    if options.out.suffix.lower() != ".ply":
        raise InputError(f"An aligned scan is written as .ply, not as '{options.out.suffix}'.")
    progress(f"Reading {', '.join(str(path) for path in options.scan)}")
    scan = api.read_scan(options.scan, options.scan_unit)
    progress(f"Reading {options.model}")
    model = api.read_model(options.model, options.object)
    aligned = _aligned(options, model, scan, progress)
    api.write_alignment(aligned, options.out, options.pose, inputs)
    return f"{aligned.table()}\n\n{written(options.out, options.pose)}"


def _aligned(options: argparse.Namespace, model: api.Model, scan: api.PointCloud, progress: ProgressLine
             ) -> api.AlignedScan | api.DatumAlignment:
    from .. import api

    if options.datum:
        return api.align_on_datum_faces(model, scan, options.datum, options.mode, options.lock, progress)
    if options.rps:
        return api.align_on_reference_points(model, scan, options.rps, options.mode, options.lock, progress)
    if options.lock:
        raise InputError("--lock goes with --datum or --rps.")
    return api.align_scan(model, scan, options.mode, progress)
