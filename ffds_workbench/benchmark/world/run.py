# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the cases of the world benchmark, each step in a process of its own, so that a crash, a kill or a step without
an end is a row. Rows are kept: a run that was broken off goes on where it was."""
from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ... import ROOT
from ...errors import InputError
from ..pages import page
from . import shapes, tables
from .settings import DEFORMATIONS, ScanSettings, check_deformations

Progress = Callable[[str], None]
Row = dict[str, Any]

LIMIT = 900.0
"""Seconds that one step of a case may take."""
_SUFFIXES = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
_STEPS = ("make", "register", "judge")
_STEP = """
from ffds_workbench import find_freecad
find_freecad.activate()
from ffds_workbench.benchmark.world import stages
stages.main()
"""
_THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")


def run(folder: Path, progress: Progress, parts: Sequence[Path] = (), primitives: bool = False,
        deformations: Sequence[str] = DEFORMATIONS, settings: ScanSettings | None = None, workers: int = 1,
        limit: float = LIMIT) -> str:
    """Measure every model file of some folders, write ``world.json``, ``.md`` and ``.html``; returns the tables.

    Parameters
    ----------
    folder : for the tables; each case is kept in ``cases/FILE/DEFORMATION``, and not measured again
    parts : folders of model files
    primitives : whether FreeCAD's own shapes are made and measured, too
    deformations : some of `DEFORMATIONS`, or bent- and another percentage
    workers : cases at the same time
    limit : seconds that one step of a case may take

    Raises
    ------
    InputError : there is no model file, or a deformation is unknown
    """
    check_deformations(deformations)
    folder = folder.resolve()
    files = [path for part in parts for path in _models(Path(part))]
    if primitives:
        files += _primitives(folder / "primitives")
    if not files:
        raise InputError(f"There is no model file to measure: name a folder of {' '.join(_SUFFIXES)} files with "
                         f"--parts, or take --primitives.")
    jobs = [WorldCase(path, name, settings or ScanSettings(), limit, folder / "cases" / path.name / name)
            for path in sorted(files, key=lambda path: path.stat().st_size) for name in deformations]
    rows: dict[WorldCase, Row] = {}
    _BROKEN_OFF.clear()
    with ThreadPoolExecutor(workers) as pool:
        futures = {pool.submit(job.row): job for job in jobs}
        try:
            for future in as_completed(futures):
                job = futures[future]
                rows[job] = future.result()
                progress(f"Case {len(rows)} of {len(jobs)}: {job.path.name}, {job.deformation}")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            _BROKEN_OFF.set()
            for process in list(_UNDER_WAY):
                process.kill()
            raise
    found = [rows[job] for job in jobs]
    data = {"settings": asdict(settings or ScanSettings()), "lines": [line.as_dict() for line in tables.lines(found)],
            "rows": found}
    return page.write(folder, "world", "Model files of the world", tables.sections(found), data)


@dataclass(frozen=True)
class WorldCase:
    """One case: a model file, a deformation, how it is scanned, and the folder where it is kept."""

    path: Path
    deformation: str
    settings: ScanSettings
    limit: float
    folder: Path

    def row(self) -> Row:
        """What came of the case: the row that is kept, or a new one."""
        kept, job = self.folder / "row.json", {"model": str(self.path), "deformation": self.deformation,
                                               "settings": asdict(self.settings)}
        if kept.is_file():
            row = json.loads(kept.read_text())
            if row["job"] == job:
                return row
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        (self.folder / "job.json").write_text(json.dumps(job))
        row = {"job": job, "file": self.path.name, "deformation": self.deformation, **self._steps()}
        if not _BROKEN_OFF.is_set():
            kept.write_text(json.dumps(row))
        return row

    def _steps(self) -> Row:
        row: Row = {}
        for step in _STEPS:
            end = _process(step, self.folder, self.limit)
            row |= {"step": step, "exit": end.code, "sentence": end.sentence}
            if step == "register":
                row |= {"seconds": end.seconds, "processor": end.processor, "megabytes": end.megabytes}
            for name in ("made", "registered", "judged"):
                if (self.folder / f"{name}.json").is_file():
                    row |= json.loads((self.folder / f"{name}.json").read_text())
            if end.code != 0 or _BROKEN_OFF.is_set():
                break
        return row | {"outcome": tables.outcome(row)}


@dataclass(frozen=True)
class _ProcessEnd:
    """How a process ended: exit code, negative for a signal, None for out of time; the last it said; what it took."""

    code: int | None
    sentence: str
    seconds: float
    processor: float
    megabytes: float


_UNDER_WAY: set[subprocess.Popen[bytes]] = set()
_BROKEN_OFF = threading.Event()
"""Set when a run is broken off: what its steps then end with is no row."""


def _process(step: str, folder: Path, limit: float) -> _ProcessEnd:
    said, begin = folder / f"{step}.txt", time.perf_counter()
    with said.open("wb") as stream:
        process = subprocess.Popen([sys.executable, "-P", "-c", _STEP, step, str(folder)], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=stream, start_new_session=True,
                                   env=os.environ | _THREADS | {"PYTHONPATH": str(ROOT)})
    _UNDER_WAY.add(process)
    late = threading.Event()

    def stop() -> None:
        late.set()
        process.kill()

    timer = threading.Timer(limit, stop)
    timer.start()
    _, status, used = os.wait4(process.pid, 0)
    timer.cancel()
    process.returncode = code = os.waitstatus_to_exitcode(status)
    _UNDER_WAY.discard(process)
    lines = [line for line in said.read_text("utf-8", errors="replace").splitlines() if line.strip()]
    sentence = f"Killed by {signal.Signals(-code).name}." if code < 0 and not late.is_set() else ""
    return _ProcessEnd(None if late.is_set() else code, sentence or (lines[-1] if lines else ""),
                       time.perf_counter() - begin, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def _models(folder: Path) -> list[Path]:
    if not folder.is_dir():
        raise InputError(f"There is no folder {folder}: name one that holds model files.")
    return sorted(path.resolve() for path in folder.iterdir() if path.suffix.lower() in _SUFFIXES)


def _primitives(folder: Path) -> list[Path]:
    """FreeCAD's own shapes as STEP files, which number them anew; those that are there are kept."""
    folder.mkdir(exist_ok=True)
    paths = []
    for name, shape in shapes.primitives():
        paths.append(folder / f"{name.replace(' ', '_')}.step")
        if not paths[-1].is_file():
            shape.exportStep(str(paths[-1]))
    return paths
