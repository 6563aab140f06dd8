# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the command line shows: progress on a terminal, one line of error, and no output of the libraries."""
from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TextIO

Progress = Callable[[str], None]
"""Called with what is being done now."""


@dataclass(frozen=True)
class Finished:
    """What a command has to print, and its exit code if that is not 0 although something was written."""

    text: str
    exit: int = 0


class ProgressLine:
    """One line on a terminal that says what is being done; nothing where the output is no terminal."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream if stream.isatty() else None
        self._start = time.monotonic()
        self._shown = 0

    def __call__(self, text: str) -> None:
        if self._stream is not None:
            line = f"{time.monotonic() - self._start:6.1f} s  {text}"[:110]
            self._stream.write("\r" + line.ljust(self._shown))
            self._stream.flush()
            self._shown = len(line)

    def clear(self) -> None:
        """Take the line away."""
        if self._stream is not None and self._shown:
            self._stream.write("\r" + " " * self._shown + "\r")
            self._stream.flush()


@contextmanager
def quiet_libraries() -> Iterator[tuple[TextIO, TextIO]]:
    """Send what compiled libraries print to nowhere; yields the real (stdout, stderr) to write to.

    FreeCAD, OCCT and open3d write to the file descriptors themselves, past Python.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    descriptors = [os.dup(1), os.dup(2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    os.close(nowhere)
    out, err = (os.fdopen(os.dup(number), "w", encoding="utf-8", errors="replace") for number in descriptors)
    try:
        yield out, err
    finally:
        for stream in (out, err):
            try:
                stream.close()
            except BrokenPipeError:
                continue
        for target, number in enumerate(descriptors, 1):
            os.dup2(number, target)
            os.close(number)
