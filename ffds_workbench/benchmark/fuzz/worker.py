# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads a batch of damaged files in a process that they may crash: models by commands, in forks of it."""
from __future__ import annotations

import contextlib
import json
import resource
import shutil
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...brep.simulated_scan import surface_samples
from ...errors import FfdsError
from ...registration.arrays import Array
from ...scan import files
from ...scan.plausibility import check_overlap
from ...seams.taught.carry import carry
from . import kinds, seeds

if TYPE_CHECKING:
    from .commands import CommandEnd

GOOD = ("taken", "refused")
LIMIT = 30.0
"""Seconds of processor time that a file may take (unit: what one waits for a refusal)."""
MEMORY = 2 << 30
"""Bytes that reading may take beyond what the idle process has, and that a command may take (unit)."""
LONGEST = 400
"""Characters of a sentence, the file's name left out (unit: what one reads)."""
_LOW, _HIGH = np.array([0.0, 0.0, -8.0]), np.array([100.0, 100.0, 8.0])


def main() -> None:
    """``FOLDER KIND FIRST COUNT SEED``: prints what came of each file; ``FOLDER/at`` tells which one is being read."""
    folder, kind, first, count, seed = Path(sys.argv[1]), sys.argv[2], *map(int, sys.argv[3:6])
    path, at = folder / f"file{kinds.suffix(kind)}", folder / "at"
    answer = _commands(folder, at) if kind.startswith("model") else _reading(kind)
    outcomes: Counter[str] = Counter()
    slowest = memory = 0.0
    with contextlib.redirect_stderr(None):  # numpy's warnings
        for index in range(first, first + count):
            path.write_bytes(kinds.damaged(kind, index, seed))
            at.write_text(str(index))
            outcome, seconds, megabytes = answer(path)
            slowest, memory = max(slowest, seconds), max(memory, megabytes)
            outcomes[outcome] += 1
            if outcome not in GOOD:
                shutil.copy(path, folder / "failures" / f"{kind.replace(' ', '-')}-{index}{path.suffix}")
    print(json.dumps({"outcomes": outcomes, "slowest": slowest, "memory": memory}))


def _commands(folder: Path, at: Path) -> Callable[[Path], tuple[str, float, float]]:
    """Gives a model to ``ffds deviation`` and, where it takes it, to ``ffds register``."""
    from . import commands

    def answer(path: Path) -> tuple[str, float, float]:
        slowest, memory = 0.0, 0.0
        for step in (["deviation", path, folder / "scan.ply"],
                     ["register", path, folder / "scan.ply", "--out", folder / "out.step"]):
            at.touch()
            end = commands.run([str(word) for word in step], folder / "said", LIMIT)
            slowest, memory = max(slowest, end.seconds), max(memory, end.memory)
            outcome = _of_command(end)
            if outcome != "taken":
                return outcome if outcome in GOOD else f"{step[0]}: {outcome}", slowest, memory
        return "taken", slowest, memory

    return answer


def _of_command(end: CommandEnd) -> str:
    """"taken", "refused", or what is wrong with how a command ended."""
    if end.seconds > LIMIT:
        return f"more than {LIMIT:.0f} s"
    if end.memory > MEMORY / 2**20:
        return f"more than {MEMORY >> 30} GB"
    if end.code is None:
        return "did not end"
    if end.code == 0:
        return "taken"
    one_line = end.text.count("\n") == 1 and "Internal error" not in end.text
    return "refused" if end.code in (2, 3) and one_line else f"exit {end.code}, {end.text.strip()[:80] or 'no line'}"


def _reading(kind: str) -> Callable[[Path], tuple[str, float, float]]:
    """Reads scans, or carries taught paths, in this process, which is given its limit of memory."""
    plate = seeds.plate()
    samples = surface_samples(plate)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, resource.RLIM_INFINITY))

    def answer(path: Path) -> tuple[str, float, float]:
        begin = time.process_time()
        outcome = _outcome(kind, path, plate, samples)
        seconds = time.process_time() - begin
        return outcome, seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024

    return answer


def _outcome(kind: str, path: Path, plate: object, samples: tuple[Array, Array]) -> str:
    """"taken", "refused", or what is wrong with the answer."""
    try:
        if kind.startswith("scan"):
            check_overlap(files.read(path), _LOW, _HIGH, lambda: samples)
        else:
            carry(plate, plate, path, path.with_name(f"new{path.suffix}"))
    except FfdsError as error:
        text = str(error)
        return "refused" if "\n" not in text and len(text) - 2 * len(str(path)) < LONGEST else "a bad sentence"
    except Exception as error:
        return type(error).__name__
    return "taken"
