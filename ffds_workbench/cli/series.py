# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``./ffds series``: many scans of one part, registered on all processors or on a cluster."""
from __future__ import annotations

import argparse
from pathlib import Path

from .inputs import add_model_options, add_registration, read_request
from .terminal import Finished, Progress


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line's parser."""
    command = commands.add_parser("series", help="register many scans, each a part, and tell what they have in common")
    command.add_argument("model", type=Path, metavar="MODEL", help=".step .stp .iges .igs .brep or .FCStd")
    command.add_argument("scan", type=Path, nargs="*", metavar="SCANS",
                         help="scan files, folders of them, patterns in quotes, or lists: text files with the name of "
                              "a scan in each line, or tables whose first column is 'scan' and the others labels")
    add_model_options(command)
    command.add_argument("--out", type=Path, required=True, metavar="DIR",
                         help="folder for the results, one folder a part")
    where = command.add_mutually_exclusive_group()
    where.add_argument("--workers", type=int, metavar="N",
                       help="processes (default: what processors and memory bear)")
    where.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster to use, for instance tcp://host:8786")
    command.add_argument("--resume", action="store_true", help="go on with a series that was interrupted")
    command.add_argument("--watch", type=Path, metavar="FOLDER",
                         help="take what comes into this folder, until a file STOP is there")
    command.add_argument("--plan", type=Path, metavar="PLAN.json",
                         help="hold every part against this inspection plan, see ffds inspect")
    command.add_argument("--part-seconds", type=float, default=900.0, metavar="S",
                         help="a part that takes longer is refused (default: 900)")
    command.add_argument("--part-memory", type=float, metavar="MB",
                         help="a part that takes more is refused (default: its share of the machine)")
    add_registration(command)
    command.set_defaults(run=series)


def series(options: argparse.Namespace, progress: Progress) -> Finished:
    """``ffds series``: the table to print, and the exit code."""
    from .. import api
    from ..series.job import run_series

    memory = None if options.part_memory is None else options.part_memory * 2**20
    limits = api.SeriesLimits(options.part_seconds, memory)
    found = run_series(read_request(options), options.model, options.scan, options.out, progress, options.object,
                       options.scan_unit, options.workers, options.scheduler, options.resume, options.watch, limits,
                       options.plan)
    return Finished(f"{found.table()}\n\nWritten: {options.out}", found.exit)
