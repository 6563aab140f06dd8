# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds sensor``: its options and what it prints."""
from __future__ import annotations

import argparse
from pathlib import Path

from ..errors import InputError
from ..scan.units import MILLIMETRES
from .terminal import Progress

PRESETS = ("white", "paper", "line-laser", "structured-light", "robot-laser")
"""Names of `sensor_profile.PRESETS`, here so that the command line need not load them."""


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line."""
    command = commands.add_parser("sensor", help="measure a sensor's noise")
    kinds = command.add_subparsers(dest="kind", required=True, metavar="measure")
    measure = kinds.add_parser("measure", help="from one scan of a flat datum, or from repeated scans of anything")
    measure.add_argument("scan", type=Path, nargs="+", metavar="SCAN",
                         help="one, of a flat datum that fills it; or several of the same thing, nothing moved between")
    measure.add_argument("--flat", action="store_true", help="several scans are of flat datums too")
    measure.add_argument("--name", help="of the sensor (default: that of the profile's file)")
    measure.add_argument("--scan-unit", choices=list(MILLIMETRES), default="mm", help="unit of the scan (default: mm)")
    measure.add_argument("--out", type=Path, required=True, metavar="PROFILE.json", help="the profile")
    measure.set_defaults(run=run)


def run(options: argparse.Namespace, progress: Progress) -> str:
    """``ffds sensor measure``: the profile in words."""
    from .. import api

    if options.out.suffix.lower() != ".json":
        raise InputError(f"A sensor profile is written as .json, not as '{options.out.suffix}'.")
    api.check_outputs([options.out], options.scan)
    scans = []
    for path in options.scan:
        progress(f"Reading {path}")
        scans.append(api.read_scan(path, options.scan_unit))
    progress("Measuring the noise")
    profile = api.measure_sensor(scans, options.flat, options.name or options.out.stem)
    api.write_sensor(profile, options.out, options.scan)
    shared = (f"{profile.sigma_c:.4f} mm shared over {profile.correlation_length:.2f} mm" if profile.sigma_c
              else "nothing shared by neighbouring points")
    return f"{profile.name}: white noise {profile.sigma:.4f} mm, {shared}\n\nWritten: {options.out}"
