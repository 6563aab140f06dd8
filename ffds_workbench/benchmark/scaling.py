# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark scaling``: time and memory over scan points, lattice sizes and faces."""
from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np
import Part
from scipy.spatial import cKDTree

from .. import api
from ..errors import RefusedError
from ..registration.arrays import Array
from ..registration.face import register_ffd, register_ffds, register_robust
from .interleaved import best_seconds, median_seconds, timed
from .pages import page, style
from .pages.page import Picture, Section, Table
from .simulated.sheet import NOISE, nominal, scan

Progress = Callable[[str], None]
Row = dict[str, Any]

POINTS = (10_000, 30_000, 100_000, 300_000, 1_000_000, 2_000_000, 5_000_000)
LATTICES = (10, 14, 20, 30, 50, 70, 100)
FACES = (1, 4, 16, 49, 100, 196)
_LATTICE_POINTS = 100_000
_ROUNDS = 4
_LARGEST_VOLUME = 30
_POINTS_PER_FACE = 2_000
_TILE = 20.0
_NAMES = {"ffds": "ffds, N = 10", "robust": "robust", "kdtree": "k-d tree build", "read": "reading the array"}


def run(folder: Path, progress: Progress) -> str:
    """Measure, and write ``scaling.json``, ``scaling.md``, ``scaling.html`` and pictures; returns the tables."""
    return write(folder, over_points(progress), over_lattices(progress), over_faces(progress))


def write(folder: Path, points: list[Row], lattices: list[Row], faces: list[Row]) -> str:
    """Write the tables and the picture of what was measured; returns the tables."""
    further = further_point(points)
    data = {"points": points, "lattices": lattices, "faces": faces, "ns_per_further_point": further,
            "exponents": {"points": _exponents(points, "points", _NAMES),
                          "lattices": _exponents(lattices, "control_points", ("ffds", "robust", "ffd_hsu")),
                          "faces": _exponents(faces, "faces", ("register", "rebuild", "total"))}}
    return page.write(folder, "scaling", "Scaling", _sections(folder, data), data)


def over_points(progress: Progress) -> list[Row]:
    """Seconds and peak memory of the methods on one face over the number of scan points.

    All sizes take turns, and the shortest time counts: a busy moment of the machine must not bend the curve.
    """
    face = nominal()
    scans = {count: scan("A", 1, count) for count in POINTS}
    jobs: dict[str, Callable[[], Any]] = {}
    for count, points in scans.items():
        jobs |= {f"ffds {count}": partial(register_ffds, face, points, (10, 10), 400),
                 f"robust {count}": partial(register_robust, face, points),
                 f"kdtree {count}": partial(cKDTree, points),
                 f"read {count}": points.sum}
    progress(f"Scaling: {POINTS[0]:,} to {POINTS[-1]:,} points")
    seconds = best_seconds(jobs, _ROUNDS)
    rows: list[Row] = []
    for count in POINTS:
        row: Row = {"points": count, **{name: seconds[f"{name} {count}"] for name in _NAMES}}
        rows.append(row | {f"{name}_mb": peak_megabytes(jobs[f"{name} {count}"]) for name in ("ffds", "robust")})
    return rows


def over_lattices(progress: Progress) -> list[Row]:
    """Seconds over the lattice size, 100k points; four source points per control point where the method takes some."""
    face, points = nominal(), scan("A", 1, _LATTICE_POINTS)
    rows = []
    for n in LATTICES:
        progress(f"Scaling: lattice {n} × {n}")
        jobs: dict[str, Callable[[], Any]] = {
            "ffds": partial(register_ffds, face, points, (n, n), 4 * n * n),
            "robust": partial(register_robust, face, points, (n, n))}
        if n <= _LARGEST_VOLUME:
            jobs["ffd_hsu"] = partial(register_ffd, face, points, (n, n), 4 * n * n)
        row: Row = {"lattice": n, "control_points": n * n}
        for name, job in jobs.items():
            try:
                row |= median_seconds({name: job}, 3)
            except RefusedError as error:
                row[f"{name}_refused"] = str(error)
        rows.append(row)
    return rows


def over_faces(progress: Progress) -> list[Row]:
    """Seconds of a whole registration, by stage, over the number of connected faces of a shell."""
    rows = []
    for count in FACES:
        progress(f"Scaling: {count} faces")
        shape, points = tiles(round(np.sqrt(count)))
        start = time.perf_counter()
        result, seconds = timed(partial(_registered, shape, points))
        share = seconds / (time.perf_counter() - start)      # of the elapsed time, which the stages are given in
        stages = {stage: share * value for stage, value in result.report["timing"].items()}
        rows.append({"faces": count, "points": len(points), **stages, "total": seconds})
    return rows


def _registered(shape: Part.Shape, points: Array) -> api.Result:
    result = api.register(shape, points)
    _ = result.deviations
    return result


def tiles(side: int) -> tuple[Part.Shape, Array]:
    """A flat shell of side × side square faces that share their edges, and a scan of it after a smooth warp."""
    squares = [Part.makePlane(_TILE, _TILE, FreeCAD.Vector(i * _TILE, j * _TILE, 0))
               for i in range(side) for j in range(side)]
    shape = squares[0].fuse(squares[1:]).Shells[0] if side > 1 else squares[0]
    rng = np.random.default_rng(side)
    xy = rng.uniform(0, side * _TILE, (_POINTS_PER_FACE * side**2, 2))
    z = 0.8 * np.sin(xy[:, 0] / 25) * np.cos(xy[:, 1] / 30) + rng.normal(0, NOISE, len(xy))
    return shape, np.column_stack([xy, z])


def peak_megabytes(job: Callable[[], Any]) -> float:
    """Largest memory that the job allocates at a time, in MB, its input not counted."""
    tracemalloc.start()
    try:
        job()
        return tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()


def further_point(rows: Sequence[Row]) -> dict[str, dict[str, float]]:
    """Nanoseconds per further point, from 100k to 1M and from 1M to 5M, and their ratio."""
    at = {row["points"]: row for row in rows}
    result = {}
    for name in _NAMES:
        first = (at[1_000_000][name] - at[100_000][name]) / 9e5 * 1e9
        second = (at[5_000_000][name] - at[1_000_000][name]) / 4e6 * 1e9
        result[name] = {"from_100k_to_1m": first, "from_1m_to_5m": second, "ratio": second / first}
    return result


def _exponents(rows: Sequence[Row], over: str, names: Any) -> dict[str, float]:
    """Slope of log time over log size, fitted to the upper half of the sizes, where set-up no longer counts."""
    result = {}
    for name in names:
        pairs = np.array([(row[over], row[name]) for row in rows if name in row])
        upper = np.log(pairs[len(pairs) // 2 :])
        if len(upper) > 1:
            result[name] = float(np.polyfit(upper[:, 0], upper[:, 1], 1)[0])
    return result


def _sections(folder: Path, data: dict[str, Any]) -> list[Section]:
    further, exponents = data["ns_per_further_point"], data["exponents"]
    points = Table("One face over the number of scan points: best of four; MB beyond the input",
                   ("points", *(f"{title}, ms" for title in _NAMES.values()), "ffds, MB", "robust, MB",
                    "ffds ÷ k-d tree", "robust ÷ k-d tree", "robust ÷ reading"),
                   [[f"{row['points']:,}", *(f"{1e3 * row[name]:.3g}" for name in _NAMES), f"{row['ffds_mb']:.0f}",
                     f"{row['robust_mb']:.0f}", f"{row['ffds'] / row['kdtree']:.2f}",
                     f"{row['robust'] / row['kdtree']:.2f}", f"{row['robust'] / row['read']:.0f}"]
                    for row in data["points"]])
    slope = Table("Nanoseconds per further point, and the fitted exponent",
                  ("", "100k to 1M", "1M to 5M", "ratio", "exponent"),
                  [[title, f"{further[name]['from_100k_to_1m']:.1f}", f"{further[name]['from_1m_to_5m']:.1f}",
                    f"{further[name]['ratio']:.2f}", f"{exponents['points'][name]:.2f}"]
                   for name, title in _NAMES.items()])
    methods = {"ffds": "ffds", "robust": "robust", "ffd_hsu": "ffd-hsu, product form"}
    lattice = Table("One face over the lattice, 100,000 points, ms", ("lattice", *methods.values()),
                    [[f"{row['lattice']} × {row['lattice']}", *(_cell(row, name) for name in methods)]
                     for row in data["lattices"]])
    stages = [name for name in data["faces"][0] if name not in ("faces", "points", "total")]
    faces = Table("Whole registration over connected faces, 2,000 points a face, seconds by stage",
                  ("faces", *stages, "total", "total ÷ faces"),
                  [[str(row["faces"]), *(f"{row.get(stage, 0):.2f}" for stage in stages), f"{row['total']:.2f}",
                    f"{row['total'] / row['faces']:.3f}"] for row in data["faces"]])
    picture = Picture(_plot(folder, data["points"]), "Time on one face.")
    return [Section("Over scan points", (), (picture,), (points, slope)),
            Section("Over the lattice", ("Four source points per control point for ffds and ffd-hsu.",),
                    tables=(lattice,)),
            Section("Over faces", ("A flat shell of square faces that share their edges, scanned after a smooth warp; "
                                   "reading, registration, rebuild and certificate.",), tables=(faces,))]


def _cell(row: Row, name: str) -> str:
    if f"{name}_refused" in row:
        return "refused"
    return f"{1e3 * row[name]:.3g}" if name in row else "–"


def _plot(folder: Path, rows: Sequence[Row]) -> str:
    drawing = style.figure(6.4, 4.4)
    axes = drawing.subplots()
    count = [row["points"] for row in rows]
    for name, colour, line in (("kdtree", style.SOFT, "--"), ("robust", style.COLOURS["robust"], "-"),
                               ("ffds", style.COLOURS["ffds"], "-"), ("read", style.INK, ":")):
        axes.loglog(count, [1e3 * row[name] for row in rows], line, color=colour, marker="o", markersize=4,
                    label=_NAMES[name])
    axes.set(xlabel="scan points", ylabel="ms", title="One face, time over scan points")
    axes.legend()
    return style.save(drawing, folder, "scaling_points")
