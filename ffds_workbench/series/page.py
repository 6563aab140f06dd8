# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of a series."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..report.page import Step, page
from . import folder as layout

_MOST_ROWS = 500


def series_page(name: str, record: Mapping[str, Any]) -> str:
    """The page's text; it links to what lies beside it."""
    parts = record["parts"]
    done = sum(part["exit"] == 0 for part in parts)
    steps = [Step("Parts", f"{done} of {len(parts)} registered.", _parts(record), None,
                  [layout.SERIES, "parts.csv", layout.INDEX])]
    if record["mean"] is not None:
        steps.append(Step("What the parts have in common, and how they scatter",
                          "Means over the parts; standard deviations of the parts, of the measurement and of the "
                          "process, in mm.", _owners(record["mean"]["owners"]), None, [layout.MEAN]))
    if record["told"]:
        steps.append(Step("What the series tells", "Shapes in which the parts differ, what changes, and parts unlike "
                                                   "the others.", "\n".join(record["told"])))
    return page(f"Series {name}", "One model, many scans: each part registered by itself.", steps)


def _parts(record: Mapping[str, Any]) -> str:
    rows = [f"{part['name']:<28}{part['seconds']:>8.1f} s  {part['said'] or 'registered'}" for part in record["parts"]]
    more = [f"… and {len(rows) - _MOST_ROWS} more in parts.csv"] if len(rows) > _MOST_ROWS else []
    return "\n".join([*rows[:_MOST_ROWS], *more])


def _owners(owners: list[Mapping[str, Any]]) -> str:
    lines = [f"{'':<12}{'mean':>10}{'parts':>10}{'measured':>10}{'process':>10}   95 % interval"]
    for owner in owners:
        figures = "".join(f"{'–' if owner[name] is None else format(owner[name], '.4f'):>10}"
                          for name in ("mean", "total", "measurement", "process"))
        interval = owner["interval"]
        lines.append(f"{owner['name']:<12}{figures}   "
                     + ("" if interval is None else f"{interval[0]:.4f} to {interval[1]:.4f}"))
    return "\n".join(lines)
