# SPDX-License-Identifier: LGPL-2.1-or-later
"""OCCT's check for Boolean operations, in separate processes and with a time limit.

Every body of a shape is checked by itself. Where bodies touch, the check of the whole reports errors that come and go
with the last digits of either; that is no flaw of a body.
"""
from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
import time
import weakref
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import Part

from .. import find_freecad
from ..brep import topology

_CHECKER = """
import json, os, sys
try:
    import resource
    os.nice(5)
    resource.setrlimit(resource.RLIMIT_CPU, (int(sys.argv[3]), int(sys.argv[3])))
except ImportError:
    pass
sys.path[:] = json.loads(sys.argv[2])
import FreeCAD, Part
shape = Part.Shape()
shape.importBrep(sys.argv[1])
for body in shape.childShapes():
    try:
        body.check(True)
        lines = []
    except ValueError as errors:
        lines = str(errors).splitlines()
    count = max(len([line for line in lines if line.startswith("Error in")]), int(bool(lines)))
    print("errors:", count, flush=True)
"""
_PATIENCE = 4.0
"""Times its limit that a check is waited for, as it gets but a share of a busy processor."""

BodyErrors = tuple[int | None, ...]
"""Errors that the check for Boolean operations reports for each body; None where it did not finish."""


class BooleanChecks:
    """OCCT's checks for Boolean operations, running beside other work.

    A check can take hours and cannot be interrupted, so each shape is checked in a process of its own with low
    priority. It ends with this object, or by itself when its time is up.

    Parameters
    ----------
    limit : seconds of processor time after which a check is given up (of elapsed time, four times as many)
    """

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._folder = tempfile.TemporaryDirectory()
        self._checks: list[_Check | _KnownCheck] = []
        self._kept: list[tuple[Part.Shape, _Check]] = []
        self._processes: list[subprocess.Popen[str]] = []
        self._end = weakref.finalize(self, _end, self._processes, self._folder)

    def begin(self, shape: Part.Shape, keep: bool = False) -> None:
        """Begin the check of a shape; with ``keep`` its answer is kept for the next time, as of a nominal part."""
        for known, errors in _KNOWN:
            if known.isEqual(shape):
                self._checks.append(_KnownCheck(errors))
                return
        path = Path(self._folder.name) / f"{len(self._processes)}.brep"
        bodies = topology.bodies(shape)
        Part.makeCompound(bodies).exportBrep(str(path))
        command = [find_freecad.interpreter(), "-c", _CHECKER, str(path), json.dumps(sys.path),
                   str(math.ceil(self._limit) + 1)]
        self._processes.append(subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True))
        check = _Check(self._processes[-1], len(bodies), time.monotonic() + _PATIENCE * self._limit)
        self._checks.append(check)
        if keep:
            self._kept.append((shape, check))

    @property
    def done(self) -> bool:
        """Whether `errors` would give its answer at once."""
        return all(check.done for check in self._checks)

    def errors(self) -> tuple[BodyErrors, ...]:
        """Number of errors found in each body of each shape, waited for."""
        answers = {id(check): check.errors() for check in self._checks}
        found = tuple(answers[id(check)] for check in self._checks)
        _KNOWN.extendleft((shape, errors) for shape, check in self._kept if None not in (errors := answers[id(check)]))
        self._kept.clear()
        self._end()
        return found


@dataclass(frozen=True)
class _Check:
    """The check of one shape under way."""

    process: subprocess.Popen[str]
    bodies: int
    deadline: float

    @property
    def done(self) -> bool:
        return self.process.poll() is not None or time.monotonic() > self.deadline

    def errors(self) -> BodyErrors:
        try:
            self.process.wait(max(0.0, self.deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            self.process.kill()
        output, _ = self.process.communicate()
        found = [int(line.partition("errors:")[2]) for line in output.splitlines() if "errors:" in line]
        return (*found, *[None] * (self.bodies - len(found)))


@dataclass(frozen=True)
class _KnownCheck:
    """The check of a shape that was checked before."""

    found: BodyErrors
    done: bool = True

    def errors(self) -> BodyErrors:
        return self.found


_KNOWN: deque[tuple[Part.Shape, BodyErrors]] = deque(maxlen=4)
"""Shapes whose check has been kept, and its errors."""


def total(errors: BodyErrors) -> int | None:
    """Errors in all bodies; None where the check of one of them did not finish."""
    found = [count for count in errors if count is not None]
    return sum(found) if len(found) == len(errors) else None


def boolean_checks(shapes: Sequence[Part.Shape], limit: float) -> tuple[BodyErrors, ...]:
    """Errors that OCCT's check for Boolean operations reports for each body of each shape, with ``limit`` s for each
    shape."""
    checks = BooleanChecks(limit)
    for shape in shapes:
        checks.begin(shape)
    return checks.errors()


def _end(processes: Sequence[subprocess.Popen[str]], folder: tempfile.TemporaryDirectory[str]) -> None:
    for process in processes:
        process.kill()
        process.wait()
    folder.cleanup()
