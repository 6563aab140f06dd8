# SPDX-License-Identifier: LGPL-2.1-or-later
"""What Dask's workers run: a part goes to the process beside the worker, and what that leaves undone is settled here.

A worker loads neither FreeCAD nor the mathematics, so that it answers its scheduler whatever a part does.
"""
from __future__ import annotations

import threading
import time

from ..errors import FfdsError, InputError
from . import folder
from .part_process import PartProcess
from .setup import REFUSED, Outcome, PartJob, SeriesSetup

_lock = threading.Lock()
_known: list[PartProcess] = []


def do_part(setup: SeriesSetup, job: PartJob) -> Outcome:
    """Have a part done; it ends as a result, as a refusal, or, where the machine is to blame, as not final."""
    start = time.monotonic()
    with _lock:
        standing = folder.outcome(setup.folder, job.name)
        if standing is not None:
            return standing
        try:
            fates = []
            for _ in range(2):  # what a process died of may have been the machine's fault; twice, it is the scan's
                process = _process(setup)
                found = process.do(job)
                if found is not None:
                    return _settled(setup, found)
                fates.append(process.fate)
                _forget()
            said = f"The process that registered it died twice ({', '.join(fates)}): the scan may be damaged."
            return _settled(setup, Outcome(job.scan, job.name, REFUSED, said, time.monotonic() - start))
        except InputError as error:
            if not setup.checked:
                return _settled(setup, Outcome(job.scan, job.name, error.exit_code, str(error)))
            return Outcome(job.scan, job.name, REFUSED, f"The machine failed: {error}", time.monotonic() - start, False)
        except (FfdsError, OSError) as error:
            return Outcome(job.scan, job.name, REFUSED, f"The machine failed: {error}", time.monotonic() - start, False)


def _settled(setup: SeriesSetup, found: Outcome) -> Outcome:
    """Deliver what the process could not: that it was ended."""
    if not found.final or folder.outcome(setup.folder, found.name) is not None:
        return found
    _forget()
    return folder.deliver(setup.folder, found)


def _process(setup: SeriesSetup) -> PartProcess:
    if _known and _known[0].setup != setup:
        _forget()
    if not _known:
        _known.append(PartProcess(setup))
    return _known[0]


def _forget() -> None:
    """End the process; the next part gets a new one."""
    while _known:
        _known.pop().end()
