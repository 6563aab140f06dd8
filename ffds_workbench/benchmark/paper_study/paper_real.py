# SPDX-License-Identifier: LGPL-2.1-or-later
"""A real scan beside the simulated ones: the pipe of a weld part, scanned by a robot's laser.

The data is not part of the project; without it the row is left out and said to be.
"""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import Part
from scipy.spatial import cKDTree

from ... import ROOT
from ...brep import workpiece
from ...errors import RefusedError
from ...registration.arrays import Array
from ...registration.face import FaceRegistration, register_ffd, register_ffds, register_robust
from ...registration.face_geometry import FaceGeometry
from ...scan import files
from ...scan.sensor import Scene
from ...scan.sensor.target import inside_outlines
from ...scan.sensor.truth import foot

FOLDER = ROOT.parent / "shared" / "data" / "weld_pipe_on_angle"
_REACH = 8.0
_HELD_OUT = 5

_METHODS: dict[str, Callable[[FaceGeometry, Array], FaceRegistration]] = {
    "ffds": lambda face, scan: register_ffds(face, scan, (6, 6), 400),
    "ffd_hsu": lambda face, scan: register_ffd(face, scan, (6, 6), 400),
    "robust": lambda face, scan: register_robust(face, scan),
}


def _of_parameters(displacement: Callable[[Array], Array]) -> Callable[[Array, Array], Array]:
    """A displacement of (u, v) as one of a face's (u, v) and points."""
    return lambda uv, points: displacement(uv)


def measure() -> dict[str, Any] | None:
    """Deviation of held-out scan points (every fifth) before and after; None where the data is absent.

    Returns
    -------
    ``face``, ``points``, ``before`` and per method mean and rms in mm of the points fitted and of those held out
    """
    if not FOLDER.is_dir():
        return None
    part = workpiece.read(Part.read(str(FOLDER / "nominal.step")))
    scan = files.read(FOLDER / "scan_60deg_aligned_mm.ply").points
    index, face = _pipe(part, scan)
    near = _near(face, scan)
    held = np.arange(len(scan)) % _HELD_OUT == 0
    target = Scene([face])
    result: dict[str, Any] = {"face": f"Face{index + 1}", "points": int(near.sum()),
                              "before": _figures(target, scan[near & held])}
    for name, register in _METHODS.items():
        try:
            displacement = register(face, scan[~held]).displacement
        except RefusedError as error:
            result[name] = {"refused": str(error)}
            continue
        moved = Scene([face], {0: _of_parameters(displacement)})
        result[name] = {"fitted": _figures(moved, scan[near & ~held]), "held_out": _figures(moved, scan[near & held])}
    return result


def _pipe(part: workpiece.Workpiece, scan: Array) -> tuple[int, FaceGeometry]:
    """The outer cylinder that most scan points lie near."""
    faces = [(i, part.geometry(i)) for i in range(len(part.faces))]
    outer = [(i, face) for i, face in faces if face.kind == "Cylinder" and face.outward > 0]
    return max(outer, key=lambda item: _near(item[1], scan).sum())


def _near(face: FaceGeometry, scan: Array) -> np.ndarray:
    """Which scan points lie over the face, inside its trims, within reach."""
    coarse = cKDTree(Scene([face]).grid(2.0)).query(scan, distance_upper_bound=_REACH + 2)[0]
    candidates = np.flatnonzero(np.isfinite(coarse))
    near = np.zeros(len(scan), dtype=bool)
    if len(candidates):
        uv, distance = foot(Scene([face]), 0, scan[candidates])
        near[candidates] = (distance < _REACH) & inside_outlines(face.trims, uv)
    return near


def _figures(target: Scene, points: Array) -> dict[str, float]:
    distance = foot(target, 0, points)[1]
    return {"mean": float(distance.mean()), "rms": float(np.sqrt((distance**2).mean()))}
