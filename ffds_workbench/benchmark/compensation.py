# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark compensation``: a press whose parts spring back by a known law, and the tools made for it.

The law depends on the shape of the tool, so that no tool is right at once: every part opens by a share of how far its
tool is bent. Each trial scans the parts of a tool, makes the next tool from them alone, and is judged by the law.
"""
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import Part

from .. import RESOURCES, api
from ..brep import workpiece
from ..brep.continuity import side_lengths
from ..registration.arrays import Array
from ..registration.trims import inside_polylines
from .pages import page
from .pages.page import Section, Table

Progress = Callable[[str], None]
Row = dict[str, Any]

_TRIALS, _NOISE = 5, 0.05
"""Tools, one after the other, and standard deviation of the scan's noise in mm (unit)."""
_SPRINGBACK, _RESPONSE = 2.0, 0.15
"""Largest spring-back of the nominal tool in mm, and the share of a change of the tool that springs back besides
(unit)."""
_PARTS, _SCATTER = 5, 0.3
"""Parts of one tool, and the standard deviation in mm at the end of the part by which each bends differently (unit)."""
_SPACING = 0.9
"""Distance of the scan points in mm (unit)."""


def run(folder: Path, progress: Progress) -> str:
    """Measure, and write ``compensation.json``, ``compensation.md`` and ``compensation.html``; returns the tables."""
    nominal = api.read_model(RESOURCES / "examples" / "bracket.step").shape
    trials, scatter = iterated(nominal, _TRIALS, progress), from_several(nominal, progress)
    tables = [Table("Distance of the part of each tool from the nominal model",
                    ["trial", "mean, mm", "p95, mm", "max, mm"],
                    [[str(row["trial"]), *(f"{row[key]:.4f}" for key in ("mean", "p95", "max"))] for row in trials]),
              Table("What the mean part of a tool is off", ["made from", "max, mm"],
                    [[row["parts"], f"{row['max']:.4f}"] for row in scatter])]
    sections = [Section("A press that springs back", [f"Spring-back {_SPRINGBACK:g} mm, {_RESPONSE:.0%} of a change of "
                                                      f"the tool besides, noise {_NOISE:g} mm."], tables=tables[:1]),
                Section("Parts that scatter", [f"{_PARTS} parts with {_SCATTER:g} mm scatter."], tables=tables[1:])]
    return page.write(folder, "compensation", "Compensation", sections, {"trials": trials, "scatter": scatter})


def iterated(nominal: Part.Shape, trials: int, progress: Progress, spacing: float = _SPACING) -> list[Row]:
    """Trial after trial, each tool made from the one before and one part that came out of it: how far parts are off."""
    press, rows, tool = Press(nominal, spacing), [], nominal
    for trial in range(trials + 1):
        progress(f"Compensation: trial {trial}")
        off = np.abs(press.deviation(tool))
        rows.append({"trial": trial, "mean": float(off.mean()), "p95": float(np.percentile(off, 95)),
                     "max": float(off.max())})
        if trial < trials:
            scan = press.scan(tool, 0.0, trial)
            tool = api.compensate(nominal, [scan], previous=None if tool is nominal else tool, isometry="off").shape
    return rows


def from_several(nominal: Part.Shape, progress: Progress, spacing: float = _SPACING) -> list[Row]:
    """Tools made from one of several parts that scatter, and one from the mean of all; judged by the part that scatters
    by nothing."""
    press = Press(nominal, spacing, response=0.0)
    random = np.random.default_rng(5)
    scans = [press.scan(nominal, bend, seed) for seed, bend in enumerate(random.normal(0, _SCATTER, _PARTS))]

    def off(parts: list[Array]) -> float:
        progress(f"Compensation: from {len(parts)} of {_PARTS} parts")
        return float(np.abs(press.deviation(api.compensate(nominal, parts, isometry="off").shape)).max())

    single = np.array([off([scan]) for scan in scans])
    return [{"parts": "one, rms of five", "max": float(np.sqrt((single**2).mean()))},
            {"parts": "the mean of five", "max": off(scans)}]


class Press:
    """What comes out of a tool: its shape, sprung back."""

    def __init__(self, nominal: Part.Shape, spacing: float, response: float = _RESPONSE) -> None:
        self._response = response
        self._part = workpiece.read(nominal)
        self._uv = [_spread(face, spacing) for face in self._part.faces]
        self._nominal = self._points(self._part)
        self._normal = np.concatenate([_normals(face, uv) for face, uv in zip(self._part.faces, self._uv, strict=True)])
        box = nominal.BoundBox
        self._middle, self._reach = box.XMin + 0.5 * box.XLength, 0.5 * box.XLength

    def _points(self, part: workpiece.Workpiece) -> Array:
        """Places on all faces of a tool, (n, 3) in mm, the same at every tool."""
        return np.concatenate([face.at(uv) for face, uv in zip(part.faces, self._uv, strict=True)])

    def _sprung(self, points: Array, bend: float) -> Array:
        """Where points of a tool spring back to; ``bend`` more in mm at the ends."""
        s = (points[:, 0] - self._middle) / self._reach
        lift = (_SPRINGBACK + bend) * s**2
        return points + np.stack([-0.2 * lift, 0.1 * lift, lift], axis=1)

    def _part_of(self, tool: Part.Shape, bend: float) -> Array:
        """The part that comes out of a tool at its places, (n, 3) in mm."""
        places = self._points(workpiece.read(tool))
        return self._sprung(places, bend) - self._response * (places - self._nominal)

    def deviation(self, tool: Part.Shape) -> Array:
        """Of the part that comes out of a tool from the nominal one, across the nominal faces, (n,) in mm."""
        return np.einsum("nx,nx->n", self._part_of(tool, 0.0) - self._nominal, self._normal)

    def scan(self, tool: Part.Shape, bend: float, seed: int) -> Array:
        """A scan of a part of a tool, (n, 3) in mm."""
        points = self._part_of(tool, bend)
        return points + np.random.default_rng(seed).normal(0.0, _NOISE, points.shape)


def _normals(face: workpiece.WorkpieceFace, uv: Array) -> Array:
    """Unit normals of a face at parameters (n, 2): (n, 3)."""
    surface = face.surface
    across = np.cross(surface.derivative(1, 0)(uv), surface.derivative(0, 1)(uv))
    return across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)


def _spread(face: workpiece.WorkpieceFace, spacing: float) -> Array:
    """Parameters (n, 2) on a face, about evenly spaced."""
    box = face.box
    counts = [max(2, int(length / spacing)) for length in side_lengths(face)]
    u, v = ((np.arange(count) + 0.5) / count for count in counts)
    uv = np.stack(np.meshgrid(box.u0 + u * (box.u1 - box.u0), box.v0 + v * (box.v1 - box.v0), indexing="ij"), axis=-1)
    uv = uv.reshape(-1, 2)
    return uv[inside_polylines(face.trims, uv)]
