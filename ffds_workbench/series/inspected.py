# SPDX-License-Identifier: LGPL-2.1-or-later
"""The characteristics of an inspection plan over the parts of a series: verdicts, capability, charts and changes."""
from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ..inspection.output import FILES
from ..registration.arrays import Array
from .told import capability, ewma_chart, find_change, means_chart, scatter_chart


def characteristics(folder: Path, names: Sequence[str]) -> list[dict[str, Any]]:
    """What a plan's items come to over parts, as JSON has it.

    Parameters
    ----------
    folder : of the series
    names : of the parts that were inspected

    Returns
    -------
    one entry per item, in the plan's order; empty where there was no plan
    """
    found = [json.loads((folder / name / FILES[0]).read_text("utf-8"))["items"] for name in names
             if (folder / name / FILES[0]).is_file()]
    return [_characteristic(items, names) for items in zip(*found, strict=True)]


def _characteristic(items: Sequence[Mapping[str, Any]], names: Sequence[str]) -> dict[str, Any]:
    first, values = items[0], np.array([item["value"] for item in items])
    bands = np.array([np.nan if item["band"] is None else item["band"] for item in items])
    able, change = capability(values, first["lower"], first["upper"]), find_change(values)
    return {"name": first["name"], "characteristic": first["characteristic"], "lower": first["lower"],
            "upper": first["upper"], "values": dict(zip(names, values.tolist(), strict=True)),
            "verdicts": dict(Counter(item["verdict"] for item in items)),
            "band": None if np.isnan(bands).all() else float(np.nanmean(bands)),
            "capability": None if able is None else asdict(able),
            "change": None if change is None else asdict(change) | {"part": names[change.at]}, "charts": charts(values)}


def charts(figures: Array) -> dict[str, Any]:
    """The control charts of a run of figures (n,), as JSON has them."""
    found = {chart.name: chart for chart in (means_chart(figures), scatter_chart(figures), ewma_chart(figures))
             if chart is not None}
    return {name: {"values": chart.values.tolist(), "centre": chart.centre, "low": chart.low.tolist(),
                   "high": chart.high.tolist(), "signals": chart.signals} for name, chart in found.items()}


def sentences(found: Sequence[Mapping[str, Any]]) -> list[str]:
    """The characteristics in words."""
    lines = []
    for item in found:
        counts = ", ".join(f"{count} {verdict}" for verdict, count in item["verdicts"].items())
        line = f"{item['name']}: {counts}"
        if item["capability"] is not None:
            low, high = item["capability"]["cpk_interval"]
            line += f"; Cpk {item['capability']['cpk']:.2f} ({low:.2f} to {high:.2f})"
        if item["change"] is not None:
            line += f"; changes at {item['change']['part']}"
        lines.append(f"{line}.")
    return lines
