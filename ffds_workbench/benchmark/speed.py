# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark speed``: registration of a face against the building of a k-d tree over the same scan."""
from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from .. import ROOT
from ..brep.surface_fit import ParameterBox, approximate
from ..registration.arrays import Array
from ..registration.face import (displacement_lattice, equidistant_grid, nearest_neighbours, register_ffds,
                                 register_robust, solve_lattice)
from ..registration.face_geometry import FaceGeometry
from . import speed_whole
from .interleaved import best_seconds, median_seconds
from .pages import page
from .pages.page import Section, Table
from .simulated import sheet

Progress = Callable[[str], None]

POINTS = 100_000
SIZES = (100_000, 1_000_000, 5_000_000)
_RADIUS, _LENGTH = 20.0, 60.0
_ROUNDS = 4
_ALONE = """
from ffds_workbench import find_freecad
find_freecad.activate()
from ffds_workbench.benchmark.speed import peak_megabytes
print(peak_megabytes({}))
"""


def run(folder: Path, progress: Progress, sizes: tuple[int, ...] = SIZES, repeats: int = 15) -> str:
    """Measure, write speed.json, .md and .html into the folder, and give the tables as Markdown."""
    progress("Builds of a k-d tree, and registrations, in turn")
    builds = _builds(repeats)
    progress("All sizes of the scan, in turn")
    scaling = _scaling(sizes)
    whole = speed_whole.measure(progress) if sizes == SIZES else None
    data = {"points": POINTS, "builds": builds, "scaling": scaling, "whole": whole}
    return page.write(folder, "speed", "Speed", _sections(data), data)


def curved_face() -> FaceGeometry:
    """A full cylinder, R = 20 mm and 60 mm long, seen from outside."""

    def cylinder(u: Array, v: Array) -> Array:
        x, y = _RADIUS * np.cos(u), _RADIUS * np.sin(u)
        return np.stack(np.broadcast_arrays(x[:, None], y[:, None], v[None]), axis=-1)

    turn = 2 * np.pi
    box = ParameterBox(0.0, turn, 0.0, _LENGTH, closed_u=True)
    surface = approximate(cylinder, box, turn * np.arange(1, 8) / 8, np.zeros(0), 4e-6)
    trim = np.array([[0.0, 0.0], [turn, 0.0], [turn, _LENGTH], [0.0, _LENGTH]])
    return FaceGeometry("Cylinder", "Cylinder", surface, (trim,), 1)


def curved_scan(points: int, seed: int = 0) -> Array:
    """A scan of the cylinder moved aside by 1 mm and made oval, σ = 0.13 mm along the radius; (n, 3)."""
    random = np.random.default_rng(seed)
    angle, z = random.uniform((0, 0), (2 * np.pi, _LENGTH), (points, 2)).T
    radius = _RADIUS + np.cos(angle) + 0.5 * np.cos(2 * angle + z / 30) + random.normal(0, sheet.NOISE, points)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)


def _builds(repeats: int) -> dict[str, dict[str, float]]:
    """Median seconds, and the ratio to one build of a k-d tree over the planar scan."""
    face, scan = sheet.nominal(), sheet.scan("A", 0, POINTS)
    curved, curved_points = curved_face(), curved_scan(POINTS)
    seconds = median_seconds({
        "k-d tree": lambda: cKDTree(scan),
        "ffds, plane: neighbours and solve": lambda: _published(face, scan),
        "ffds, plane: whole": lambda: register_ffds(face, scan),
        "robust, plane": lambda: register_robust(face, scan),
        "robust, cylinder": lambda: register_robust(curved, curved_points)}, repeats)
    return {name: {"seconds": value, "builds": value / seconds["k-d tree"]} for name, value in seconds.items()}


def _published(face: FaceGeometry, scan: Array) -> Array:
    """Steps 2 to 4 of the published algorithm: 400 source points, 10 × 10 control points."""
    control = displacement_lattice(face.surface, (10, 10))
    u, v, on_face = equidistant_grid(face, 400)
    source = face.surface.on_grid(u, v)[on_face]
    return solve_lattice(control, u, v, on_face, scan[nearest_neighbours(scan, source)[1]] - source)


def _jobs(count: int) -> dict[str, Callable[[], Any]]:
    """The methods on scans of one size."""
    face, scan = sheet.nominal(), sheet.scan("A", 0, count)
    curved, curved_points = curved_face(), curved_scan(count)
    return {"ffds, plane": lambda: register_ffds(face, scan), "robust, plane": lambda: register_robust(face, scan),
            "robust, cylinder": lambda: register_robust(curved, curved_points)}


def _scaling(sizes: tuple[int, ...]) -> list[dict[str, Any]]:
    """Seconds, the shortest of each, and the peak of memory of a process that has one size alone."""
    jobs = {(count, name): job for count in sizes for name, job in _jobs(count).items()}
    seconds = best_seconds(jobs, _ROUNDS)
    rows = []
    for count in sizes:
        variables = {**os.environ, "PYTHONPATH": str(ROOT)}
        peak = subprocess.run([sys.executable, "-c", _ALONE.format(count)], env=variables, check=True, text=True,
                              stdout=subprocess.PIPE).stdout
        rows.append({"points": count, **{name: seconds[size, name] for size, name in jobs if size == count},
                     "peak_megabytes": float(peak.split()[-1])})
    return rows


def peak_megabytes(count: int) -> float:
    """The peak of this process's memory; the kernel's figure, as ``getrusage`` counts the process that started it."""
    for job in _jobs(count).values():
        job()
    lines = Path("/proc/self/status").read_text("ascii").splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024


def _sections(data: dict[str, Any]) -> list[Section]:
    rows = [[name, f"{1e3 * row['seconds']:.1f}", f"{row['builds']:.2f}"] for name, row in data["builds"].items()]
    builds = Table(f"{data['points']:,} scan points, medians of runs in turn", ["", "ms", "builds"], rows)
    sizes = data["scaling"]
    names = [name for name in sizes[0] if name not in ("points", "peak_megabytes")]
    head = ["scan points", *(f"{name}, ms" for name in names), *(f"{name}, ns per further point" for name in names),
            "peak memory, MB"]
    rows = []
    for k, row in enumerate(sizes):
        further = [f"{_further(sizes[k - 1], row, name):.0f}" if k else "–" for name in names]
        rows.append([f"{row['points']:,}", *(f"{1e3 * row[name]:.0f}" for name in names), *further,
                     f"{row['peak_megabytes']:.0f}"])
    scaling = Table("Time and memory against the size of the scan", head, rows)
    text = ["A build is one `scipy.spatial.cKDTree(scan)` of the same 100,000 points in the same run."]
    scaling_text = ["Times are the shortest of four turns through all sizes: a busy moment of the machine must "
                    "not bend the curve. The peak memory is that of a process with one size alone, its scans included."]
    ratios = Table("Nanoseconds per further point, last step ÷ the one before", ["", "ratio"],
                   [[name, f"{_further(sizes[-2], sizes[-1], name) / _further(sizes[-3], sizes[-2], name):.2f}"]
                    for name in names]
                   if len(sizes) > 2 else [])
    sections = [Section("Against a k-d tree", text, tables=[builds]),
                Section("Scaling", scaling_text, tables=[scaling, ratios])]
    return sections + ([speed_whole.section(data["whole"])] if data["whole"] else [])


def _further(smaller: dict[str, Any], larger: dict[str, Any], name: str) -> float:
    return 1e9 * (larger[name] - smaller[name]) / (larger["points"] - smaller["points"])
