# SPDX-License-Identifier: LGPL-2.1-or-later
"""The thread that hands jobs to Dask, as a series does, for as long as the server runs."""
from __future__ import annotations

import queue
import threading

from ..series import folder as layout
from ..series.engine import Queue, connected
from ..series.setup import Outcome, PartJob
from ..series.worker import do_part
from .jobs import Jobs, ServeJob

_LOOK = 0.2


def do_job(job: PartJob) -> Outcome:
    """What Dask's workers run."""
    assert isinstance(job, ServeJob)
    return do_part(job.setup, PartJob(job.scan, job.name))


class Runner:
    """Jobs under way.

    Parameters
    ----------
    jobs : where they are kept; those that an earlier server has left open are done first
    workers : processes on this machine
    scheduler : address of a Dask scheduler to use instead, or None
    """

    def __init__(self, jobs: Jobs, workers: int, scheduler: str | None) -> None:
        self._jobs, self._where = jobs, (workers, scheduler)
        self._new: queue.SimpleQueue[ServeJob] = queue.SimpleQueue()
        self._end, self._failed = threading.Event(), dict[str, Outcome]()
        for job in jobs.open_ones():
            self._new.put(job)
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """End; jobs that are not done stay open for the next server."""
        self._end.set()
        self._thread.join()

    def add(self, job: ServeJob) -> None:
        """Have a job done."""
        self._new.put(job)

    def failed(self, name: str) -> Outcome | None:
        """What the machine failed at, for a job that this server has given up; the next one tries it again."""
        return self._failed.get(name)

    def _run(self) -> None:
        with connected(*self._where) as client:
            work = Queue(client, do_job, self._ended)
            while not self._end.is_set():
                try:
                    work.add(self._new.get(timeout=0.0 if work.left else _LOOK))
                    while True:
                        work.add(self._new.get_nowait())
                except queue.Empty:
                    pass
                if work.left:
                    work.work(_LOOK)

    def _ended(self, found: Outcome) -> None:
        if layout.outcome(self._jobs.results, found.name) is None:
            self._failed[found.name] = found
