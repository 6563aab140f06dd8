# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark sizes``: errors, time and memory of whole parts over faces, scan points, noise and size.

Every case is registered in a process of its own, from the files to the written STEP, so that memory and processor time
are its own. Errors are those of the as-built faces and edges from the true ones, in standard deviations of the noise.
"""
from __future__ import annotations

import multiprocessing
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from .. import api
from ..errors import FfdsError
from ..scan.sensor import SensorSettings, View
from ..scan.sensor.files import write_ply
from .accuracy_study.accuracy_cases import judge_by_truth
from .pages import page, style
from .pages.page import Picture, Section, Table
from .simulated.families import deformation, scanned, through_step
from .simulated.frames import frame
from .simulated.parts import FamilyPart, bracket
from .simulated.warps import Warp

Progress = Callable[[str], None]
Row = dict[str, Any]

_SOLIDS = (4, 8, 20, 40)
_SPACINGS = (3.0, 1.0, 0.35, 0.12)
_NOISES = (0.39, 0.13, 0.04, 0.013)
_SCALES = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0)
_VIEWS = np.array([[0.3, 0.2, 1.0], [-0.5, 0.6, -0.8], [0.8, -0.5, 0.6], [-0.7, -0.6, 0.5]])
_DISPLACED, _SPACING, _NOISE = 0.008, 1.8, 0.2
"""Of frames: largest displacement over the size; distance of scan points in mm; standard deviation in mm."""


def run(folder: Path, progress: Progress) -> str:
    """Measure, and write ``sizes.json``, ``sizes.md``, ``sizes.html`` and a picture; returns the tables."""
    rows = {"frames": [_measured(progress, solids=solids) for solids in _SOLIDS],
            "points": [_measured(progress, spacing=spacing) for spacing in _SPACINGS],
            "noise": [_measured(progress, noise=noise) for noise in _NOISES],
            "scale": [_measured(progress, scale=scale) for scale in _SCALES]}
    exponents = {key: _exponent(rows["frames"], "faces", key) for key in ("seconds", "gigabytes")}
    return page.write(folder, "sizes", "Sizes", _sections(folder, rows, exponents), {**rows, "exponents": exponents})


def _measured(progress: Progress, **what: Any) -> Row:
    progress("Sizes: " + ", ".join(f"{key} {value:g}" for key, value in what.items()))
    with tempfile.TemporaryDirectory() as scratch:
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            about = pool.submit(make, Path(scratch), **what).result()
        with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
            return what | about | pool.submit(measure, Path(scratch), about["noise"]).result()


def make(folder: Path, solids: int = 0, spacing: float = 0.35, noise: float = 0.13, scale: float = 1.0) -> Row:
    """Write a frame of so many ``solids``, or else a bracket in a ``scale``, with a scan and the truth."""
    rng = np.random.default_rng(1)
    part = through_step(FamilyPart(frame(solids), _VIEWS) if solids else bracket(rng))
    size = part.shape.BoundBox.DiagonalLength
    if solids:
        spacing, noise = _SPACING, _NOISE
    move = deformation(part, "mix", _DISPLACED * size if solids else 2.0, rng)
    if scale != 1.0:
        larger = part.shape.copy()
        larger.scale(scale)
        part, move, size = replace(part, shape=larger), _scaled(move, scale), scale * size
    settings = SensorSettings(scale * spacing, scale * noise, views=tuple(View((x, y, z)) for x, y, z in part.views),
                              standoff=3 * size, field=(2 * size, 2 * size), limit=2_000_000)
    target, scan, truth = scanned(part, move, settings)
    part.shape.exportStep(str(folder / "nominal.step"))
    write_ply(folder / "scan.ply", scan.points, None)
    truth.write(folder / "truth.npz")
    return {"faces": len(target.faces), "size": size, "points": len(scan.points), "noise": scale * noise}


def _scaled(move: Warp, scale: float) -> Warp:
    """The same deformation of a part that is so many times as large."""
    return lambda points: scale * move(points / scale)


def measure(folder: Path, noise: float) -> Row:
    """Register the case in a folder; errors in standard deviations ``noise`` in mm of the scan."""
    import resource

    start = time.perf_counter()
    try:
        result = api.register(api.read_model(folder / "nominal.step"), api.read_scan(folder / "scan.ply"))
        api.write(result, folder / "as_built.step")
    except FfdsError as error:
        return {"refused": str(error)}
    wall, usage = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_SELF)
    row = {"seconds": usage.ru_utime + usage.ru_stime, "wall": wall, "gigabytes": usage.ru_maxrss / 1e6}
    judged = judge_by_truth(result, dict(np.load(folder / "truth.npz")))["judged"]
    return row | {key: judged[key]["mean"] / noise if judged[key] else None for key in ("visible", "hidden", "edges")}


def _exponent(rows: Sequence[Row], over: str, what: str) -> float | None:
    """Slope of the logarithms."""
    done = [(row[over], row[what]) for row in rows if what in row]
    if len(done) < 2:
        return None
    x, y = np.log(done).T
    return float(np.polyfit(x, y, 1)[0])


def _sections(folder: Path, rows: dict[str, list[Row]], exponents: dict[str, float | None]) -> list[Section]:
    heads = {"frames": ("solids", "Frames of touching tubes and gussets, 8 ‰ of their size off"),
             "points": ("spacing", "A bracket over the distance of scan points"),
             "noise": ("noise", "A bracket over the noise"), "scale": ("scale", "A bracket in other sizes, noise too")}
    tables = [Table(title, (first, "faces", "size, mm", "points", "s", "wall s", "GB", "visible", "hidden", "edges"),
                    [[f"{row[first]:g}", str(row["faces"]), f"{row['size']:.0f}", f"{row['points']:,}", *_cells(row)]
                     for row in rows[name]]) for name, (first, title) in heads.items()]
    slopes = ", ".join(f"{key} {value:.2f}" for key, value in exponents.items() if value is not None)
    text = ["Processor seconds from the files to the written STEP, all modules loaded anew; largest memory of the "
            "process; means of the errors in standard deviations of the noise.",
            f"Exponents over the number of faces of frames: {slopes}."]
    return [Section("Over sizes", text, (Picture(_plot(folder, rows["frames"]), "Frames over their faces"),), tables)]


def _cells(row: Row) -> list[str]:
    if "refused" in row:
        return ["refused", row["refused"], "", "", "", ""]
    errors = [f"{row[key]:.3f}" if row[key] is not None else "–" for key in ("visible", "hidden", "edges")]
    return [f"{row['seconds']:.1f}", f"{row['wall']:.1f}", f"{row['gigabytes']:.2f}", *errors]


def _plot(folder: Path, rows: Sequence[Row]) -> str:
    drawing = style.figure(6.4, 4.0)
    axes = drawing.subplots()
    done = [row for row in rows if "seconds" in row]
    for key, label in (("seconds", "processor seconds"), ("gigabytes", "GB")):
        axes.loglog([row["faces"] for row in done], [row[key] for row in done], marker="o", markersize=4, label=label)
    axes.set(xlabel="faces", title="Welded frames, from the files to the STEP")
    axes.legend()
    return style.save(drawing, folder, "sizes")
