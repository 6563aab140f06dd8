# SPDX-License-Identifier: LGPL-2.1-or-later
"""The seam report: a record for JSON, and a table for people. Lengths in mm, angles in degrees."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..measured import MeasuredSeam, SeamLimits

_FIGURES = ("lateral", "normal", "longitudinal", "gap", "opening", "rotation")
_HEADS = ("seam", "joint", "length", "stations", *_FIGURES, "band", "observed", "verdict")


def seam_record(seam: MeasuredSeam, limits: SeamLimits) -> dict[str, Any]:
    """One entry of the report's ``seams``; what is unknown is None."""
    largest = seam.largest()
    known = np.isfinite(seam.bands)
    return {"name": seam.name, "joint": seam.stations.seam.kind, "closed": seam.stations.seam.closed,
            "length": seam.stations.length, "stations": len(seam.stations),
            "largest": {name: largest.get(name) for name in _FIGURES},
            "band": float(seam.bands[known].max()) if known.any() else None,
            "observed": seam.observed, "verdict": verdict(seam, limits), "exceeded": seam.exceeded(limits),
            "doubt": seam.doubts}


def report_record(seams: Sequence[MeasuredSeam], limits: SeamLimits, notes: Sequence[str]) -> dict[str, Any]:
    """The whole report."""
    return {"seams": [seam_record(seam, limits) for seam in seams], "limits": dict(vars(limits)), "notes": list(notes)}


def verdict(seam: MeasuredSeam, limits: SeamLimits) -> str | None:
    """"pass" or "fail"; None where there is nothing to compare."""
    if not seam.largest():
        return None
    return "fail" if seam.exceeded(limits) else "pass"


def table_text(seams: Sequence[MeasuredSeam], limits: SeamLimits) -> str:
    """One line per seam, with the largest absolute offsets, gap and changes of angle."""
    rows = [_HEADS] + [_row(seam_record(seam, limits)) for seam in seams]
    widths = [max(len(row[column]) for row in rows) for column in range(len(_HEADS))]
    return "\n".join("  ".join(cell.ljust(width) if column < 2 else cell.rjust(width)
                               for column, (cell, width) in enumerate(zip(row, widths, strict=True))) for row in rows)


def _row(record: dict[str, Any]) -> tuple[str, ...]:
    largest = record["largest"]
    verdict_text = "-" if record["verdict"] is None else record["verdict"]
    if record["exceeded"]:
        verdict_text += ": " + ", ".join(record["exceeded"])
    lengths = [_number(largest[name], "mm") for name in _FIGURES[:4]]
    angles = [_number(largest[name], "°") for name in _FIGURES[4:]]
    observed = "-" if record["observed"] is None else f"{record['observed']:.0%}"
    return (record["name"], record["joint"] + (", closed" if record["closed"] else ""), f"{record['length']:.1f} mm",
            str(record["stations"]), *lengths, *angles, _number(record["band"], "mm"), observed, verdict_text)


def _number(value: float | None, unit: str) -> str:
    return "-" if value is None else f"{value:.2f} {unit}" if unit == "mm" else f"{value:.2f}{unit}"
