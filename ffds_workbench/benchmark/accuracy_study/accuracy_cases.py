# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whole parts with known truth: families drawn at random and the supplied cases, registered, written and judged.

The written STEP is judged by the independent ``evaluate.py`` where it lies beside the project, and by the truth's own
points otherwise. Bands are judged by the truth's points: how many lie within the band of the nearest place.
"""
from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from ... import ROOT, api
from ...brep import workpiece
from ...brep.rebuilt_faces import built_geometry
from ...errors import FfdsError
from ...registration.arrays import Array
from ...registration.joint import SensorProfile
from ...registration.projection import project
from ...report.certificate import broken
from ..simulated.families import SCANS, make_case
from ..simulated.sheet import to_polyline

SHARED = ROOT.parent / "shared"
CASES = SHARED / "data" / "cases"
NOISE, CORRELATION = 0.13, SCANS["dirty"]["correlation"]
_SHARE = SCANS["dirty"]["correlated_share"]
CORRELATED = SensorProfile(NOISE * np.sqrt(1 - _SHARE), NOISE * np.sqrt(_SHARE), np.sqrt(2) * CORRELATION, "simulated")
"""The profile of the sensor of dirty scans: a Gaussian filter of width w leaves the correlation exp(−r²/4w²)."""
_WARPS = {
    "bracket": ("springback", "mix", "bend", "twist", "bumps"), "hat-channel": ("springback", "mix", "twist", "bend"),
    "rimmed-plate": ("iso", "bumps", "mix", "twist"), "free-form-panel": ("twist", "mix", "bend", "bumps"),
    "pipe-on-plate": ("bumps", "mix", "twist", "bend"), "turned-part": ("bend", "mix", "bumps", "twist"),
}
_KINDS = ("clean", "one-view", "clean", "dirty")
WITHOUT_NORMALS = ("free-form-panel", "bend", 15, "one-view")
WITH_NORMALS = (*WITHOUT_NORMALS[:3], "one-view with normals")
"""One skin of a thin sheet that moved by half its thickness: points alone do not show which, a sensor's normals do."""
_JUDGED = 1500
"""Truth points per face, at most."""
_DEGENERATE = 1e-9
FLAGS = ("observed", "bridged", "carried")


def family_cases(count: int) -> list[tuple[str, str, int, str]]:
    """Families, deformations, seeds and kinds of scans, each of them spread over all seeds."""
    names = []
    for seed in range(count):
        turn, index = divmod(seed, len(_WARPS))
        family = list(_WARPS)[index]
        warps = _WARPS[family]
        names.append((family, warps[turn % len(warps)], seed, _KINDS[(seed + turn) % len(_KINDS)]))
        if names[-1] == WITHOUT_NORMALS:
            names.append(WITH_NORMALS)
    return names


def run_case(name: tuple[str, str, int, str] | str) -> dict[str, Any]:
    """Register and judge one case of `family_cases`, or a supplied one by its folder's name."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = CASES / name if isinstance(name, str) else Path(scratch) / "case"
        if isinstance(name, str):
            dirty = name.endswith("dirty")
            row: dict[str, Any] = {"case": name, "family": name.split("-")[0], "kind": "dirty" if dirty else "white"}
        else:
            family, warp, seed, kind = name
            dirty = kind == "dirty"
            row = {"case": f"{family}/{warp}/{seed}/{kind}", "family": family, "kind": kind}
            make_case(family, warp, seed, kind).write(folder)
        return row | _register(folder, Path(scratch), CORRELATED if dirty else None)


def _register(folder: Path, scratch: Path, sensor: SensorProfile | None) -> dict[str, Any]:
    out, truth = scratch / "as_built.step", dict(np.load(folder / "truth.npz"))
    start = time.perf_counter()
    try:
        result = api.register(api.read_model(folder / "nominal.step"), api.read_scan(folder / "scan.ply"),
                              sensor=sensor)
        api.write(result, out)
    except FfdsError as error:
        return {"refused": str(error)}
    row: dict[str, Any] = {"seconds": time.perf_counter() - start, "certificate": result.certificate.problems(),
                            "unsure": result.joint.unsure}
    own = judge_by_truth(result, truth)
    return row | (_independent(folder, out) or own.pop("judged")) | own["bands"]


def _independent(folder: Path, out: Path) -> dict[str, Any] | None:
    """What the judge beside the project says of the written file, or None where it is absent."""
    tools = SHARED / "tools"
    if not (tools / "evaluate.py").is_file():
        return None
    if str(tools) not in sys.path:
        sys.path.append(str(tools))
    import evaluate

    found = evaluate.evaluate(str(folder / "nominal.step"), str(out), str(folder / "truth.npz"), baseline=False)
    errors, health = found["error"], found["health"]
    return {"judge": "evaluate.py", "visible": errors["visible"], "hidden": errors["hidden"],
            "edges": errors["edges"], "thickness": errors.get("thickness"), "gap": health["excess_gap"],
            "tolerance": health["max_tolerance"], "topology": not found["flags"]}


def judge_by_truth(result: api.Result, truth: Mapping[str, Array]) -> dict[str, Any]:
    """Figures from the truth's points and the as-built faces, and how many points the bands hold."""
    part = workpiece.read(result.nominal.shape)
    visible, deviation, banded, band, flag = [], [], [], [], []
    rng = np.random.default_rng(0)
    for index, (built, found) in enumerate(zip(result.shape.Faces, result.joint.faces, strict=True)):
        own = np.flatnonzero(truth["face"] == index)
        own = rng.permutation(own)[:_JUDGED]
        deviation.append(np.abs(project(built_geometry(part, index, built).surface, truth["warped"][own]).height))
        visible.append(truth["visible"][own])
        if len(found.uv):  # a ring round a hole may hold none of the places that have bands
            nearest = cKDTree(part.geometry(index).surface(found.uv)).query(truth["nominal"][own])[1]
            banded.append(deviation[-1])
            band.append(found.bands[nearest])
            flag.append(found.flags[nearest])
    seen, off = np.concatenate(visible), np.concatenate(deviation)
    edges = _edges(result, truth)
    bands = {"bands": _held(np.concatenate(banded), np.concatenate(band), np.concatenate(flag)),
             "edge_bands": _held(*edges)}
    gap = result.certificate
    judged = {"judge": "truth", "visible": figures(off[seen]), "hidden": figures(off[~seen]),
              "edges": figures(edges[0]), "thickness": None, "gap": gap.excess_gap,
              "tolerance": gap.after.max_tolerance, "topology": not broken(gap.before, gap.after)}
    return {"judged": judged, "bands": bands}


def _edges(result: api.Result, truth: Mapping[str, Array]) -> tuple[Array, Array, Array]:
    """Distances of the as-built edges from the true ones, their bands and flags at the same places."""
    off, band, flag = [np.zeros(0)], [np.zeros(0)], [np.zeros(0, dtype="U8")]
    for found, true, nominal in zip(result.joint.edges, truth["edges"], truth["edges_nominal"], strict=True):
        if len(found.points) and np.ptp(nominal, axis=0).max() > _DEGENERATE:
            off.append(to_polyline(found.points, true))
            band.append(found.bands)
            flag.append(found.flags)
    return np.concatenate(off), np.concatenate(band), np.concatenate(flag)


def _held(off: Array, band: Array, flag: Array) -> dict[str, dict[str, int]]:
    """Number of places with each flag, and how many of them lie within their bands."""
    return {name: {"places": int((flag == name).sum()), "held": int(((off <= band) & (flag == name)).sum())}
            for name in FLAGS}


def figures(deviations: Array) -> dict[str, float] | None:
    """Mean, 95th percentile and maximum of absolute deviations in mm; None where there are none."""
    if not len(deviations):
        return None
    return {"mean": float(deviations.mean()), "p95": float(np.percentile(deviations, 95)),
            "max": float(deviations.max())}
