#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the figures of resources/docs/theory.md into resources/docs/theory/: the published algorithm, what closest
points do to it, and the bands of the example part.

    resources/scripts/theory_figures.py [FOLDER]
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from ffds_workbench import api
from ffds_workbench.benchmark.pages import style
from ffds_workbench.benchmark.paper_study import paper_pictures
from ffds_workbench.benchmark.paper_study.paper_case import virtual_case
from ffds_workbench.benchmark.simulated import sheet
from ffds_workbench.registration.face import register_ffds, register_robust

PART, SCAN = ROOT / "resources/examples/bracket.step", ROOT / "resources/examples/bracket_scan.ply"


def bias(folder: Path) -> None:
    """A section through the sheet: heights that closest points give, and those of the medians of cells."""
    cloud, face = sheet.scan("A", 0), sheet.nominal()
    x = np.linspace(0, sheet.SIZE[0], 400)
    place = np.stack([x, np.full(len(x), sheet.SIZE[1] / 2)], axis=1)
    drawing = style.figure(8.5, 3.2)
    axes = drawing.add_subplot()
    for name, found in (("ffds", register_ffds(face, cloud)), ("robust", register_robust(face, cloud))):
        moved = face.surface(place) + found.displacement(place)
        axes.plot(x, moved[:, 2] - sheet.height(moved[:, 0], moved[:, 1]), color=style.COLOURS[name],
                  label={"ffds": "closest points (published)", "robust": "cells of the raster (robust)"}[name])
    axes.axhline(0, color=style.SOFT, linewidth=0.8)
    axes.set(xlabel="x in mm, along y = 35 mm", ylabel="deviation from the truth, mm",
             title="Noise 0.13 mm: the closest point is the one that the noise has moved towards the source")
    axes.legend()
    style.save(drawing, folder, "bias")


def bands(folder: Path) -> None:
    """Half widths of the 95 % bands on the faces of the example, by what was known of each place."""
    result = api.register(api.read_model(PART), api.read_scan(SCAN))
    drawing = style.figure(8.5, 3.2)
    axes = drawing.add_subplot()
    faces = result.joint.faces
    widths, flags = (np.concatenate([getattr(face, name) for face in faces]) for name in ("bands", "flags"))
    edges = np.geomspace(max(widths.min(), 1e-3), widths.max(), 50)
    for flag, colour in (("observed", "#009e73"), ("bridged", "#0072b2"), ("carried", "#d55e00")):
        axes.hist(widths[flags == flag], edges, histtype="step", color=colour, label=flag, linewidth=1.5)
    axes.set(xscale="log", yscale="log", xlabel="half width of the 95 % band, mm", ylabel="places",
             title="The example: how sure the as-built part is")
    axes.legend()
    style.save(drawing, folder, "bands")


def draw(folder: Path) -> None:
    """Write all figures."""
    folder.mkdir(parents=True, exist_ok=True)
    paper_pictures.before_and_after(virtual_case(), folder, "published")
    bias(folder)
    bands(folder)
    for drawing in folder.glob("*.svg"):  # thousands of points each, which a picture of pixels shows as well
        drawing.unlink()


if __name__ == "__main__":
    draw(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "resources/docs/theory")
