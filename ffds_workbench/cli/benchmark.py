# SPDX-License-Identifier: LGPL-2.1-or-later
"""``ffds benchmark``: run one of the measurements and say where its tables are."""
from __future__ import annotations

import argparse
import importlib
from pathlib import Path
from typing import Any

from ..benchmark import NAMES
from .outputs import make_folder
from .terminal import ProgressLine


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command and one of its own for each measurement."""
    command = commands.add_parser("benchmark", help="measure accuracy, speed or topology anew")
    measurements = command.add_subparsers(dest="name", required=True, metavar="|".join(NAMES),
                                          parser_class=type(command))
    for name in NAMES:
        measurement = measurements.add_parser(name)
        measurement.add_argument("--out", type=Path, required=True, metavar="DIR",
                                 help="folder for tables and pictures")
        measurement.set_defaults(run=benchmark, more=lambda options: {})
    _add_world(measurements.choices["world"])
    _add_series(measurements.choices["series"])
    _add_fuzz(measurements.choices["fuzz"])


def _add_world(command: argparse.ArgumentParser) -> None:
    command.add_argument("--parts", type=Path, nargs="+", default=[], metavar="DIR", help="folders of model files")
    command.add_argument("--primitives", action="store_true", help="measure shapes that FreeCAD makes, too")
    command.add_argument("--deformations", nargs="+", metavar="NAME",
                         help="some of none, bent-PERCENT, bump (default: none bent-0.3 bent-1.5 bump)")
    command.add_argument("--views", type=int, metavar="N", help="directions the part is seen from (default: 6)")
    command.add_argument("--points", type=int, metavar="N", help="points of a scan (default: 60000)")
    command.add_argument("--sigma", type=float, metavar="MM", help="noise along the surface's normal (default: 0.08)")
    command.add_argument("--scale", type=float, metavar="FACTOR", help="multiplies every length (default: 1)")
    command.add_argument("--seed", type=int, metavar="N", help="of the random numbers (default: 1)")
    command.add_argument("--normals", action="store_true", default=None, help="scans with normals")
    command.add_argument("--workers", type=int, default=1, metavar="N", help="cases at the same time (default: 1)")
    command.add_argument("--limit", type=float, default=900.0, metavar="S",
                         help="seconds that one step of a case may take (default: 900)")
    command.set_defaults(more=_world)


def _world(options: argparse.Namespace) -> dict[str, Any]:
    from ..benchmark.world import DEFORMATIONS, ScanSettings

    names = ("views", "points", "sigma", "scale", "seed", "normals")
    chosen = {name: value for name in names if (value := getattr(options, name)) is not None}
    return {"parts": options.parts, "primitives": options.primitives, "settings": ScanSettings(**chosen),
            "deformations": options.deformations or DEFORMATIONS, "workers": options.workers, "limit": options.limit}


def _add_series(command: argparse.ArgumentParser) -> None:
    command.add_argument("--parts", type=int, default=8, metavar="N", help="scans of each series (default: 8)")
    command.add_argument("--workers", type=int, nargs="+", default=[1, 2], metavar="N", help="default: 1 2")
    command.add_argument("--many", type=int, nargs="+", default=[1000], metavar="N",
                         help="numbers of parts that do nothing (default: 1000)")
    command.set_defaults(more=lambda options: {"parts": options.parts, "workers": options.workers,
                                               "many": options.many})


def _add_fuzz(command: argparse.ArgumentParser) -> None:
    command.add_argument("--scans", type=int, default=2000, metavar="N",
                         help="damaged files of each kind of scan (default: 2000)")
    command.add_argument("--models", type=int, default=20, metavar="N",
                         help="damaged files of each kind of model (default: 20)")
    command.add_argument("--seed", type=int, default=1, metavar="N", help="of the random numbers (default: 1)")
    command.set_defaults(more=lambda options: {"scans": options.scans, "models": options.models, "seed": options.seed})


def benchmark(options: argparse.Namespace, progress: ProgressLine) -> str:
    """Run one and say where its tables are."""
    from .. import find_freecad

    find_freecad.activate()
    folder = make_folder(options.out)
    measurement = importlib.import_module(f"ffds_workbench.benchmark.{options.name}")
    text = measurement.run(folder, progress, **options.more(options))
    return f"{text or ''}\n\nWritten: {folder}".strip()
