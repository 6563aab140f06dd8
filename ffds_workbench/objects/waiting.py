# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long work is waited for, with progress and Cancel. Objects know no GUI; the GUI registers itself here."""
from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from ..report.stopwatch import Progress

_waiter: str | None = None


def wait_with(module: str) -> None:
    """Name the module whose ``computing(label, work)`` waits for work; imported when first needed."""
    global _waiter
    _waiter = module


def wait_for(label: str, work: Callable[[Progress | None], Any]) -> Any:
    """The value of ``work(progress)``: computed here, or in a window in the background, with a Cancel button.

    Recomputes stay in step: this returns when the work is done.

    Parameters
    ----------
    label : of the object that is computed
    work : touches no document

    Raises
    ------
    RefusedError : the user pressed Cancel
    Exception : whatever the work raised
    """
    if _waiter is None:
        return work(None)
    return importlib.import_module(_waiter).computing(label, work)
