# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark accuracy``: true deviations, on a synthetic sheet and on the cases with ground truth."""
from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from .. import ROOT
from ..errors import RefusedError
from ..registration.face import FaceGeometry
from ..registration.ffds import register_ffds
from ..registration.projection import project
from ..registration.result import FaceRegistration
from ..registration.robust import register_robust
from ..registration.splines import Array
from . import page, sheet, style
from .page import Picture, Section, Table

Progress = Callable[[str], None]

CASES = ROOT.parent / "shared" / "data" / "cases"
SHEETS = {"A": "noise alone, σ = 0.13 mm", "D": "a fifth hidden, 2 % outliers, 8 % of other faces",
          "E": "as D, noise correlated over 1.5 mm"}
METHODS: dict[str, Callable[[FaceGeometry, Array], FaceRegistration]] = {
    "robust": register_robust,
    "ffds": lambda face, scan: register_ffds(face, scan, (10, 10), 400),
}
_FIGURES = ("mean", "p95", "max")


def run(folder: Path, progress: Progress, seeds: int = 20) -> str:
    """Measure, write accuracy.json, .md, .html and a chart into the folder, and give the tables as Markdown.

    Parameters
    ----------
    seeds : number of scans of each kind of the synthetic sheet
    """
    sheets = {kind: _sheet(kind, seeds, progress) for kind in SHEETS}
    bend = _bend(seeds, progress)
    cases = _cases(progress)
    data = {"seeds": seeds, "sheet": sheets, "bend": bend, "cases": cases}
    return page.write(folder, "accuracy", "Accuracy", _sections(folder, data), data)


def figures(deviations: Array) -> dict[str, float]:
    """Mean, 95th percentile and maximum of absolute deviations in mm."""
    p95 = float(np.percentile(deviations, 95))
    return {"mean": float(deviations.mean()), "p95": p95, "max": float(deviations.max())}


def _sheet(kind: str, seeds: int, progress: Progress) -> dict[str, Any]:
    face, result = sheet.nominal(), {name: [] for name in METHODS}
    for seed in range(seeds):
        progress(f"Sheet {kind}, scan {seed + 1} of {seeds}")
        scan = sheet.scan(kind, seed)
        for name, method in METHODS.items():
            start = time.perf_counter()
            registration = method(face, scan)
            seconds = time.perf_counter() - start
            result[name].append(figures(sheet.deviation(registration.displacement)) | {"seconds": seconds})
    return {name: _summary(rows) for name, rows in result.items()}


def _summary(rows: list[dict[str, float]]) -> dict[str, float]:
    summary = {key: float(np.mean([row[key] for row in rows])) for key in _FIGURES}
    medians = {f"median_{key}": float(np.median([row[key] for row in rows])) for key in (*_FIGURES, "seconds")}
    return summary | medians | {"worst": max(row["max"] for row in rows)}


def _bend(seeds: int, progress: Progress) -> dict[str, Any]:
    face, bend, result = sheet.nominal(), sheet.Bend(), {}
    for name, method in METHODS.items():
        progress(f"Bent sheet, {name}")
        fields = [method(face, bend.scan(seed)).displacement for seed in range(max(1, seeds // 4))]
        surface = figures(np.concatenate([bend.deviation(field) for field in fields]))
        result[name] = {"surface": surface, "edge": figures(np.concatenate([bend.edge_deviation(f) for f in fields]))}
    return result


def _cases(progress: Progress) -> list[dict[str, Any]]:
    if not CASES.is_dir():
        return []
    return [_case(folder, progress) for folder in sorted(CASES.iterdir()) if (folder / "case.json").is_file()]


def _case(folder: Path, progress: Progress) -> dict[str, Any]:
    """The case's main face by itself; its true points are judged along the normal of the deformed face."""
    from ..brep import files, workpiece
    from ..scan import files as scan_files

    progress(f"Case {folder.name}")
    case, truth = json.loads((folder / "case.json").read_text()), np.load(folder / "truth.npz")
    index = int(case["main_face"].removeprefix("Face")) - 1
    face = workpiece.read(files.read(folder / "nominal.step").shape).geometry(index)
    points = truth["warped"][(truth["face"] == index) & truth["visible"]]
    scan = scan_files.read(folder / "scan.ply").points
    row: dict[str, Any] = {"case": folder.name, "face": face.name, "kind": face.kind,
                           "before": figures(np.abs(project(face.surface, points).height))}
    methods = METHODS | {"ffds": lambda face, scan: register_ffds(face, scan, None)}
    for name, method in methods.items():
        try:
            result = method(face, scan)
        except RefusedError as error:
            row[name] = {"refused": str(error)}
            continue
        judged = figures(np.abs(project(face.surface, points, result.displacement).height))
        row[name] = judged | {"lattice": list(result.lattice), "noise": result.noise, "coverage": result.coverage}
    return row


def _sections(folder: Path, data: dict[str, Any]) -> list[Section]:
    head = ["scan", "method", "mean", "p95", "max", "median of max", "worst of all", "ms"]
    rows = [[f"{kind}: {SHEETS[kind]}", name, *(f"{row[key]:.4f}" for key in _FIGURES), f"{row['median_max']:.3f}",
             f"{row['worst']:.3f}", f"{1e3 * row['median_seconds']:.0f}"]
            for kind, methods in data["sheet"].items() for name, row in methods.items()]
    sheets = Table(f"True deviation in mm, means of {data['seeds']} scans", head, rows)
    rows = [[name, *(f"{row[part][key]:.4f}" for part in ("surface", "edge") for key in ("mean", "max"))]
            for name, row in data["bend"].items()]
    bend = Table("Sheet rolled to R = 150 mm, mm", ["method", "surface mean", "max", "edge mean", "max"], rows)
    text = ["The sheet is 75 × 70 mm and scanned with 42,087 points; its deformation of about 6 mm is a formula, so "
            "deviations are true. ffds: 400 source points, 10 × 10 control points.",
            "On the rolled sheet nothing is stretched; a single face registered along its normal slides at its edges."]
    picture = Picture(style.save(_chart(data), folder, "accuracy"), "Mean true deviation by scan and method")
    sections = [Section("Synthetic sheet", text, [picture], [sheets, bend])]
    if not data["cases"]:
        return [*sections, Section("Cases", ["The cases beside the project are absent: not measured."])]
    head = ["case", "face", "before", "robust mean", "p95", "max", "lattice", "noise", "ffds mean", "p95"]
    rows = [[row["case"], f"{row['face']} ({row['kind']})", f"{row['before']['mean']:.3f}",
             *_cells(row["robust"], _FIGURES), _lattice(row["robust"]),
             *_cells(row["robust"], ("noise",)), *_cells(row["ffds"], ("mean", "p95"))] for row in data["cases"]]
    text = ["The main face of each case by itself, its visible true points judged along the normal, mm. 30 % of the "
            "noise of b-mix-dirty is correlated."]
    return [*sections, Section("Cases", text, tables=[Table("Cases with ground truth, mm", head, rows)])]


def _cells(result: dict[str, Any], keys: tuple[str, ...]) -> list[str]:
    return [f"{result[key]:.4f}" if key in result else "refused" for key in keys]


def _lattice(result: dict[str, Any]) -> str:
    return "×".join(map(str, result["lattice"])) if "lattice" in result else "–"


def _chart(data: dict[str, Any]) -> Any:
    drawing = style.figure(7.0, 3.4)
    axes = drawing.add_subplot()
    groups = [(f"sheet {kind}", methods) for kind, methods in data["sheet"].items()]
    groups += [(row["case"], row) for row in data["cases"]]
    for k, name in enumerate(METHODS):
        places = [g + 0.4 * (k - 0.5) for g, (_, row) in enumerate(groups) if "mean" in row[name]]
        means = [row[name]["mean"] for _, row in groups if "mean" in row[name]]
        axes.bar(places, means, 0.38, color=style.COLOURS[name], label=name)
    axes.set_yscale("log")
    axes.set_ylabel("mean true deviation, mm")
    axes.set_xticks(range(len(groups)), [name for name, _ in groups], rotation=45, ha="right")
    axes.legend()
    return drawing
