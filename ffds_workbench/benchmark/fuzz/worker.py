# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads a batch of damaged scans or taught paths in a process that they may take along."""
from __future__ import annotations

import contextlib
import json
import resource
import shutil
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

from ...brep.simulated_scan import surface_samples
from ...errors import FfdsError
from ...registration.arrays import Array
from ...scan import files
from ...scan.plausibility import check_overlap
from ...seams.taught.carry import carry
from . import kinds, seeds

MEMORY = 2 << 30
"""Bytes that reading may take beyond what the idle process has."""
LONGEST = 400
"""Characters of a sentence, the file's name left out."""
_LOW, _HIGH = np.array([0.0, 0.0, -8.0]), np.array([100.0, 100.0, 8.0])


def main() -> None:
    """``FOLDER KIND FIRST COUNT SEED``: prints what came of each file; ``FOLDER/at`` tells which one is being read."""
    folder, kind, first, count, seed = Path(sys.argv[1]), sys.argv[2], *map(int, sys.argv[3:6])
    path, at = folder / f"file{kinds.suffix(kind)}", folder / "at"
    plate = seeds.plate()
    samples = surface_samples(plate)
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, resource.RLIM_INFINITY))
    outcomes: Counter[str] = Counter()
    slowest = 0.0
    with contextlib.redirect_stderr(None):  # numpy's warnings
        for index in range(first, first + count):
            path.write_bytes(kinds.damaged(kind, index, seed))
            at.write_text(str(index))
            begin = time.process_time()
            outcome = _outcome(kind, path, plate, samples)
            slowest = max(slowest, time.process_time() - begin)
            outcomes[outcome] += 1
            if outcome not in ("taken", "refused"):
                shutil.copy(path, folder / "failures" / f"{kind.replace(' ', '-')}-{index}{path.suffix}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"outcomes": outcomes, "slowest": slowest, "memory": peak}))


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
