# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark real``: a real scan of a real weld part, every fifth scan point held out, each in its turn.

Each observed face by itself, then all solids together. There is no truth here: the held-out points judge, and the noise
that the scan shows about local planes. The data is not part of the project; without it the benchmark says so.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from .. import ROOT, api
from ..brep import workpiece
from ..registration.arrays import Array
from ..registration.face import observed_faces
from ..report.comparison import compare
from ..report.deviation import FaceDeviation
from .pages import page
from .pages.page import Section, Table

FOLDER = ROOT.parent / "shared" / "data" / "weld_pipe_on_angle"
_FOLDS = 5
_NEIGHBOURS = 12
_HEAD = ("face", "points", "before", "signed mean before", "fitted", "held out", "held out / fitted", "noise",
         "topology")


def run(folder: Path, progress: Callable[[str], None]) -> str:
    """Measure, write real.json, real.md and real.html into the folder, and give the table as Markdown."""
    title = "A real weld part: held-out scan points"
    if not FOLDER.is_dir():
        return page.write(folder, "real", title, [Section(title, ("Left out: the scan is not there.",))], {"rows": []})
    model = api.read_model(FOLDER / "nominal.step")
    points = api.read_scan(FOLDER / "scan_60deg_aligned_mm.ply").points
    part = workpiece.read(model.shape)
    geometries = [part.geometry(index) for index in range(len(part.faces))]
    lots = [[part.faces[index].name] for index in observed_faces(geometries, points)]
    rows = [_measure(part, model, points, names, progress) for names in [*lots, None]]
    text = (f"{len(points)} points of a robot-mounted laser; mean |deviation| in mm of the points fitted and of those "
            f"held out: every fifth, in {_FOLDS} runs each point once. Noise: mean |distance| of the scan points from "
            f"planes through their {_NEIGHBOURS} neighbours.",)
    table = Table("Mean |deviation| in mm", _HEAD, [_cells(row) for row in rows])
    return page.write(folder, "real", title, [Section(title, text, tables=(table,))], {"rows": rows})


def _measure(part: workpiece.Workpiece, model: api.Model, points: Array, names: Sequence[str] | None,
             progress: Callable[[str], None]) -> dict[str, Any]:
    """Registrations that leave out every fifth point, judged on both lots over the faces that they moved."""
    label = ", ".join(names) if names else "all together"
    fitted: list[FaceDeviation] = []
    before: list[FaceDeviation] = []
    after: list[FaceDeviation] = []
    used, problems = [], set()
    for fold in range(_FOLDS):
        progress(f"Registering {label}: run {fold + 1} of {_FOLDS}")
        held = np.arange(len(points)) % _FOLDS == fold
        try:
            result = api.register(model, points[~held], names)
        except api.RefusedError as refusal:
            return {"face": label, "refused": str(refusal)}
        moved = [part.index(name) for name in names] if names else list(range(len(part.faces)))
        fitted += compare(part, result.shape, moved, points[~held])[1]
        nominal, built = compare(part, result.shape, moved, points[held])
        before, after = [*before, *nominal], [*after, *built]
        used += [np.flatnonzero(held)[item.points] for item in built]
        problems |= set(result.certificate.problems())
    return {"face": label, "points": sum(map(len, used)), "before": _mean(before),
            "signed_before": float(np.concatenate([item.deviations for item in before]).mean()),
            "fitted": _mean(fitted), "held_out": _mean(after),
            "noise": float(_local_noise(points, points[np.concatenate(used)])), "problems": sorted(problems)}


def _mean(faces: Sequence[FaceDeviation]) -> float:
    return float(np.abs(np.concatenate([face.deviations for face in faces])).mean())


def _local_noise(scan: Array, places: Array) -> float:
    """Mean distance in mm of scan points from planes through their neighbours, for the three parameters fitted."""
    _, rows = cKDTree(scan).query(places, _NEIGHBOURS)
    patches = scan[rows] - scan[rows].mean(axis=1, keepdims=True)
    normals = np.linalg.eigh(np.einsum("nki,nkj->nij", patches, patches))[1][:, :, 0]
    residuals = np.einsum("nki,ni->nk", patches, normals)
    return np.abs(residuals).mean() * np.sqrt(_NEIGHBOURS / (_NEIGHBOURS - 3))


def _cells(row: dict[str, Any]) -> list[str]:
    if "refused" in row:
        return [row["face"], *[""] * (len(_HEAD) - 2), f"refused: {row['refused']}"]
    return [row["face"], str(row["points"]), f"{row['before']:.3f}", f"{row['signed_before']:+.3f}",
            f"{row['fitted']:.3f}", f"{row['held_out']:.3f}", f"{row['held_out'] / row['fitted']:.3f}",
            f"{row['noise']:.3f}", "; ".join(row["problems"]) or "kept"]
