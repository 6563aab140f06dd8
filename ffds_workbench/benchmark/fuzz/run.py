# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs batches of damaged files, in processes with limits on time and memory, and records the outcomes."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ... import ROOT
from ..pages import page
from . import kinds, seeds, worker

Progress = Callable[[str], None]

_SCAN_BATCH, _MODEL_BATCH = 20_000, 50
"""Scans or paths, and models, between which the table is written (unit: time)."""
_PATIENCE = 600.0
"""Seconds that a step of one file is waited for, as other work may load the machine (unit: longer than
`commands` waits for one)."""
_WORKER = """
from ffds_workbench import find_freecad
find_freecad.activate()
from ffds_workbench.benchmark.fuzz import worker
worker.main()
"""


@dataclass
class FuzzRow:
    """What became of the files of one kind.

    Attributes
    ----------
    outcomes : how many were taken, refused in one sentence, or failed, and how
    slowest : processor time of the slowest file in s
    memory : most memory of a process in MB
    """

    kind: str
    outcomes: Counter[str] = field(default_factory=Counter)
    slowest: float = 0.0
    memory: float = 0.0

    @property
    def tried(self) -> int:
        """Files so far."""
        return sum(self.outcomes.values())

    def add(self, outcomes: dict[str, int], slowest: float, memory: float) -> None:
        """Count further files."""
        self.outcomes.update(outcomes)
        self.slowest, self.memory = max(self.slowest, slowest), max(self.memory, memory)


def run(folder: Path, progress: Progress, scans: int = 2000, models: int = 20, seed: int = 1) -> str:
    """Damage files, have them read, and write ``fuzz.json``, ``.md`` and ``.html``; returns the table.

    Parameters
    ----------
    folder : for the tables, and for the files that were not answered as they should, in ``failures``
    scans : damaged files of each kind of scan, and a hundredth of them of each kind of taught path
    models : damaged files of each kind of model, given to ``ffds deviation`` and, those it takes, to ``ffds register``
    """
    folder = folder.resolve()
    (folder / "failures").mkdir(exist_ok=True)
    (folder / "scan.ply").write_bytes(seeds.ply(seeds.measured(), "binary_little_endian"))
    counts = {kind: scans if kind.startswith("scan") else -(-scans // 100) for kind in kinds.in_process()}
    rows: list[FuzzRow] = []
    counts |= dict.fromkeys(kinds.by_command() if models else (), models)
    for kind, count in counts.items():
        rows.append(FuzzRow(kind))
        most = _MODEL_BATCH if kind.startswith("model") else _SCAN_BATCH
        while rows[-1].tried < count:
            progress(f"{kind}: {rows[-1].tried} of {count}")
            _batch(folder, rows[-1], min(most, count - rows[-1].tried), seed)
            _write(folder, rows)
    for name in ("at", "said", "scan.ply", "out.step", *(f"{stem}{suffix}" for stem in ("file", "new") for suffix in
                 {kinds.suffix(row.kind) for row in rows})):
        (folder / name).unlink(missing_ok=True)
    return _write(folder, rows)


def _batch(folder: Path, row: FuzzRow, count: int, seed: int) -> None:
    """Have a process read a batch; where a file takes it along or does not end, the batch ends there."""
    first, at = row.tried, folder / "at"
    at.write_text(str(first))
    command = [sys.executable, "-P", "-c", _WORKER, str(folder), row.kind, *map(str, (first, count, seed))]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                               env={**os.environ, "PYTHONPATH": str(ROOT)})
    what = "ended the process"
    while process.poll() is None:
        try:
            process.wait(1.0)
        except subprocess.TimeoutExpired:
            if time.time() - at.stat().st_mtime > _PATIENCE:
                process.kill()
                what = "did not end"
    output = process.communicate()[0]
    if process.returncode == 0:
        found = json.loads(output.splitlines()[-1])
        row.add(found["outcomes"], found["slowest"], found["memory"])
        return
    index = int(at.read_text() or first)
    row.add({"taken": 0, what: 1, "before one that did": index - first}, 0.0, 0.0)
    suffix = kinds.suffix(row.kind)
    shutil.copy(folder / f"file{suffix}", folder / "failures" / f"{row.kind.replace(' ', '-')}-{index}{suffix}")


def _write(folder: Path, rows: list[FuzzRow]) -> str:
    cells = [(row.kind, str(row.tried), str(row.outcomes["taken"]), str(row.outcomes["refused"]),
              "; ".join(f"{n} {what}" for what, n in row.outcomes.items() if n and what not in worker.GOOD) or "–",
              f"{row.slowest:.2f}", f"{row.memory:.0f}") for row in rows]
    table = page.Table("Damaged files", ("kind", "files", "taken", "refused", "failed", "slowest, s", "memory, MB"),
                       cells)
    text = ("Each file is a sound one with one to four kinds of damage. It is taken, or refused in one sentence; all "
            "else is a failure. Times are processor time of a file, memory is the most that a process took.",)
    sections = [page.Section("Results", text, tables=[table])]
    return page.write(folder, "fuzz", "What becomes of damaged files", sections,
                      {"rows": [{**vars(row), "outcomes": dict(row.outcomes)} for row in rows]})
