# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``./ffds field``."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ...errors import InputError
from ..terminal import ProgressLine

if TYPE_CHECKING:
    from ...fields import VectorField


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line."""
    command = commands.add_parser("field", help="take a displacement field: of two models, of meshes, through points")
    command.add_argument("models", type=Path, nargs="*", metavar="MODEL",
                         help="the nominal model and the as-built one, of the same topology; with --points the nominal "
                              "one alone")
    command.add_argument("--mesh", type=Path, nargs="+", metavar="FILE",
                         help="two .stl meshes with the same numbering, nominal and displaced, or one result of finite "
                              "elements with displacements: .frd .vtu .vtk .unv")
    command.add_argument("--step", type=int, metavar="N", help="of a result that has several (default: the last)")
    command.add_argument("--points", type=Path, metavar="CMM.csv",
                         help="measured points of MODEL, between which its stiffness fills in: "
                              "x,y,z,nx,ny,nz,deviation[,sigma] or x,y,z,dx,dy,dz[,sigma], in mm")
    command.add_argument("--out", type=Path, required=True, metavar="FIELD.csv",
                         help="x,y,z,dx,dy,dz and, where known, sigma")
    command.set_defaults(run=run)


def run(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds field``: what was found, in words."""
    from ... import api

    inputs = tuple(path for path in (*options.models, *(options.mesh or ()), options.points) if path is not None)
    api.check_outputs((options.out,), inputs)
    field = _taken(options, progress)
    api.save_field(field, options.out, inputs)
    told = "" if field.sigma is None else f"; sigma up to {field.sigma.max():.3g} mm"
    return f"Field        {len(field)} vectors, up to {field.largest:.4g} mm{told}\n\nWritten: {options.out}"


def _taken(options: argparse.Namespace, progress: ProgressLine) -> VectorField:
    from ... import api

    count = len(options.models)
    if options.step is not None and options.mesh is None:
        raise InputError("--step picks a step of a result: give it with --mesh.")
    if options.mesh is not None:
        if count or options.points is not None or len(options.mesh) > 2:
            raise InputError("--mesh takes two .stl meshes or one result, and no model.")
        progress("Reading the mesh")
        return api.field_of_meshes(*options.mesh, step=options.step)
    if options.points is not None:
        if count != 1:
            raise InputError("--points are those of one model: name the nominal model alone.")
        progress("Filling in between the points")
        return api.field_of_points(options.models[0], options.points)
    if count != 2:
        raise InputError("Name the nominal model and the as-built one, or give --mesh or --points.")
    progress("Comparing the models")
    return api.field_of_models(*options.models)
