# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``series``: every scan registered to the same model, on Dask, and what they tell together."""
from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from .. import api
from ..errors import InputError
from ..registration.request import RegistrationRequest
from ..report.stopwatch import Progress
from . import folder as layout
from .engine import Queue, connected, distributed, local_workers
from .index import PartIndex
from .part import PreparedSeries, write_places
from .scans import find_scans
from .setup import REFUSED, Outcome, PartJob, SeriesLimits, SeriesSetup
from .summary import write_summary
from .watch import Watch
from .worker import do_part

_LOOK = 1.0
"""Seconds between looks at a watched folder."""


@dataclass(frozen=True)
class Series:
    """A series of parts.

    Attributes
    ----------
    folder : where all of it is
    parts : what became of each, in the order in which they were named
    record : what ``series.json`` holds
    """

    folder: Path
    parts: tuple[Outcome, ...]
    record: dict[str, Any]

    @property
    def exit(self) -> int:
        """0 if all parts were registered, 3 if some were refused."""
        return REFUSED if any(part.exit for part in self.parts) else 0

    def table(self) -> str:
        """The series as text."""
        done = [part for part in self.parts if not part.exit]
        lines = [f"{len(done)} of {len(self.parts)} parts registered"]
        lines += [f"{part.name:<24}{part.said}" for part in self.parts if part.exit]
        return "\n".join([*lines, *self.record["told"]])


def series(model: str | Path, scans: Sequence[str | Path], out: str | Path, faces: Sequence[str] | None = None,
           progress: Progress = lambda text: None, *, label: str | None = None, scan_unit: str = "mm",
           workers: int | None = None, scheduler: str | None = None, resume: bool = False,
           watch: str | Path | None = None, limits: SeriesLimits | None = None, plan: str | Path | None = None,
           **settings: Any) -> Series:
    """Register a scan after the other, each a part of its own, on all processors or on a cluster.

    ``api.series("bracket.step", ["scans"], "out").exit`` is 0 if all of them were registered.

    Parameters
    ----------
    model : file of the nominal model
    scans : files, folders, patterns and lists, see `find_scans`
    out : folder for the results; a part's are in a folder of its own
    faces : as for ``api.register``
    progress : called with what is being done
    label : of the object in a FreeCAD document that holds several
    scan_unit : of the scans
    workers : processes on this machine; by its processors and its memory where it is None
    scheduler : address of a Dask scheduler to use instead
    resume : go on with a series that was interrupted
    watch : folder whose files are taken as they come, until a file STOP is there
    limits : what one part may take
    plan : file of an inspection plan that every part is held against
    settings : as for ``api.register``

    Raises
    ------
    InputError : the model, a scan's name, a setting or the folder cannot be used, or Dask is missing
    RefusedError : the disk is full
    """
    request = api.as_request(faces, **settings)
    return run_series(request, Path(model), scans, Path(out), progress, label, scan_unit, workers, scheduler, resume,
                      watch, limits, None if plan is None else Path(plan))


def run_series(request: RegistrationRequest, model: Path, scans: Sequence[str | Path], out: Path, progress: Progress,
               label: str | None, scan_unit: str, workers: int | None, scheduler: str | None, resume: bool,
               watch: str | Path | None, limits: SeriesLimits | None, plan: Path | None) -> Series:
    """Do what `series` is asked for, with a request at hand."""
    distributed("a series")
    if not scans and watch is None:
        raise InputError("No scan was named: name files, folders, patterns or lists, or a folder to watch.")
    watched = None if watch is None else Watch(Path(watch))
    found = find_scans(scans)
    count, share = local_workers(workers)
    limits = limits or SeriesLimits()
    if limits.memory is None and scheduler is None and share < float("inf"):
        limits = replace(limits, memory=share)
    setup = SeriesSetup(model, label, scan_unit, request, out, limits, plan)
    progress(f"Reading {model}")
    prepared = PreparedSeries(setup)  # and says what is wrong with the model or the faces' names
    setup = setup.absolute()
    index, lock = _opened(setup, resume)
    try:
        write_places(prepared)
        jobs = index.add(found)
        _work(setup, jobs, index, watched, (count, scheduler), progress)
        progress("Finding what the series tells")
        record = write_summary(setup.folder, index.parts(), prepared.places.places)
        return Series(out, tuple(part for part, _ in index.parts()), record)
    finally:
        index.close()
        layout.clear_work(setup.folder)
        if lock is not None:
            lock.close()


def _opened(setup: SeriesSetup, resume: bool) -> tuple[PartIndex, Any]:
    """The index of a new series, or of one that goes on; it says what the folders say."""
    path = setup.folder / layout.INDEX
    if path.exists() and not resume:
        raise InputError(f"{setup.folder} holds a series already: go on with it by --resume, or choose another folder.")
    layout.make(setup.folder)
    lock = layout.locked(setup.folder)
    layout.clear_work(setup.folder)
    index = PartIndex(path)
    digest, known = setup.digest(), index.about("digest")
    if known is not None and known != digest:
        index.close()
        raise InputError(f"The series in {setup.folder} was made with another model or other options: use the same, or "
                         f"choose another folder.")
    index.keep("digest", digest)
    for name, code in index.names():
        standing = layout.outcome(setup.folder, name)
        if standing is not None:
            index.record(standing)
        elif code is not None:
            index.forget([name])
    index.flush()
    return index, lock


def _work(setup: SeriesSetup, jobs: Sequence[PartJob], index: PartIndex, watched: Watch | None,
          where: tuple[int, str | None], progress: Progress) -> None:
    """Have all parts done, and those that are still to come."""
    if not jobs and watched is None:
        return
    pace = Pace(progress)
    progress("Starting the workers")
    with connected(min(where[0], len(jobs)) if watched is None else where[0], where[1]) as client:

        def ended(found: Outcome) -> None:
            index.record(found)
            pace.ended(found)

        queue = Queue(client, partial(do_part, setup), ended)
        for job in jobs:
            queue.add(job)
        pace.tell(queue.left)
        while queue.left or (watched is not None and not watched.ended):
            for job in [] if watched is None else index.add(watched.new()):
                queue.add(job)
            queue.work(_LOOK)
            pace.tell(queue.left)


class Pace:
    """Says how many parts are done, how many an hour that is, and when the last one will be."""

    def __init__(self, progress: Progress, clock: Callable[[], float] = time.monotonic) -> None:
        self._progress, self._clock, self._start = progress, clock, clock()
        self._done = self._refused = 0

    def ended(self, found: Outcome) -> None:
        """Count a part."""
        self._done += 1
        self._refused += bool(found.exit)

    def tell(self, left: int) -> None:
        """Say where it stands."""
        text = f"{self._done} of {self._done + left} parts"
        if self._refused:
            text += f", {self._refused} refused"
        if self._done:
            seconds = (self._clock() - self._start) / self._done
            text += f"; {3600 / max(seconds, 1e-9):.0f} parts/hour, {_duration(seconds * left)} left"
        self._progress(text)


def _duration(seconds: float) -> str:
    minutes = round(seconds / 60)
    return f"{seconds:.0f} s" if seconds < 90 else f"{minutes} min" if minutes < 90 else f"{minutes / 60:.1f} h"
