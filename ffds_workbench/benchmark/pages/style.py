# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the benchmarks' pictures look: one colour per method, distinguishable without colour vision."""
from __future__ import annotations

from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

COLOURS = {"ffds": "#0072b2", "ffd_hsu": "#d55e00", "robust": "#009e73"}
MARKERS = {"ffds": "o", "ffd_hsu": "s", "robust": "D"}
INK, SOFT, SHEET, CLOUD = "#1b1f24", "#8a939c", "#c8d3dd", "#7f9cb5"

_SETTINGS = {"font.size": 10, "axes.titlesize": 11, "axes.labelsize": 10, "axes.grid": True, "grid.color": "#e3e7eb",
             "axes.edgecolor": SOFT, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
             "svg.fonttype": "none", "figure.dpi": 110}


def figure(width: float, height: float) -> Figure:
    """An empty figure of that size in inches."""
    matplotlib.rcParams.update(_SETTINGS)
    return Figure(figsize=(width, height), layout="constrained")


def save(drawing: Figure, folder: Path, name: str) -> str:
    """Write NAME.png and NAME.svg; returns the PNG's name."""
    drawing.savefig(folder / f"{name}.png", dpi=150, bbox_inches="tight")
    drawing.savefig(folder / f"{name}.svg", bbox_inches="tight")
    return f"{name}.png"
