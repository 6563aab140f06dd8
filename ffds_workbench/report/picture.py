# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture of the deviation: the scan over the part's edges, coloured by its distance from the model.

Drawn by matplotlib from arrays alone. The part is seen from the side that was scanned, in parallel projection.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .statistics import statistics

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PathCollection

Array = NDArray[np.float64]

_MOST_POINTS = 60_000
COLOURS = ("#27348b", "#2f7fc8", "#7cc4cf", "#8dbd8b", "#f0cf5b", "#e8792f", "#a8122a")
_INK, _MUTED, _PAPER = "#1d2733", "#6b7785", "#ffffff"
_LEGEND_INCHES = 1.34
"""Width that the colour scale takes with its words, right of the panels."""
_BEFORE, _AFTER = "#c2703d", "#2b6cb0"


@dataclass(frozen=True)
class Panel:
    """One state of the model.

    Attributes
    ----------
    title : shown above
    points, normals : (n, 3), the scan points that lie on the model, in mm, and the model's outward normals there
    deviations : (n,) signed, in mm, of these points
    edges : polylines of the model, each (k, 3) in mm
    """

    title: str
    points: Array
    normals: Array
    deviations: Array
    edges: Sequence[Array]


def draw(path: Path, title: str, panels: Sequence[Panel]) -> None:
    """Write the picture as PNG.

    Parameters
    ----------
    path : a new file
    title : one line, the part and the scan
    panels : one, or before and after
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    limit = _colour_limit(panels)
    axes_in_view = viewing_axes(panels[0].normals)
    width = 6.4 * len(panels) + 0.6
    right = 1.0 - _LEGEND_INCHES / width
    figure = Figure(figsize=(width, 7.6), dpi=130, facecolor=_PAPER)
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(2, len(panels), height_ratios=(3.6, 1.0), left=0.06, right=right, top=0.87, bottom=0.09,
                               hspace=0.16, wspace=0.06)
    figure.text(0.06, 0.95, title, fontsize=15, color=_INK, weight="bold", va="center")
    boxes = _common_box(panels, axes_in_view)
    for column, panel in enumerate(panels):
        axes = figure.add_subplot(grid[0, column])
        coloured = _draw_view(axes, panel, axes_in_view, limit, boxes)
    legend = figure.add_axes((right + 0.2 / width, 0.36, 0.2 / width, 0.48))
    legend.grid(False)  # whatever the user's settings of matplotlib say
    bar = figure.colorbar(coloured, cax=legend, extend="both")
    bar.set_label("deviation, mm (+ outside the material)", color=_INK, fontsize=10)
    bar.outline.set_visible(False)
    bar.ax.tick_params(colors=_MUTED, labelsize=9, length=0)
    _draw_histogram(figure.add_subplot(grid[1, :]), panels, limit)
    figure.savefig(path, format="png")


def _colour_limit(panels: Sequence[Panel]) -> float:
    """Half the colour scale: nearly all of the worse state, rounded to a readable number."""
    size = max(float(np.percentile(np.abs(panel.deviations), 97)) for panel in panels)
    size = max(size, 1e-6)
    step = 10.0 ** np.floor(np.log10(size))
    return float(np.ceil(size / step * 2) / 2 * step)


def viewing_axes(normals: Array) -> Array:
    """Rows right, up and towards the viewer, (3, 3), for a view on the side that the ``normals`` (n, 3) face."""
    return axes_towards(side_of(normals))


def side_of(normals: Array) -> Array:
    """From the part to a viewer of the side that the ``normals`` (n, 3) face, a little askew: (3,), of length 1."""
    towards = normals.mean(axis=0)
    if np.linalg.norm(towards) < 0.2:
        towards = np.array([0.6, -0.9, 0.7])
    towards = towards / np.linalg.norm(towards) + np.array([0.28, -0.22, 0.18])
    return towards / np.linalg.norm(towards)


def axes_towards(towards: Array) -> Array:
    """Rows right, up and towards the viewer, (3, 3), where ``towards`` (3,) has length 1."""
    up = np.array([0.0, 0.0, 1.0]) if abs(towards[2]) < 0.93 else np.array([0.0, 1.0, 0.0])
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(towards, right), towards])


def _common_box(panels: Sequence[Panel], view: Array) -> tuple[Array, Array]:
    everything = np.concatenate([part for panel in panels for part in (panel.points, *panel.edges)]) @ view[:2].T
    low, high = everything.min(axis=0), everything.max(axis=0)
    margin = 0.03 * (high - low).max()
    return low - margin, high + margin


def _draw_view(axes: Axes, panel: Panel, view: Array, limit: float, box: tuple[Array, Array]) -> PathCollection:
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap

    points = panel.points
    chosen = np.arange(len(points))
    if len(points) > _MOST_POINTS:
        chosen = np.random.default_rng(0).choice(len(points), _MOST_POINTS, replace=False)
    seen = points[chosen] @ view.T
    order = np.argsort(seen[:, 2])
    size = float(np.clip(60_000 / len(chosen), 1.2, 14.0))
    axes.add_collection(LineCollection([line @ view[:2].T for line in panel.edges], colors=_INK, linewidths=0.7,
                                       alpha=0.75, zorder=3))
    colours = LinearSegmentedColormap.from_list("deviation", COLOURS)
    coloured = axes.scatter(*seen[order, :2].T, c=panel.deviations[chosen][order], s=size, cmap=colours, vmin=-limit,
                            vmax=limit, linewidths=0, zorder=2)
    axes.set(xlim=(box[0][0], box[1][0]), ylim=(box[0][1], box[1][1]), aspect="equal")
    axes.set_axis_off()
    figures = statistics(panel.deviations)
    assert figures is not None
    axes.set_title(f"{panel.title}\n", fontsize=12, color=_INK, loc="left", weight="bold")
    axes.text(0.0, 1.02, f"|deviation|: mean {figures.mean:.3f} mm, 95 % below {figures.p95:.3f} mm",
              transform=axes.transAxes, fontsize=10, color=_MUTED)
    _scale_bar(axes, box)
    return coloured


def _scale_bar(axes: Axes, box: tuple[Array, Array]) -> None:
    width = box[1][0] - box[0][0]
    step = 10.0 ** np.floor(np.log10(width / 4))
    length = next(step * factor for factor in (5, 2, 1) if step * factor <= width / 4)
    x, y = box[1][0] - length - 0.02 * width, box[0][1] + 0.015 * width
    axes.plot([x, x + length], [y, y], color=_INK, linewidth=1.6, solid_capstyle="butt", zorder=4)
    axes.text(x + length / 2, y + 0.01 * width, f"{length:g} mm", ha="center", va="bottom", fontsize=9, color=_INK)


def _draw_histogram(axes: Axes, panels: Sequence[Panel], limit: float) -> None:
    bins = np.linspace(-1.3 * limit, 1.3 * limit, 131)
    for panel, colour in zip(panels, (_BEFORE, _AFTER) if len(panels) > 1 else (_AFTER,), strict=True):
        share = np.full(len(panel.deviations), 100.0 / len(panel.deviations))
        axes.hist(panel.deviations, bins, weights=share, histtype="stepfilled",
                  facecolor=colour, alpha=0.45, edgecolor=colour, linewidth=1.2, label=panel.title.lower())
    axes.axvline(0.0, color=_INK, linewidth=0.8)
    axes.set_xlim(bins[0], bins[-1])
    axes.set_xlabel("deviation, mm", fontsize=10, color=_INK)
    axes.set_ylabel("% of points", fontsize=10, color=_INK)
    axes.tick_params(colors=_MUTED, labelsize=9)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(_MUTED)
    axes.legend(frameon=False, fontsize=10, loc="upper right", labelcolor=_INK)
