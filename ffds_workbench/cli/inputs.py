# SPDX-License-Identifier: LGPL-2.1-or-later
"""The arguments that several commands share: model, scan and registration."""
from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING

from ..registration.request import ALIGN, ISOMETRY, METHODS, RegistrationRequest
from ..scan.units import MILLIMETRES
from . import sensor
from .terminal import Progress

if TYPE_CHECKING:
    from .. import api

_PLAIN = RegistrationRequest()
_SETTINGS = ("method", "lattice", "freeze", "source_points", "isometry", "sensor", "align")


def add_inputs(command: argparse.ArgumentParser) -> None:
    """The arguments of a model and a scan."""
    command.add_argument("model", type=Path, metavar="MODEL", help=".step .stp .iges .igs .brep or .FCStd")
    command.add_argument("scan", type=Path, nargs="+", metavar="SCAN",
                         help=".ply .pcd .xyz .asc .txt .csv .pts .e57 .stl .las .laz or .obj; several of one part are "
                              "fused")
    add_model_options(command)


def add_model_options(command: argparse.ArgumentParser) -> None:
    """What goes with a model and a scan wherever they are named."""
    command.add_argument("--object", metavar="LABEL", help="the object of an .FCStd that holds several")
    command.add_argument("--scan-unit", choices=list(MILLIMETRES), default="mm", help="unit of the scan (default: mm)")


def add_registration(command: argparse.ArgumentParser) -> None:
    """The arguments of a registration; their values are checked by `RegistrationRequest`."""
    command.add_argument("--face", nargs="+", action="extend", metavar="FaceN",
                         help="faces to deform, each by itself (default: the whole part)")
    command.add_argument("--freeze", "--fixed", nargs="+", action="extend", default=[], metavar="FaceN",
                         help="faces that must not move")
    command.add_argument("--method", choices=METHODS, default=_PLAIN.method, help=f"default: {_PLAIN.method}")
    command.add_argument("--lattice", type=_lattice, default=_PLAIN.lattice, metavar="NIxNJ",
                         help="control points per face, for instance 10x10 (default: auto)")
    command.add_argument("--source-points", type=int, default=_PLAIN.source_points, metavar="N",
                         help=f"source points per face of methods ffds and ffd-hsu (default: {_PLAIN.source_points})")
    command.add_argument("--isometry", choices=ISOMETRY, default=_PLAIN.isometry,
                         help="whether a whole sheet part keeps its lengths (default: decided from the scan)")
    command.add_argument("--align", choices=ALIGN, default=_PLAIN.align,
                         help="bring the scan onto the model first (default: none)")
    command.add_argument("--sensor", metavar="PROFILE.json",
                         help="for bands that allow for noise that neighbouring points share: what 'ffds sensor "
                              f"measure' wrote, or one of {', '.join(sensor.PRESETS)}")


def read_request(options: argparse.Namespace) -> RegistrationRequest:
    """The request that the arguments make (InputError where they make none)."""
    from .. import api

    return api.as_request(options.face, **{name: getattr(options, name) for name in _SETTINGS})


def read_inputs(options: argparse.Namespace, progress: Progress) -> tuple[api.Model, api.PointCloud]:
    """The model and the scan."""
    from .. import api

    progress(f"Reading {', '.join(map(str, options.scan))}")
    scan = api.read_scan(options.scan, options.scan_unit)
    progress(f"Reading {options.model}")  # it has been under way since the command began
    return api.read_model(options.model, options.object), scan


def take_negative_numbers(command: argparse.ArgumentParser) -> None:
    """Let "-1e-1" and "-5,0,0" pass as values of a command's options: argparse knows plain negative numbers only."""
    command._negative_number_matcher = re.compile(r"^-[\d.][\d.,eE+-]*$")


def number(text: str) -> float:
    """The number that a text is."""
    try:
        return float(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"'{text}' is no number") from error


def direction(text: str) -> tuple[float, float, float]:
    """The direction that a text is, X,Y,Z."""
    parts = text.split(",")
    if len(parts) != 3:
        raise argparse.ArgumentTypeError(f"'{text}' is no direction: write X,Y,Z, for instance 0,0,1")
    x, y, z = (number(part) for part in parts)
    return x, y, z


def _lattice(text: str) -> tuple[int, int] | str:
    if text == "auto":
        return text
    match = re.fullmatch(r"(\d+)[xX×](\d+)", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no lattice: write NIxNJ, for instance 10x10, or auto")
    return int(match[1]), int(match[2])
