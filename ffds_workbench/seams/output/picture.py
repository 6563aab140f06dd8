# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture of the seam report: the seams on the part, and their figures along the arc length."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...registration.arrays import Array
from ..measured import MeasuredSeam, SeamLimits
from ..plan import SeamPlan

_INK, _MUTED, _PAPER, _PART = "#1d2733", "#6b7785", "#ffffff", "#b9c2cb"
_LINES = ("#2b6cb0", "#c2703d", "#4b8a55")
_PASS, _FAIL, _UNJUDGED, _LIMIT = "#2b6cb0", "#b3202c", "#1d2733", "#b3202c"
_UNSEEN = {"bridged": "#f7e7b4", "carried": "#f3cfa6", "nominal": "#dfe3e8"}
_PAUSE = 0.04
"""Space between two seams along the axis, as a share of their length together."""
_MOST_LABELS = 24
_LEAST_RANGE = 0.05


@dataclass(frozen=True)
class _Curve:
    """One line of a plot: its name, its limit, and its values at a seam's stations (None where unknown)."""

    name: str
    limit: float
    values: Callable[[MeasuredSeam], Array | None]


def draw(path: Path, plan: SeamPlan) -> None:
    """Write the picture as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    plots = [(title, curves) for title, curves in _plots(plan.limits) if _known(plan.seams, curves)]
    plots = plots or [("opening, °", [_Curve("opening", np.inf, lambda seam: np.degrees(seam.stations.opening))])]
    figure = Figure(figsize=(14.5, 7.4), dpi=120, facecolor=_PAPER)
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(len(plots), 2, width_ratios=(1.0, 1.25), left=0.02, right=0.985, top=0.86, bottom=0.1,
                               hspace=0.3, wspace=0.12)
    total = sum(seam.stations.length for seam in plan.seams)
    title = f"{len(plan.seams)} weld seam{'s' * (len(plan.seams) != 1)}, {total:.0f} mm"
    figure.text(0.02, 0.95, title, fontsize=15, color=_INK, weight="bold", va="center")
    figure.text(0.02, 0.905, _verdict_line(plan), fontsize=10.5, color=_MUTED, va="center")
    _draw_part(figure.add_subplot(grid[:, 0]), plan)
    starts = _starts(plan.seams)
    first = None
    for row, (label, curves) in enumerate(plots):
        axes = figure.add_subplot(grid[row, 1], sharex=first)
        first = first or axes
        _draw_plot(axes, label, curves, plan, starts)
        axes.tick_params(labelbottom=row == len(plots) - 1)
    _number_seams(first, plan.seams, starts)
    axes.set_xlabel("along the seams, mm", fontsize=10, color=_INK)
    figure.savefig(path, format="png")


def _plots(limits: SeamLimits) -> list[tuple[str, list[_Curve]]]:
    def of_offsets(name: str, degrees: bool = False) -> Callable[[MeasuredSeam], Array | None]:
        def values(seam: MeasuredSeam) -> Array | None:
            if seam.offsets is None:
                return None
            found = getattr(seam.offsets, name)
            return np.degrees(found) if degrees else found
        return values

    return [("offset, mm", [_Curve(name, getattr(limits, name), of_offsets(name))
                                         for name in ("lateral", "normal", "longitudinal")]),
            ("gap, mm", [_Curve("gap", limits.gap, lambda seam: seam.stations.gap)]),
            ("change, °", [_Curve("opening", limits.opening, of_offsets("opening_change", True)),
                                    _Curve("torch frame", limits.rotation, of_offsets("rotation", True))]),
            ("95 % band, mm", [_Curve("band", np.inf, lambda seam: seam.bands)])]


def _known(seams: Sequence[MeasuredSeam], curves: Sequence[_Curve]) -> bool:
    values = [curve.values(seam) for seam in seams for curve in curves]
    return any(found is not None and np.isfinite(found).any() for found in values)


def _verdict_line(plan: SeamPlan) -> str:
    judged = [seam for seam in plan.seams if seam.largest()]
    failed = [seam for seam in judged if seam.exceeded(plan.limits)]
    if not judged:
        return "nothing to compare: no nominal model and no joint of two parts"
    unseen = sum(bool(seam.doubts) for seam in plan.seams)
    text = f"{len(judged) - len(failed)} of {len(judged)} within the limits"
    return text + (f", {unseen} not wholly observed by the scan" if unseen else "")


def _starts(seams: Sequence[MeasuredSeam]) -> Array:
    """Where each seam begins on the common axis."""
    lengths = np.array([seam.stations.length for seam in seams])
    return np.concatenate([[0.0], np.cumsum(lengths[:-1] + _PAUSE * lengths.sum())])


def _draw_plot(axes: Any, label: str, curves: Sequence[_Curve], plan: SeamPlan, starts: Array) -> None:
    for curve, colour in zip(curves, _LINES, strict=False):
        found = [(start, seam, curve.values(seam)) for start, seam in zip(starts, plan.seams, strict=True)]
        shown = [(start + seam.stations.places.arc_length, values) for start, seam, values in found
                 if values is not None]
        for number, (along, values) in enumerate(shown):
            axes.plot(along, values, color=colour, linewidth=1.5, label=curve.name if number == 0 else None, zorder=3)
    largest = max((float(np.nanmax(np.abs(some))) for seam in plan.seams for curve in curves
                   if (some := curve.values(seam)) is not None and np.isfinite(some).any()), default=0.0)
    for limit in {curve.limit for curve in curves if curve.limit <= 3.0 * largest}:
        for level in (limit, -limit):
            axes.axhline(level, color=_LIMIT, linewidth=0.9, linestyle=(0, (4, 3)), zorder=1)
    axes.axhline(0.0, color=_MUTED, linewidth=0.7, zorder=1)
    for start, seam in zip(starts, plan.seams, strict=True):
        _shade_unseen(axes, start, seam)
    low, high = axes.get_ylim()
    least = _LEAST_RANGE - (high - low)
    if least > 0.0:
        axes.set_ylim(low - 0.5 * least, high + 0.5 * least)
    axes.set_ylabel(label, fontsize=9.5, color=_INK)
    axes.tick_params(colors=_MUTED, labelsize=9)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(_MUTED)
    if len(curves) > 1:
        axes.legend(frameon=False, fontsize=9, ncols=len(curves), labelcolor=_INK,
                    bbox_to_anchor=(1.0, 1.0), loc="lower right", borderaxespad=0.2)


def _shade_unseen(axes: Any, start: float, seam: MeasuredSeam) -> None:
    if not seam.reported:
        return
    along = start + seam.stations.places.arc_length
    for before, after, flag in zip(along[:-1], along[1:], seam.flags[:-1].tolist(), strict=True):
        if flag in _UNSEEN:
            axes.axvspan(before, after, color=_UNSEEN[flag], linewidth=0, zorder=0)


def _number_seams(axes: Any, seams: Sequence[MeasuredSeam], starts: Array) -> None:
    if len(seams) > _MOST_LABELS:
        return
    for number, (start, seam) in enumerate(zip(starts, seams, strict=True), 1):
        name = seam.name if len(seams) <= 4 and len(seam.name) < 28 else str(number)
        axes.annotate(name, (start + 0.5 * seam.stations.length, 1.0), xycoords=("data", "axes fraction"), ha="center",
                      xytext=(0, 24), textcoords="offset points", fontsize=9, color=_INK, annotation_clip=False)


def _draw_part(axes: Any, plan: SeamPlan) -> None:
    from matplotlib.collections import LineCollection

    out = -np.concatenate([seam.stations.bisector[:, :, 2] for seam in plan.seams]).mean(axis=0)
    view = _view(out)
    part = [np.array([tuple(point) for point in edge.discretize(40)]) for edge in plan.shape.Edges
            if not edge.Degenerated]
    axes.add_collection(LineCollection([line @ view[:2].T for line in part], colors=_PART, linewidths=0.8))
    for number, seam in enumerate(plan.seams, 1):
        colour = _UNJUDGED if not seam.largest() else _FAIL if seam.exceeded(plan.limits) else _PASS
        line = seam.stations.positions @ view[:2].T
        dotted = (0, (2, 1.2)) if seam.doubts else "solid"
        axes.plot(*line.T, color=colour, linewidth=2.6, linestyle=dotted, zorder=3)
        axes.plot(*line[0], marker="o", color=colour, markersize=5, zorder=4)
        _arrow(axes, line, colour)
        if len(plan.seams) <= _MOST_LABELS:
            axes.annotate(str(number), line[len(line) // 2], xytext=(4, 4), textcoords="offset points", fontsize=9.5,
                          color=_INK, weight="bold", zorder=5)
    everything = np.concatenate(part) @ view[:2].T
    margin = 0.06 * np.ptp(everything, axis=0).max()
    (x0, y0), (x1, y1) = everything.min(axis=0) - margin, everything.max(axis=0) + margin
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
    axes.set_axis_off()
    _legend(axes, plan)


def _arrow(axes: Any, line: Array, colour: str) -> None:
    """The direction of travel, a quarter along the seam."""
    at = max(1, len(line) // 4)
    axes.annotate("", line[at], xytext=line[at - 1], zorder=4,
                  arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 0, "mutation_scale": 15})


def _legend(axes: Any, plan: SeamPlan) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries = [(_PASS, "solid", "within the limits"), (_FAIL, "solid", "beyond a limit"),
               (_UNJUDGED, "solid", "nothing to compare")]
    used = {_UNJUDGED if not seam.largest() else _FAIL if seam.exceeded(plan.limits) else _PASS for seam in plan.seams}
    handles = [Line2D([], [], color=colour, linewidth=2.6, linestyle=style, label=text)
               for colour, style, text in entries if colour in used]
    if any(seam.doubts for seam in plan.seams):
        handles.append(Line2D([], [], color=_MUTED, linewidth=2.6, linestyle=(0, (2, 1.2)),
                              label="not wholly observed"))
    flags = {flag for seam in plan.seams if seam.reported for flag in seam.flags.tolist()}
    handles += [Patch(color=colour, label=flag) for flag, colour in _UNSEEN.items() if flag in flags]
    handles.append(Line2D([], [], color=_MUTED, marker="o", linestyle="none", markersize=5, label="start"))
    axes.legend(handles=handles, frameon=False, fontsize=9, loc="upper left", labelcolor=_INK,
                ncols=min(4, len(handles)), bbox_to_anchor=(0.0, -0.01), borderaxespad=0.0, handlelength=1.8,
                columnspacing=1.4)


def _view(towards: Array) -> Array:
    """Rows right, up and towards the viewer, (3, 3): the seams seen from the torch, slightly from the side."""
    if np.linalg.norm(towards) < 0.2:
        towards = np.array([0.6, -0.9, 0.7])
    towards = towards / np.linalg.norm(towards) + np.array([0.35, -0.3, 0.3])
    towards /= np.linalg.norm(towards)
    up = np.array([0.0, 0.0, 1.0]) if abs(towards[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(towards, right), towards])
