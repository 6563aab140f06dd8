# SPDX-License-Identifier: LGPL-2.1-or-later
"""The check for Boolean operations of an as-built part: it continues after the part is there, and is noted when it
ends.

Objects know no GUI; the GUI registers itself here. Without a GUI the check is waited for.
"""
from __future__ import annotations

import importlib
import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .. import api

RUNNING, LOST = "running", "broken off"

_follower: str | None = None


def follow_with(module: str) -> None:
    """Name the module whose ``follow(item, result)`` calls `note` when the check has ended; imported when needed."""
    global _follower
    _follower = module


def follow(item: Any, result: api.Result) -> None:
    """See to it that the outcome of a result's check is noted in its object, now or later."""
    if _follower is None or result.checks.done:
        note(item, result)
    else:
        importlib.import_module(_follower).follow(item, result)


def note(item: Any, result: api.Result) -> None:
    """Write the outcome into the object, which is up to date afterwards if it was before; waits for the check."""
    touched = "Touched" in item.State
    item.Report = json.dumps(result.report)
    item.BooleanCheck = check_verdict(result)
    if not touched:
        item.purgeTouched()


def check_verdict(result: api.Result) -> str:
    """What the check found, in words; waits for it."""
    before, after = (side.boolean_errors for side in (result.certificate.before, result.certificate.after))
    if after is None:
        return "not finished in time"
    if after == 0:
        return "no errors"
    return f"{after} errors, {'an unknown number' if before is None else before} before"
