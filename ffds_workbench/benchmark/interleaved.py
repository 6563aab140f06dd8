# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fair timing: the competitors take turns, so that a busy moment of the machine hits all of them."""
from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Mapping
from typing import Any, TypeVar

import numpy as np

Name = TypeVar("Name", bound=Hashable)


def median_seconds(jobs: Mapping[Name, Callable[[], Any]], repeats: int = 20) -> dict[Name, float]:
    """Median wall time of each job in seconds, each run ``repeats`` times in turn after one run to warm up."""
    return {name: float(np.median(values)) for name, values in _times(jobs, repeats).items()}


def best_cpu_seconds(jobs: Mapping[Name, Callable[[], Any]], repeats: int) -> dict[Name, float]:
    """The same in seconds of processor time, the shortest of each: for long jobs on a machine that has others too."""
    return {name: min(values) for name, values in _times(jobs, repeats, time.process_time).items()}


def _times(jobs: Mapping[Name, Callable[[], Any]], repeats: int,
           clock: Callable[[], float] = time.perf_counter) -> dict[Name, list[float]]:
    times: dict[Name, list[float]] = {name: [] for name in jobs}
    for turn in range(repeats + 1):
        for name, job in jobs.items():
            start = clock()
            job()
            if turn:
                times[name].append(clock() - start)
    return times
