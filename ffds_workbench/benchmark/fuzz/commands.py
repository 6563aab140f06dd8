# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs commands of the command line, each in a fork of this process, which has all that they load, with limits."""
from __future__ import annotations

import importlib
import os
import resource
import runpy
import select
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

_COMMAND_LINE = "ffds_workbench.cli"
for _name in (f"{_COMMAND_LINE}.main", "ffds_workbench.api"):
    importlib.import_module(_name)  # here, once for all commands
_PATIENCE = 10.0
"""Times its limit that a command is waited for, as other work may load the machine (unit)."""


@dataclass(frozen=True)
class CommandEnd:
    """How a command ended: exit code, negative for a signal, None if it was waited for in vain; what it said; processor
    time in s, most memory in MB."""

    code: int | None
    text: str
    seconds: float
    memory: float


def run(arguments: list[str], said: Path, limit: float) -> CommandEnd:
    """Run one command; ``said`` is a file for what it says, ``limit`` the processor time in s that it may take."""
    said.write_bytes(b"")
    child = os.fork()
    if child == 0:
        _child(arguments, said, limit)
    process = os.pidfd_open(child)
    try:
        ended = bool(select.select([process], [], [], _PATIENCE * limit)[0])
        if not ended:
            os.kill(child, signal.SIGKILL)
        _, status, used = os.wait4(child, 0)
    finally:
        os.close(process)
    return CommandEnd(os.waitstatus_to_exitcode(status) if ended else None, said.read_text("utf-8", errors="replace"),
                      used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def main(arguments: list[str]) -> int:
    """What ``./ffds`` runs, with its exit code."""
    sys.argv = ["ffds", *arguments]
    try:
        runpy.run_module(_COMMAND_LINE, run_name="__main__")
    except SystemExit as end:
        return int(end.code or 0)
    return 0


def _child(arguments: list[str], said: Path, limit: float) -> None:
    """What the fork does; it does not come back."""
    code = 1
    try:
        nothing = os.open(os.devnull, os.O_RDWR)
        text = os.open(said, os.O_WRONLY)
        for stream, own in ((nothing, 0), (nothing, 1), (text, 2)):
            os.dup2(stream, own)
        sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False)
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, resource.RLIM_INFINITY))
        code = main(arguments)
        sys.stderr.flush()
    finally:
        os._exit(code)
