# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``./ffds inspect``: values, bands and verdicts of a plan."""
from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from ..brep.model_files.reading import FORMATS
from ..errors import InputError
from .inputs import add_model_options, add_registration, read_request
from .outputs import make_folder
from .terminal import Progress


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line's parser."""
    command = commands.add_parser("inspect", help="hold an inspection plan against a scan or an as-built model")
    command.add_argument("model", type=Path, metavar="MODEL", help="the nominal model")
    command.add_argument("measured", type=Path, nargs="+", metavar="SCAN|AS_BUILT+REPORT",
                         help="scans of one part, which are registered first; or the as-built model that register made "
                              "of one, and its report (.json), which has the bands")
    add_model_options(command)
    command.add_argument("--plan", type=Path, required=True, metavar="PLAN.json",
                         help="what is to be inspected, see the documentation")
    command.add_argument("--out", type=Path, required=True, metavar="DIR",
                         help="folder for inspection.json, inspection.csv and index.html")
    add_registration(command)
    command.set_defaults(run=inspect)


def inspect(options: argparse.Namespace, progress: Progress) -> str:
    """``ffds inspect``: the table to print."""
    from .. import api
    from ..report import record

    measured = _parted(options.measured)
    models = [path for path in measured if path.suffix.lower() in FORMATS]
    reports = [path for path in measured if path.suffix.lower() == ".json"]
    scans = [path for path in measured if path not in (*models, *reports)]
    if len(models) > 1 or len(reports) > 1 or (reports and not models) or (models and scans):
        raise InputError("Name either scans, or one as-built model and the report that was written with it.")
    plan = api.read_plan(options.plan)
    request = read_request(options)
    if models:
        report = record.read(reports[0]) if reports else None
        progress(f"Reading {models[0]}")
        found = api.inspect_model(api.read_model(options.model, options.object), api.read_model(models[0]), plan,
                                  report, progress)
    else:
        progress(f"Reading {', '.join(map(str, scans))}")
        scan = api.read_scan(scans, options.scan_unit)
        found = api.inspect_scan(request, api.read_model(options.model, options.object), scan, plan, progress)
    folder = make_folder(options.out)
    progress(f"Writing {folder}")
    api.write_inspected(found, folder, (options.model, options.plan, *measured))
    return f"{found.table()}\n\nWritten: {folder}"


def _parted(paths: Sequence[Path]) -> list[Path]:
    """AS_BUILT+REPORT, written as one word, is two files."""
    found = []
    for path in paths:
        first, plus, second = str(path).rpartition("+")
        together = bool(plus) and not path.exists() and second.lower().endswith(".json")
        found += [Path(first), Path(second)] if together else [path]
    return found
