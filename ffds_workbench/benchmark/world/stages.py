# SPDX-License-Identifier: LGPL-2.1-or-later
"""The steps of one case, each of them run in a process of its own with its name and the case's folder.

The folder holds ``job.json`` and what the steps before have left: make, register, judge.
"""
from __future__ import annotations

import json
import resource
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import Part
from scipy.spatial import cKDTree

from ... import api
from ...errors import FfdsError, RefusedError
from ..simulated.sheet import to_polyline
from . import judge as judging
from .case import WorldTruth
from .case import make as make_case
from .settings import ScanSettings

MADE, BUILT, REGISTERED, JUDGED = "made.json", "as_built.step", "registered.json", "judged.json"
BUILT_EXACTLY = "as_built.brep"
"""Where the STEP file is refused."""
_FLOOR_SIGMAS, _FLOOR_SIZE = 4.0, 1e-3
"""An edge is where it should be within so many σ of the scan and that share of the part's diagonal."""


def make(folder: Path) -> None:
    """The nominal model, scaled where that is asked for, its scan and its truth."""
    job, settings = _job(folder)
    path = Path(job["model"])
    if settings.scale != 1:
        shape = Part.read(str(path)).copy()
        shape.scale(settings.scale)
        path = folder / "nominal.step"
        shape.exportStep(str(path))
    shape = Part.read(str(path))
    make_case(shape, job["deformation"], settings, folder)
    about = {"nominal_path": str(path), "faces_count": len(shape.Faces), "solids_count": len(shape.Solids),
             "size": shape.BoundBox.DiagonalLength, "nominal_valid": bool(shape.isValid())}
    (folder / MADE).write_text(json.dumps(about))


def register(folder: Path) -> None:
    """The as-built model as ``ffds register`` writes it, what it took, and the bands where the truth is known."""
    begin = time.perf_counter()
    model = api.read_model(_made(folder)["nominal_path"])
    result = api.register(model, api.read_scan(folder / "scan.ply"))
    written = _write(model, result, folder)
    seconds, used = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_SELF)
    (folder / REGISTERED).write_text(json.dumps(
        written | {"seconds": seconds, "processor": used.ru_utime + used.ru_stime,
                   "megabytes": used.ru_maxrss / 1024}))
    np.savez_compressed(folder / "bands.npz", **_bands(result, _truth(folder)))


def _write(model: api.Model, result: api.Result, folder: Path) -> dict[str, str]:
    """Write the as-built model as STEP, or where that is refused as BREP: the file's name, and what was refused."""
    try:
        api.check_model_output(folder / BUILT, model)
        api.write(result, folder / BUILT)
    except RefusedError as error:
        api.write(result, folder / BUILT_EXACTLY)
        return {"built": BUILT_EXACTLY, "step_refused": str(error)}
    return {"built": BUILT}


def judge(folder: Path) -> None:
    """Judge the written file as it is read back."""
    settings, made, built = _job(folder)[1], _made(folder), json.loads((folder / REGISTERED).read_text())["built"]
    floor = _FLOOR_SIGMAS * settings.sigma * settings.scale + _FLOOR_SIZE * made["size"]
    row = judging.judge(Part.read(made["nominal_path"]), folder / built, _truth(folder),
                        dict(np.load(folder / "bands.npz")), floor)
    (folder / JUDGED).write_text(json.dumps(row))


STAGES = {step.__name__: step for step in (make, register, judge)}


def _job(folder: Path) -> tuple[dict[str, Any], ScanSettings]:
    job = json.loads((folder / "job.json").read_text())
    return job, ScanSettings(**job["settings"])


def _made(folder: Path) -> dict[str, Any]:
    return json.loads((folder / MADE).read_text())


def _truth(folder: Path) -> WorldTruth:
    return WorldTruth(**np.load(folder / "truth.npz"))


def _bands(result: api.Result, truth: WorldTruth) -> dict[str, np.ndarray]:
    """Bands (mm) and flags: at each true point those of the nearest place of its face, if that has places, and at the
    places of edges."""
    joint = result.joint
    band, flag = np.zeros(len(truth.face)), np.zeros(len(truth.face), dtype="U16")
    for index, face in enumerate(joint.faces):
        if len(face.uv):
            own = np.flatnonzero(truth.face == index)
            nearest = cKDTree(result.part.geometry(index).surface(face.uv)).query(truth.nominal[own])[1]
            band[own], flag[own] = face.bands[nearest], face.flags[nearest]
    places = [(edge, true) for edge, nominal, true in zip(joint.edges, truth.edges_nominal, truth.edges, strict=True)
              if len(edge.points) and np.ptp(nominal, axis=0).max() > 0]
    columns = zip(*((edge.bands, to_polyline(edge.points, true), edge.flags) for edge, true in places), strict=True)
    edges = dict(zip(("edge", "edge_off", "edge_flag"), map(np.concatenate, columns), strict=True))
    return {"face": band, "face_flag": flag} | edges


def main() -> None:
    """Run the step that the command line names; refusals are one line and their exit code."""
    try:
        STAGES[sys.argv[1]](Path(sys.argv[2]))
    except FfdsError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(error.exit_code)
