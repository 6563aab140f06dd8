# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures 6 and 9 of the paper as plots: time over source points, accuracy over control points."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes

from ..pages import style
from .paper_figures import PUBLISHED_ACCURACY, PUBLISHED_TIMES
from .paper_methods import TITLES

Row = dict[str, Any]

_TIMES = (("ffd_hsu_s", "FFD-HSU, dense", "ffd_hsu", "-"), ("ffds_dense_s", "FFDS, dense", "ffds", "--"),
          ("ffds_s", "FFDS, Kronecker", "ffds", "-"))


def times(rows: Sequence[Row], case: str, folder: Path, name: str) -> str:
    """Solve time over source points; returns the PNG's name."""
    drawing = style.figure(6.4, 4.4)
    axes = drawing.subplots()
    count = [row["source_points"] for row in rows]
    for key, label, method, line in _TIMES:
        axes.loglog(count, [1e3 * row[key] for row in rows], line, color=style.COLOURS[method], label=label,
                    marker=style.MARKERS[method], markersize=4.5)
    for key, seconds in PUBLISHED_TIMES[case].items():
        method = "ffd_hsu" if "hsu" in key else "ffds"
        axes.plot(400, 1e3 * seconds, marker="*", markersize=11, color="none", markeredgecolor=style.COLOURS[method],
                  label=f"published, {TITLES[method]}", linestyle="none")
    axes.set(xlabel="source points", ylabel="solve in ms (median)",
             title=f"Time over source points, N = 10, {case} case")
    axes.set_xticks([36, 100, 400, 900, 2500], ["36", "100", "400", "900", "2500"])
    axes.minorticks_off()
    axes.legend(fontsize=8.5)
    return style.save(drawing, folder, name)


def accuracies(rows: Sequence[Row], case: str, folder: Path, name: str) -> str:
    """Accuracy over N and over the total of control points, in the paper's metric and as the truth; the PNG's name."""
    drawing = style.figure(10.5, 7.4)
    grid = drawing.subplots(2, 2, sharey="row")
    for row_of_axes, (key, what) in zip(grid, (("paper_metric", "paper's metric in mm"),
                                               ("true_mean", "true mean distance in mm")), strict=True):
        for axes, total in zip(row_of_axes, (False, True), strict=True):
            _curves(axes, rows, key, total)
            if key == "paper_metric":
                _marks(axes, rows, case, total)
        row_of_axes[0].set_ylabel(what)
    grid[1, 0].set_xlabel("N, control points per direction")
    grid[1, 1].set_xlabel("control points in all (N² or N³)")
    drawing.suptitle(f"Accuracy over control points, 400 source points, {case} case", fontsize=12)
    handles, labels = grid[0, 1].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=4, fontsize=9)
    return style.save(drawing, folder, name)


def _curves(axes: Axes, rows: Sequence[Row], key: str, total: bool) -> None:
    for method in ("ffd_hsu", "ffds", "robust"):
        n = [row["control_points_per_direction"] for row in rows]
        x = [k ** (3 if method == "ffd_hsu" else 2) for k in n] if total else n
        axes.plot(x, [row[method][key] for row in rows], color=style.COLOURS[method], marker=style.MARKERS[method],
                  markersize=8 if method == "ffd_hsu" else 4, linewidth=3 if method == "ffd_hsu" else 1.5,
                  markerfacecolor="none" if method == "ffd_hsu" else None, label=TITLES[method])
    axes.set_yscale("log")
    if total:
        axes.set_xscale("log")
        axes.set_xticks([16, 64, 216, 1000, 8000], ["16", "64", "216", "1000", "8000"])
        axes.minorticks_off()
    else:
        axes.set_xticks(range(4, 21, 2))


def _marks(axes: Axes, rows: Sequence[Row], case: str, total: bool) -> None:
    """The metric's floor, what a perfect result reaches, and what the paper states."""
    axes.axhline(rows[0]["ffds"]["floor"], color=style.SOFT, linestyle=":", label="floor 0.5/√density")
    axes.axhline(rows[0]["ffds"]["perfect"], color=style.INK, linestyle="--", linewidth=1,
                 label="a perfect result on this T")
    for method, (count, value) in PUBLISHED_ACCURACY[case].items():
        x = count if total else round(count ** (1 / 3 if method == "ffd_hsu" else 1 / 2))
        axes.plot(x, value, marker="*", markersize=12, color="none", markeredgecolor=style.COLOURS[method],
                  linestyle="none", label=f"published, {TITLES[method]}")
