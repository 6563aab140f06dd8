# SPDX-License-Identifier: LGPL-2.1-or-later
"""Many scans of one part: registered on Dask, a process for every worker, and what they tell together.

`job` is the whole of it. What is to be done: `scans` finds the files, `watch` those that are still to come. How:
`engine` hands parts out, `worker` runs in Dask's processes with a process beside it, `part_process` on this side and
`part_server` on the other, and `part` does the work there. What is kept: `folder` has a place for every part, `index`
is the table of them; `places` and `summary` make of the parts what the series tells, with the mathematics in `told/`.
"""
from __future__ import annotations

from typing import Any

__all__ = ["Series", "SeriesLimits", "series"]


def __getattr__(name: str) -> Any:
    """What is loaded when it is first asked for (PEP 562): Dask's processes need none of it."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import job, setup

    return setup.SeriesLimits if name == "SeriesLimits" else getattr(job, name)
