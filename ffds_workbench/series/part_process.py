# SPDX-License-Identifier: LGPL-2.1-or-later
"""The process that registers a worker's parts, one after the other; it may take itself along, but not its worker.

This is the worker's side; `part_server` is the other one.

FreeCAD and the model are loaded once. A worker that dies takes its process along, as the connection ends; a process
that takes too long or too much memory is ended, and the next part gets a new one.
"""
from __future__ import annotations

import json
import multiprocessing
import os
import subprocess
import sys
import time
from pathlib import Path

from .. import ROOT, find_freecad
from ..errors import FfdsError
from . import folder
from .setup import REFUSED, Outcome, PartJob, SeriesSetup

_CHILD = """
import json, sys
sys.path[:] = json.loads(sys.argv[1])
from ffds_workbench.series import part_server
part_server.serve(int(sys.argv[2]))
"""
_LOOK = 0.25
"""Seconds between looks at the memory of a process."""
_START = 120.0
"""Seconds that loading FreeCAD and the model may take on a busy machine; reading a model has limits of its own."""
_THREADS = {name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")}


class PartProcess:
    """A process that has the model of a series and takes parts; it ends with this object.

    Raises
    ------
    FfdsError : what the process says of the model
    """

    def __init__(self, setup: SeriesSetup) -> None:
        self.setup = setup
        self._connection, theirs = multiprocessing.Pipe()
        folder.work_folder(setup.folder).mkdir(parents=True, exist_ok=True)
        environment = {**os.environ, **_THREADS, "TMPDIR": str(folder.work_folder(setup.folder))}
        command = [find_freecad.interpreter(), "-c", _CHILD, json.dumps([str(ROOT), *sys.path]), str(theirs.fileno())]
        self._process = subprocess.Popen(command, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL,
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
        theirs.close()
        self._connection.send(setup)

    def end(self) -> None:
        """End it, whatever it does."""
        self._process.kill()
        self._process.wait()
        self._connection.close()

    def do(self, job: PartJob) -> Outcome | None:
        """What became of a part; None where the process died of it."""
        start = time.monotonic()
        limits, deadline = self.setup.limits, start + self.setup.limits.seconds
        try:
            self._connection.send(job)
            while not self._connection.poll(min(_LOOK, max(deadline - time.monotonic(), 0.0))):
                used = resident_memory(self._process.pid)
                if time.monotonic() >= deadline:
                    said = f"It took more than {limits.seconds:.0f} s, which is the limit for a part."
                elif limits.memory is not None and used > limits.memory:
                    said = f"It took more than {limits.memory / 2**20:.0f} MB of memory, which is the limit for a part."
                else:
                    continue
                self.end()
                return Outcome(job.scan, job.name, REFUSED, said, time.monotonic() - start)
            answer = self._connection.recv()
        except (EOFError, OSError):
            return None
        if isinstance(answer, FfdsError):
            raise answer
        return answer

    @property
    def fate(self) -> str:
        """How a process that died has ended."""
        code = self._process.wait()
        return f"signal {-code}" if code < 0 else f"code {code}"


def resident_memory(process: int) -> float:
    """Bytes that a process has in memory; 0 where the system does not tell."""
    try:
        return float(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")
    except (OSError, ValueError, IndexError):
        return 0.0
