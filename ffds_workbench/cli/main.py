# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line ``./ffds``: arguments in, `api` called, one line of error and an exit code out.

Exit codes: 0 written, 2 bad usage or input, 3 refused or failed honestly, 130 interrupted.
"""
from __future__ import annotations

import argparse
import os
import signal
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn, TextIO

from .. import RESOURCES, __version__
from ..brep.model_files import reading
from ..errors import FfdsError, InputError, RefusedError
from . import align, benchmark, inspect, prepare, seams, sensor, series, serve, simulate, weld
from .inputs import add_inputs, add_registration, direction, read_inputs, read_request, take_negative_numbers
from .morphing import compensate, field, morph
from .outputs import make_folder, read_back, written
from .terminal import Finished, ProgressLine, quiet_libraries

FAILED, INTERRUPTED = 3, 130
DEBUG = "FFDS_DEBUG"
"""Set this variable to see the traceback of an internal error."""
_DEMO_SEAM = ["Edge7"]


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message[:1].upper()}{message[1:]} ({self.prog} --help lists what there is).")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    try:
        options = command_line().parse_args(arguments)
    except InputError as error:
        return _fail(sys.stderr, error)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    for name, label in (("model", getattr(options, "object", None)), ("nominal", None), ("as_built", None)):
        if isinstance(path := getattr(options, name, None), Path):
            reading.begin(path, label)  # beside what else there is to load
    with quiet_libraries() as (out, err):
        progress = ProgressLine(err)
        try:
            code = _run(options, out, err, progress)
            out.flush()
        except BrokenPipeError:
            code = FAILED
        return code


def _run(options: argparse.Namespace, out: TextIO, err: TextIO, progress: ProgressLine) -> int:
    try:
        found = options.run(options, progress)
        done = found if isinstance(found, Finished) else Finished(found)
        progress.clear()
        print(done.text, file=out)
        return done.exit
    except FfdsError as error:
        progress.clear()
        return _fail(err, error)
    except KeyboardInterrupt:
        progress.clear()
        print("ffds: Interrupted; nothing half-written is left.", file=err)
        return INTERRUPTED
    except MemoryError:
        progress.clear()
        return _fail(err, RefusedError("There is not enough memory for this job."))
    except Exception as error:  # the user gets one line; developers set FFDS_DEBUG
        progress.clear()
        if os.environ.get(DEBUG):
            traceback.print_exc(file=err)
        detail = " ".join(str(error).split())[:200]
        return _fail(err, RefusedError(f"Internal error, nothing was written ({type(error).__name__}: {detail})."))


def _fail(stream: TextIO, error: FfdsError) -> int:
    print("ffds: " + " ".join(str(error).split()), file=stream)
    return error.exit_code


def command_line() -> argparse.ArgumentParser:
    """The parser of all commands, with their options."""
    parser = _Parser(prog="ffds", description="As-built CAD models from scans: surface-based free-form deformation.",
                     epilog="'ffds setup' installs what is needed and runs the example; 'ffds test' runs the tests.")
    parser.add_argument("--version", action="version", version=f"FFDS {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=_Parser)
    _add_register(commands)
    _add_deviation(commands)
    prepare.add(commands)
    align.add(commands)
    simulate.add(commands)
    sensor.add(commands)
    field.add(commands)
    morph.add(commands)
    compensate.add(commands)
    seams.add(commands)
    weld.add(commands)
    series.add(commands)
    inspect.add(commands)
    serve.add(commands)
    _add_demo(commands)
    benchmark.add(commands)
    return parser


def _add_register(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("register", help="deform the model to the scan and write the as-built model")
    add_inputs(command)
    command.add_argument("--out", type=Path, required=True, help="as-built model: .step, .brep or .FCStd")
    command.add_argument("--report", type=Path, metavar="OUT.json", help="the figures, as JSON")
    command.add_argument("--picture", type=Path, metavar="OUT.png", help="the deviation before and after")
    command.add_argument("--html", type=Path, metavar="OUT.html", help="the report as one page, with the part to turn")
    command.add_argument("--pdf", type=Path, metavar="OUT.pdf", help="the report as PDF")
    take_negative_numbers(command)
    command.add_argument("--side", type=direction, action="append", default=[], metavar="X,Y,Z",
                         help="from the part to the viewer of a picture in HTML and PDF; may be repeated (default: the "
                              "side that was scanned, and the other one)")
    add_registration(command)
    command.set_defaults(run=register)


def _add_deviation(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("deviation", help="measure the scan's distance from the model")
    add_inputs(command)
    command.add_argument("--report", type=Path, metavar="OUT.json", help="the figures, as JSON")
    command.add_argument("--picture", type=Path, metavar="OUT.png", help="the scan, coloured by its deviation")
    command.set_defaults(run=deviation)


def _add_demo(commands: argparse._SubParsersAction) -> None:
    command = commands.add_parser("demo", help="run the main job on the bundled example")
    command.add_argument("--out", type=Path, default=Path("out/demo"), metavar="DIR", help="default: out/demo")
    command.set_defaults(run=demo)


def register(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds register``: the table to print."""
    from .. import api

    inputs = [options.model, *options.scan]
    outputs = options.out, options.report, options.picture, options.html, options.pdf
    api.check_outputs(outputs, inputs)
    api.check_model_output(options.out)
    request = read_request(options)
    model, scan = read_inputs(options, progress)
    api.check_model_output(options.out, model)
    result = api.run(request, model, scan, progress)
    progress(f"Writing {options.out}")
    certificate = api.write(result, options.out, options.report, options.picture, inputs)
    api.write_pages(result, options.html, options.pdf, inputs, options.side)
    return "\n\n".join([result.table(), read_back(certificate), written(*outputs)])


def deviation(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds deviation``: the table to print."""
    from .. import api

    inputs = [options.model, *options.scan]
    api.check_outputs((options.report, options.picture), inputs)
    model, scan = read_inputs(options, progress)
    result = api.deviation(model, scan, progress)
    api.write_deviation(result, options.report, options.picture, inputs)
    return "\n\n".join(filter(None, [result.table(), written(options.report, options.picture)]))


def demo(options: argparse.Namespace, progress: ProgressLine) -> str:
    """``ffds demo``: the main job on the example, and a weld along the rim of its end face."""
    from .. import api

    folder = make_folder(options.out)
    example = RESOURCES / "examples"
    progress("Reading the example")
    model = api.read_model(example / "bracket.step")
    scan = api.read_scan(example / "bracket_scan.ply")
    result = api.register(model, scan, progress=progress)
    wanted = weld.Wanted(_DEMO_SEAM, None, True, api.RobotSettings(), api.SeamSettings(), api.SeamLimits())
    text = weld.write_chain(result, wanted, folder, "bracket_as_built.step", (), progress)
    return f"{text}\n\nWritten: {folder / weld.PAGE} and what it shows"
