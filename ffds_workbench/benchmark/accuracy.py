# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark accuracy``: true deviations on a synthetic sheet, on families of parts and on the supplied cases,
how often the 95 % bands contain the truth, and which requirements are met."""
from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from .accuracy_study import accuracy_cases, accuracy_sheet
from .accuracy_study.accuracy_cases import FLAGS
from .accuracy_study.accuracy_lines import AccuracyLine, figure, held, lines
from .accuracy_study.accuracy_sheet import FIGURES, SHEETS
from .pages import page, style
from .pages.page import Picture, Section, Table

Progress = Callable[[str], None]

_MOST_WORKERS = 4
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")


def run(folder: Path, progress: Progress, seeds: int = 24, sheets: Mapping[str, int] = accuracy_sheet.SEEDS) -> str:
    """Measure, write accuracy.json, .md, .html and a chart into the folder, and give the tables as Markdown.

    Parameters
    ----------
    seeds : number of cases of the families, each with its own seed; the supplied cases come on top where they are
    sheets : number of scans of each kind of the synthetic sheet
    """
    kinds = {kind: accuracy_sheet.measure(kind, count, progress) for kind, count in sheets.items()}
    bend = accuracy_sheet.bend(progress)
    rows = run_cases([*_supplied(), *accuracy_cases.family_cases(seeds)], progress)
    found = lines(kinds, rows)
    data = {"seeds": seeds, "sheet": kinds, "bend": bend, "cases": rows, "bands": held(rows),
            "edge_bands": held(rows, "edge_bands"), "lines": [line.as_dict() for line in found]}
    return page.write(folder, "accuracy", "Accuracy", _sections(folder, data, found), data)


def run_cases(names: Sequence[tuple[str, str, int, str] | str], progress: Progress) -> list[dict[str, Any]]:
    """Rows of `accuracy_cases.run_case`, in the order of the names, from as many processes as there are processors."""
    if not names:
        return []
    rows: dict[int, dict[str, Any]] = {}
    workers = min(_MOST_WORKERS, os.cpu_count() or 1, len(names))
    before = {key: os.environ.get(key) for key in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        with ProcessPoolExecutor(workers, multiprocessing.get_context("spawn")) as pool:
            jobs = {pool.submit(accuracy_cases.run_case, name): number for number, name in enumerate(names)}
            for job in as_completed(jobs):
                rows[jobs[job]] = job.result()
                progress(f"Case {len(rows)} of {len(names)}: {rows[jobs[job]]['case']}")
    finally:
        for key, value in before.items():
            os.environ.pop(key) if value is None else os.environ.update({key: value})
    return [rows[number] for number in range(len(names))]


def _supplied() -> list[str]:
    cases = accuracy_cases.CASES
    return sorted(item.name for item in cases.iterdir() if (item / "truth.npz").is_file()) if cases.is_dir() else []


def _sections(folder: Path, data: dict[str, Any], found: Sequence[AccuracyLine]) -> list[Section]:
    met = sum(line.met for line in found)
    rows = [[line.what, f"{line.found:.4g}", line.asked, "met" if line.met else "NOT MET"] for line in found]
    verdict = Section("What is asked", [f"{met} of {len(found)} lines are met."],
                      tables=[Table("Lines", ["", "found", "asked", ""], rows)])
    return [verdict, _cases(folder, data), _bands(data), *_sheets(folder, data)]


def _cases(folder: Path, data: dict[str, Any]) -> Section:
    head = ["case", "visible mean", "p95", "hidden mean", "edges mean", "max", "thickness", "gap", "tolerance",
            "topology", "s", "judge"]
    rows = [_case(row) for row in data["cases"]]
    text = ["Whole parts, all faces at once, mm; σ = 0.13 mm along the view. The written STEP is judged by an "
            "independent evaluate.py where it lies beside the project, else by the truth's points. One-view scans see "
            "one side, with normals as a sensor estimates them where it says so; dirty ones have gaps, 2 % outliers, a "
            "table, and 30 % of their noise correlated, as the sensor profile says. Seconds are of one thread with the "
            "machine shared by as many processes as processors."]
    pictures = [Picture(style.save(_chart(data), folder, "accuracy"), "Mean true deviation by case")]
    return Section("Whole parts", text, pictures if rows else [], [Table("Cases, mm", head, rows)] if rows else [])


def _case(row: Mapping[str, Any]) -> list[str]:
    if "refused" in row:
        return [row["case"], "refused: " + row["refused"], *[""] * 10]
    cells = [f"{figure(row, what):.4f}" if row[what] else "–" for what in ("visible", "hidden", "edges", "thickness")]
    return [row["case"], cells[0], f"{figure(row, 'p95'):.4f}", cells[1], cells[2], f"{row['edges']['max']:.3f}",
            cells[3], f"{row['gap']:.1e}", f"{row['tolerance']:.1e}",
            "kept" if row["topology"] and not row["certificate"] else "BAD", f"{row['seconds']:.1f}", row["judge"]]


def _bands(data: dict[str, Any]) -> Section:
    rows = []
    for kind, name in (("white", "white noise"), ("dirty", "30 % correlated, sensor profile known")):
        for flag in FLAGS:
            shares = [data[key].get(f"{kind}/{flag}") for key in ("bands", "edge_bands")]
            if any(shares):
                cells = [cell for item in shares
                         for cell in ([f"{item['share']:.3f}", f"{item['places']:,}"] if item else ["–", "–"])]
                rows.append([f"{name}, {flag}", *cells])
    head = ["", "faces: held", "places", "edges: held", "places"]
    text = ["Share of the truth's points within the 95 % band of the nearest place of their face, all cases pooled; "
            "edges: of the places along them."]
    return Section("Bands", text, tables=[Table("95 % bands", head, rows)] if rows else [])


def _sheets(folder: Path, data: dict[str, Any]) -> list[Section]:
    head = ["scan", "method", "scans", "mean", "p95", "max", "median mean", "p95", "max", "worst of all", "ms"]
    rows = [[f"{kind}: {SHEETS[kind]}", name, str(row["seeds"]), *(f"{row[key]:.4f}" for key in FIGURES),
             *(f"{row[f'median_{key}']:.4f}" for key in FIGURES), f"{row['worst']:.3f}",
             f"{1e3 * row['median_seconds']:.0f}"]
            for kind, methods in data["sheet"].items() for name, row in methods.items()]
    tables = [Table("True deviation in mm, means and medians over the scans", head, rows)]
    rows = [[name, *(f"{row[part][key]:.4f}" for part in ("surface", "edge") for key in ("mean", "max"))]
            for name, row in data["bend"].items()]
    tables.append(Table("Sheet rolled to R = 150 mm, mm", ["method", "surface mean", "max", "edge mean", "max"], rows))
    text = ["The sheet is 75 × 70 mm and scanned with 42,087 points; its deformation of about 6 mm is a formula, so "
            "deviations are true. ffds: 400 source points, 10 × 10 control points. Least squares gets the sheet's "
            "points alone, which no method knows, and runs wild in gaps.",
            "On the rolled sheet nothing is stretched; a single face registered along its normal slides at its edges."]
    return [Section("Synthetic sheet", text, tables=tables)]


def _chart(data: dict[str, Any]) -> Any:
    drawing = style.figure(7.0, 3.6)
    axes = drawing.add_subplot()
    rows = [row for row in data["cases"] if "refused" not in row]
    for what, colour in zip(("visible", "hidden", "edges"), ("#1f6f8b", "#c4762b", "#7a7a7a"), strict=True):
        places = [k for k, row in enumerate(rows) if row[what]]
        axes.plot(places, [figure(rows[k], what) for k in places], "o", markersize=4, color=colour, label=what)
    axes.set_yscale("log")
    axes.set_ylabel("mean true deviation, mm")
    axes.set_xticks(range(len(rows)), [row["case"] for row in rows], rotation=90, fontsize=5)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3)
    return drawing
