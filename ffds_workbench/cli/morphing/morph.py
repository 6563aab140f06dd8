# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``./ffds morph``."""
from __future__ import annotations

import argparse
from pathlib import Path

from ..inputs import take_negative_numbers
from ..outputs import read_back, written
from ..terminal import ProgressLine


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line."""
    command = commands.add_parser("morph", help="deform a model by a displacement field, with its topology kept")
    take_negative_numbers(command)
    command.add_argument("model", type=Path, metavar="MODEL", help=".step .stp .iges .igs .brep or .FCStd")
    command.add_argument("--object", metavar="LABEL", help="the object of an .FCStd that holds several")
    command.add_argument("--field", type=Path, required=True, metavar="FIELD.csv",
                         help="x,y,z,dx,dy,dz and maybe sigma, in mm, at places of the nominal model")
    command.add_argument("--factor", type=float, default=1.0, metavar="F",
                         help="that the field is multiplied with: -1 for the reverse, 0 for the nominal model "
                              "(default: 1)")
    command.add_argument("--tolerance", type=float, metavar="MM", help="tell the vectors that are missed by more")
    command.add_argument("--ignore", type=float, default=0.0, metavar="SHARE",
                         help="share of the vectors that may be left out, those that agree least with the others "
                              "(default: 0)")
    command.add_argument("--out", type=Path, required=True, help="deformed model: .step, .brep or .FCStd")
    command.add_argument("--report", type=Path, metavar="OUT.json", help="the figures, as JSON")
    command.set_defaults(run=run)


def run(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds morph``: the table to print."""
    from ... import api

    inputs = [options.model, options.field]
    api.check_outputs((options.out, options.report), inputs)
    api.check_model_output(options.out)
    field = api.as_field(options.field)
    progress(f"Reading {options.model}")
    model = api.read_model(options.model, options.object)
    api.check_model_output(options.out, model)
    result = api.morph(model, field, options.factor, options.tolerance, options.ignore, progress)
    progress(f"Writing {options.out}")
    certificate = api.write_deformed(result, options.out, options.report, inputs)
    return "\n\n".join([result.table(), read_back(certificate), written(options.out, options.report)])
