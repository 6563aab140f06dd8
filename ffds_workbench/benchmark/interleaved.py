# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fair timing: the competitors take turns, so that a busy moment of the machine hits all of them.

The smaller of elapsed and processor time counts: the former is too long where other processes use the processor, the
latter where a library works on several cores.
"""
from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Mapping
from typing import Any, TypeVar

import numpy as np

Name = TypeVar("Name", bound=Hashable)


def median_seconds(jobs: Mapping[Name, Callable[[], Any]], repeats: int = 20) -> dict[Name, float]:
    """Median time of each job in seconds, each run ``repeats`` times in turn after one run to warm up."""
    return {name: float(np.median(values)) for name, values in _times(jobs, repeats).items()}


def best_seconds(jobs: Mapping[Name, Callable[[], Any]], repeats: int) -> dict[Name, float]:
    """The same, the shortest time of each: for long jobs."""
    return {name: min(values) for name, values in _times(jobs, repeats).items()}


def timed(job: Callable[[], Any]) -> tuple[Any, float]:
    """What the job returns, and its time in seconds."""
    start, start_cpu = time.perf_counter(), time.process_time()
    result = job()
    return result, min(time.perf_counter() - start, time.process_time() - start_cpu)


def _times(jobs: Mapping[Name, Callable[[], Any]], repeats: int) -> dict[Name, list[float]]:
    times: dict[Name, list[float]] = {name: [] for name in jobs}
    for turn in range(repeats + 1):
        for name, job in jobs.items():
            seconds = timed(job)[1]
            if turn:
                times[name].append(seconds)
    return times
