# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command ``./ffds serve``: registrations over HTTP, on this machine unless told otherwise."""
from __future__ import annotations

import argparse
import importlib
import os
import secrets
from pathlib import Path

from ..errors import InputError
from .outputs import make_folder
from .terminal import Progress

_TOKEN = "FFDS_TOKEN"
_SHORTEST_TOKEN = 16
"""Characters of a token that the environment gives (unit: none is guessed over a network)."""


def add(commands: argparse._SubParsersAction) -> None:
    """Add the command to the command line's parser."""
    command = commands.add_parser("serve", help="register over HTTP: submit, follow, fetch")
    command.add_argument("--out", type=Path, required=True, metavar="DIR",
                         help="folder for files, jobs and results; a server goes on with what is there")
    command.add_argument("--host", default="127.0.0.1", metavar="ADDRESS",
                         help="default: 127.0.0.1, this machine alone")
    command.add_argument("--port", type=int, default=8787, metavar="N", help="default: 8787")
    command.add_argument("--limit", type=float, default=2000.0, metavar="MB", help="largest file (default: 2000)")
    command.add_argument("--workers", type=int, metavar="N", help="processes (default: what the machine bears)")
    command.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster to use")
    command.add_argument("--part-seconds", type=float, default=900.0, metavar="S",
                         help="a job that takes longer is refused (default: 900)")
    command.set_defaults(run=serve)


def serve(options: argparse.Namespace, progress: Progress) -> str:
    """``ffds serve``: runs until it is interrupted."""
    from ..series import SeriesLimits
    from ..series.engine import distributed, local_workers
    from ..series.folder import locked

    distributed("serving")
    try:
        uvicorn = importlib.import_module("uvicorn")
        make_app = importlib.import_module("..serve.app", __package__).make_app
    except ImportError as error:
        raise InputError(f"{error.name} is not installed, and serving needs it: install it (Debian: python3-fastapi "
                         f"and python3-uvicorn), or run ./ffds setup.") from error
    from ..serve.jobs import Jobs
    from ..serve.runner import Runner
    from ..serve.uploads import Uploads

    if not options.limit > 0:
        raise InputError(f"A limit of {options.limit:g} MB makes no sense: give one above 0.")
    token = os.environ.get(_TOKEN) or secrets.token_urlsafe(24)
    if len(token) < _SHORTEST_TOKEN:
        raise InputError(f"The token in {_TOKEN} is shorter than {_SHORTEST_TOKEN} characters: choose a longer one.")
    workers, memory = local_workers(options.workers)
    folder = make_folder(options.out).absolute()
    with locked(folder) or open(os.devnull):
        limits = SeriesLimits(options.part_seconds, memory if memory < float("inf") else None)
        jobs = Jobs(folder, limits)
        runner = Runner(jobs, workers, options.scheduler)
        app = make_app(Uploads(folder / "files", int(options.limit * 1e6)), jobs, runner, token)
        _keep(token, folder / "token")
        progress(f"Serving at http://{options.host}:{options.port}; the token is in {folder / 'token'}")
        uvicorn.run(app, host=options.host, port=options.port, log_level="critical", server_header=False)
    return "The server has ended."


def _keep(token: str, path: Path) -> None:
    """Write the token to a file that its user alone can read."""
    path.unlink(missing_ok=True)
    with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as stream:
        stream.write(token + "\n")
