# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast series go: parts an hour against workers, what a part costs beside the bare call, and many parts.

The parts are scans of the example. "Many" are tasks that do nothing: what is measured is what Dask, the index and the
folders take for each.
"""
from __future__ import annotations

import json
import resource
import shutil
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from .. import RESOURCES, api
from ..output import replacing
from ..scan.sensor.files import write_ply
from ..series import folder as layout
from ..series.engine import Queue, connected
from ..series.index import PartIndex
from ..series.scans import ScanFile
from ..series.setup import Outcome, PartJob

_SIGMA = 0.02
"""Noise that is added to the example's scan for each part, in mm (unit)."""


def run(folder: Path, progress: Callable[[str], None], parts: int = 8, workers: Sequence[int] = (1, 2),
        many: Sequence[int] = (1000,)) -> str:
    """Measure, and write ``series_benchmark.json``; the figures as text.

    Parameters
    ----------
    folder : for the results
    progress : called with what is being done
    parts : scans of each series
    workers : numbers of workers
    many : numbers of parts that do nothing
    """
    with tempfile.TemporaryDirectory(prefix="ffds-") as name:
        scratch = Path(name)
        scans = _scans(scratch / "scans", parts)
        progress("Registering by itself")
        alone = _alone(scans[0])
        rows = []
        for count in workers:
            progress(f"{parts} parts, {count} workers")
            rows.append(_series(scans, scratch / f"w{count}", count, alone))
        for row in rows:
            of_one = rows[0]["parts_per_hour"] / rows[0]["workers"]
            row["share_of_one"] = row["parts_per_hour"] / row["workers"] / of_one
        nothing = []
        for count in many:
            progress(f"{count} parts that do nothing")
            nothing.append(_many(scratch / f"m{count}", count))
    record = {"alone": alone, "workers": rows, "many": nothing}
    with replacing(folder / "series_benchmark.json") as (temporary,):
        temporary.write_text(json.dumps(record, indent=1) + "\n", "utf-8")
    return _text(record)


def _scans(folder: Path, count: int) -> list[Path]:
    """The example's scan, each time with other noise."""
    folder.mkdir()
    points = api.read_scan(RESOURCES / "examples" / "bracket_scan.ply").points
    paths = [folder / f"part{number}.ply" for number in range(count)]
    for number, path in enumerate(paths):
        write_ply(path, points + np.random.default_rng(number).normal(0.0, _SIGMA, points.shape))
    return paths


def _alone(scan: Path) -> dict[str, float]:
    """Seconds of the bare calls that ``register`` makes, processor time and elapsed, the second time in a process."""
    model = api.read_model(RESOURCES / "examples" / "bracket.step")
    figures: dict[str, float] = {}
    with tempfile.TemporaryDirectory(prefix="ffds-") as name:
        for label in ("first", "next"):
            start, used = time.perf_counter(), _used()
            result = api.register(model, api.read_scan(scan))
            api.write(result, Path(name) / "b.step", Path(name) / "b.json")
            figures |= {f"{label}_s": time.perf_counter() - start, f"{label}_cpu_s": _used() - used}
    return figures


def _used() -> float:
    """Processor time of this process and of those that it has waited for."""
    own = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in own)


def _series(scans: Sequence[Path], out: Path, workers: int, alone: dict[str, float]) -> dict[str, Any]:
    """One series: elapsed time with all that begins and ends it, and the parts' own; parts an hour are those of all
    workers in the median part's time, without beginning and end."""
    start = time.perf_counter()
    found = api.series(RESOURCES / "examples" / "bracket.step", list(scans), out, workers=workers)
    elapsed = time.perf_counter() - start
    seconds = np.array([part.seconds for part in found.parts])
    usual = float(np.median(seconds))
    return {"workers": workers, "parts": len(scans), "refused": sum(bool(part.exit) for part in found.parts),
            "elapsed_s": elapsed, "part_s": usual, "part_over_alone": usual / alone["next_s"],
            "parts_per_hour": 3600 * workers / usual, "begin_and_end_s": elapsed - float(seconds.sum()) / workers}


def _nothing(folder: Path, job: PartJob) -> Outcome:
    return Outcome(job.scan, job.name, 0)


def _many(out: Path, count: int) -> dict[str, float]:
    """Parts that do nothing: milliseconds of each, elapsed and of this process's processor time, which has client and
    scheduler; and its largest memory before and after."""
    out.mkdir()
    index = PartIndex(out / layout.INDEX)
    start = time.perf_counter()
    jobs = index.add([ScanFile(out / f"part{number}.ply") for number in range(count)])
    added = time.perf_counter() - start
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    with connected(1, None) as client:
        queue = Queue(client, partial(_nothing, out), index.record)
        for job in jobs:
            queue.add(job)
        start, used = time.perf_counter(), time.process_time()
        while queue.left:
            queue.work(1.0)
        elapsed, used = time.perf_counter() - start, time.process_time() - used
    done = sum(code == 0 for _, code in index.names())
    index.close()
    shutil.rmtree(out)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {"parts": count, "done": done, "index_ms": 1e3 * added / count, "part_ms": 1e3 * elapsed / count,
            "scheduler_cpu_ms": 1e3 * used / count,
            "memory_before_mb": before, "memory_after_mb": after}


def _text(record: dict[str, Any]) -> str:
    alone = record["alone"]
    lines = [f"register by itself: {alone['first_s']:.2f} s, again in the same process {alone['next_s']:.2f} s"]
    lines += [f"{row['workers']} workers: {row['parts_per_hour']:.0f} parts/hour, a part {row['part_s']:.2f} s "
              f"({row['part_over_alone']:.0%} of a call), {row['share_of_one']:.0%} of as many single workers; "
              f"beginning and end {row['begin_and_end_s']:.1f} s" for row in record["workers"]]
    lines += [f"{row['parts']} parts that do nothing: {row['part_ms']:.2f} ms each, of which client and scheduler "
              f"compute {row['scheduler_cpu_ms']:.2f} ms; index {row['index_ms']:.3f} ms; "
              f"{row['done']} done; memory {row['memory_before_mb']:.0f} to {row['memory_after_mb']:.0f} MB"
              for row in record["many"]]
    return "\n".join(lines)
