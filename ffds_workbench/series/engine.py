# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts on Dask: as many under way as keep every worker busy, each ended once, however often the machine fails."""
from __future__ import annotations

import importlib
import importlib.util
import logging
import os
import queue
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from ..errors import InputError, RefusedError
from .setup import REFUSED, Outcome, PartJob

_AHEAD = 4
"""Parts per worker that wait beside the one under way: a worker never waits for its scheduler."""
_TRIES = 3
"""How often a part is tried that the machine fails."""
_LIVES = 10
"""Workers that may die under a part before it is given up: who kills them at random seldom hits one part so often."""
_PER_PART = 1 << 30
"""Bytes that a worker and its part may take at least (physical: FreeCAD and a part of 50 faces take half)."""
_SHARE = 0.8
"""Of the free memory that the workers may have together."""
_CONNECT = 10.0
_MISSING = ("Dask is not installed, and {what} needs it: install it (Debian: python3-distributed), or run "
            "./ffds setup.")


def distributed(what: str) -> Any:
    """Dask's library (InputError, which names what needs it, where it is not installed)."""
    try:
        return importlib.import_module("distributed")
    except ImportError as error:
        raise InputError(_MISSING.format(what=what)) from error


def local_workers(wanted: int | None) -> tuple[int, float]:
    """How many workers this machine bears, by its processors and its memory, and bytes for each of them.

    Raises
    ------
    InputError : a number below one was wanted
    """
    if wanted is not None and wanted < 1:
        raise InputError(f"{wanted} workers make no sense: one is the least.")
    try:
        free = float(importlib.import_module("psutil").virtual_memory().available)
    except ImportError:
        free = float("inf")
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    count = wanted or int(max(1, min(cores, _SHARE * free // _PER_PART)))
    return count, _SHARE * free / count


@contextmanager
def connected(workers: int, scheduler: str | None) -> Iterator[Any]:
    """A client of a cluster on this machine, or of a scheduler elsewhere.

    Parameters
    ----------
    workers : processes of a cluster on this machine
    scheduler : address of another one's scheduler, or None

    Raises
    ------
    InputError : Dask is missing, or there is nobody at the address
    """
    dask = distributed("a series")
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    settings = {"distributed.scheduler.allowed-failures": _LIVES, "distributed.worker.memory.terminate": False,
                "distributed.worker.memory.pause": False, "distributed.comm.timeouts.connect": _CONNECT}
    with importlib.import_module("dask.config").set(settings):
        if scheduler is not None:
            try:
                client = dask.Client(scheduler, timeout=_CONNECT, set_as_default=False)
            except (OSError, ValueError) as error:
                raise InputError(f"No scheduler answers at {scheduler}: start one with dask-scheduler, and workers "
                                 f"with dask-worker, where FFDS is on PYTHONPATH.") from error
            with client:
                yield client
            return
        with (dask.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=_dashboard(),
                                silence_logs=logging.CRITICAL, security=_private()) as cluster,
              dask.Client(cluster, set_as_default=False) as client):
            yield client


def _dashboard() -> str | None:
    """Dask's own page, where the library that draws it is installed."""
    return "127.0.0.1:0" if importlib.util.find_spec("bokeh") else None


def _private() -> Any:
    """Keys that only this cluster knows, so that no other user of the machine gives it work."""
    with suppress(ImportError):
        importlib.import_module("cryptography")
        return importlib.import_module("distributed.security").Security.temporary()
    return None


class Queue:
    """Parts on a cluster, from when they are taken to when they have ended.

    Parameters
    ----------
    client : of Dask
    do : what is done with a part, in a worker
    ended : called with every outcome, once for a part
    """

    def __init__(self, client: Any, do: Callable[[PartJob], Outcome], ended: Callable[[Outcome], None]) -> None:
        self._client, self._do, self._ended = client, do, ended
        self._back: queue.SimpleQueue[tuple[PartJob, Any]] = queue.SimpleQueue()
        self._waiting: deque[PartJob] = deque()
        self._tries: dict[str, int] = {}
        self._under_way: dict[str, Any] = {}

    @property
    def left(self) -> int:
        """Parts that have not ended."""
        return len(self._waiting) + len(self._under_way)

    @property
    def workers(self) -> int:
        """Workers that the scheduler has now."""
        return len(self._client.scheduler_info()["workers"])

    def add(self, job: PartJob) -> None:
        """Take a part."""
        self._waiting.append(job)

    def work(self, seconds: float) -> None:
        """Hand parts out and wait for one to end, for so long at most."""
        room = max(1, self.workers) * (1 + _AHEAD) - len(self._under_way)
        for _ in range(min(room, len(self._waiting))):
            self._hand_out(self._waiting.popleft())
        with suppress(queue.Empty):
            self._take(*self._back.get(timeout=seconds))
            while True:
                self._take(*self._back.get_nowait())

    def _hand_out(self, job: PartJob) -> None:
        tries = self._tries[job.name] = self._tries.get(job.name, 0) + 1
        future = self._client.submit(self._do, job, key=f"part-{job.name}-{tries}-{id(self)}", pure=False)
        self._under_way[job.name] = future
        future.add_done_callback(lambda done: self._back.put((job, done)))

    def _take(self, job: PartJob, future: Any) -> None:
        del self._under_way[job.name]
        found = _outcome(job, future)
        if not found.final and self._tries[job.name] < _TRIES:
            self._waiting.append(job)
            return
        self._tries.pop(job.name)
        self._ended(found)


def _outcome(job: PartJob, future: Any) -> Outcome:
    """What became of a part that Dask is done with."""
    try:
        return future.result()
    except Exception as error:  # of Dask, of the network, of a worker: the machine's
        said = RefusedError(f"The cluster gave it up ({type(error).__name__}: {str(error)[:200]}).")
        return Outcome(job.scan, job.name, REFUSED, str(said), final=False)
