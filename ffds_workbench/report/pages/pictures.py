# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of a scene from chosen sides, by matplotlib: for the report's page and its PDF."""
from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

from ...registration.arrays import Array
from ..picture import COLOURS, axes_towards
from .scene import ColouredPart

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

_INK, _GREY = "#1d2733", "#b4bac2"
_STATES = (("before", "Nominal part"), ("after", "As-built part"))


def picture(scene: ColouredPart, towards: Array) -> bytes:
    """A PNG of the map before and after, seen from a side.

    Parameters
    ----------
    towards : (3,), from the part to the viewer
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.6), dpi=110, facecolor="white")
    FigureCanvasAgg(figure)
    draw(figure, scene, towards)
    memory = io.BytesIO()
    figure.savefig(memory, format="png")
    return memory.getvalue()


def draw(figure: Figure, scene: ColouredPart, towards: Array,
         box: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)) -> None:
    """Draw the map before and after, with its scale, into a box (left, bottom, width, height) of a figure."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    left, bottom, width, height = box
    colours = LinearSegmentedColormap.from_list("deviation", COLOURS)
    scale = ScalarMappable(Normalize(-scene.limit, scene.limit), colours)
    for column, (state, title) in enumerate(_STATES):
        axes = figure.add_axes((left + 0.45 * column * width, bottom, 0.43 * width, 0.93 * height))
        _draw_state(axes, scene, getattr(scene, state), axes_towards(towards), scale)
        axes.set_title(title, fontsize=10, color=_INK, loc="left")
    legend = figure.add_axes((left + 0.915 * width, bottom + 0.15 * height, 0.016 * width, 0.65 * height))
    legend.grid(False)  # whatever the user's settings of matplotlib say
    bar = figure.colorbar(scale, cax=legend, extend="both")
    bar.set_label("deviation, mm", fontsize=8, color=_INK)
    bar.ax.tick_params(labelsize=8)


def _draw_state(axes: Axes, scene: ColouredPart, values: Array, view: Array, scale: ScalarMappable) -> None:
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.colors import to_rgba

    seen = scene.points @ view.T
    corners = seen[scene.triangles]
    shown = values[scene.triangles].mean(axis=1)
    order = np.argsort(corners[:, :, 2].mean(axis=1))
    known = np.isfinite(shown)
    colours = scale.to_rgba(np.nan_to_num(shown))
    colours[~known] = to_rgba(_GREY)
    axes.add_collection(PolyCollection(corners[order, :, :2], facecolors=colours[order], edgecolors=colours[order],
                                       linewidths=0.3, rasterized=True))
    depth = float(np.ptp(seen[:, 2])) or 1.0
    lines = [line @ view.T for line in scene.edges]
    nearest = seen[:, 2].max()
    axes.add_collection(LineCollection([line[:, :2] for line in lines], colors=_INK, linewidths=[
        0.8 if nearest - line[:, 2].mean() < 0.5 * depth else 0.25 for line in lines]))
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    margin = 0.03 * (high - low).max()
    axes.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin), aspect="equal")
    axes.set_axis_off()
