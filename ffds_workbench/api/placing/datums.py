# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``align`` by datums: a scan on its model by datum faces in their order, or by reference points."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ...brep.model_files import Model
from ...brep.workpiece import WorkpieceFace
from ...errors import InputError, RefusedError
from ...fields.csv_file import read_table
from ...registration.arrays import Array
from ...registration.datums import (CylinderFeature, DatumFeature, DatumPose, PlaneFeature, ReferencePoint,
                                   SphereFeature, align_on_datums, align_on_points, points_of_faces)
from ...registration.datums.datum_pose import FREEDOMS
from ...registration.motions import apply
from ...registration.rigid import AMBIGUOUS, OK
from ...report.stopwatch import Progress, Stopwatch
from ...scan.cloud import PointCloud
from ..inputs import as_cloud, as_model, as_workpiece
from .aligning import align_scan

_SELECTIONS = 3
"""How often the points of the datums are looked for anew, each time where the last pose has brought them
(unit: time)."""
_LEAST_POINTS = 20
"""Points of a datum below which it counts as not seen (unit: clutter may leave some)."""


@dataclass(frozen=True)
class DatumAlignment:
    """A scan on the datums of its model.

    Attributes
    ----------
    scan : the scan in mm and in the model's coordinates
    found : the pose, and how each datum is met
    names : of the datums in their order
    report : the pose as a JSON record
    """

    scan: PointCloud
    found: DatumPose
    names: tuple[str, ...]
    report: dict[str, Any]

    def table(self) -> str:
        """What was found, as text."""
        lines = [f"{'datum':<16}{'points':>9}{'rms, mm':>12}{'mean, mm':>12}{'freedoms':>10}"]
        lines += [f"{name:<16}{fit.points:>9}{fit.rms:>12.4f}{fit.mean:>12.4f}{fit.told:>10}"
                  for name, fit in zip(self.names, self.found.datums, strict=True)]
        return "\n".join([*lines, *self.report["warnings"]])


def align_on_datum_faces(model: Model | Part.Shape | str | Path | Any, scan: PointCloud | np.ndarray,
                         datums: Sequence[str], mode: str = "global", lock: Sequence[str] = (),
                         progress: Progress | None = None) -> DatumAlignment:
    """Bring a scan onto its model by datum faces in their order, each met by least squares (ISO 5459).

    Parameters
    ----------
    model : a `Model`, a file, a shape or a document object
    scan : a `PointCloud`, a file, or (n, 3) points in mm
    datums : names of faces, the primary one first: planes, cylinders, spheres
    mode : how the scan is brought near first, as for `align_scan`; with ``lock`` it is taken where it lies
    lock : single degrees of freedom that stay: tx, ty, tz, rx, ry, rz of the model's frame
    progress : called with what is being done

    Raises
    ------
    InputError : there is no such face, or it is free-form
    RefusedError : the scan does not show the primary datum
    """
    _check_locks(lock)
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model"):
        nominal, cloud = as_model(model), as_cloud(scan)
        part = as_workpiece(nominal.shape)
        if not datums or len(set(datums)) < len(datums):
            raise InputError("Datums are one to three different faces, the primary one first.")
        indices = [part.index(name) for name in datums]
        features = [feature_of(part.faces[index]) for index in indices]
    start = np.eye(4) if lock else _near(nominal, cloud, mode, progress)
    size = nominal.shape.BoundBox.DiagonalLength
    with watch.stage("align", "Meeting the datums"):
        faces = [part.geometry(index) for index in range(len(part.faces))]
        found, pose = None, start
        for _ in range(_SELECTIONS):
            own = points_of_faces(faces, indices, apply(pose, cloud.points), size)
            seen = [cloud.points[which] if len(which) >= _LEAST_POINTS else np.zeros((0, 3)) for which in own]
            if not len(seen[0]):
                raise RefusedError(f"The scan does not show {datums[0]}, the primary datum: choose another one, or "
                                   f"scan it.")
            found = align_on_datums(features, seen, pose, size, lock)
            pose = found.T_model_scan
    assert found is not None
    return _result(cloud, found, tuple(datums), watch)


def align_on_reference_points(model: Model | Part.Shape | str | Path | Any, scan: PointCloud | np.ndarray,
                              references: Sequence[ReferencePoint] | str | Path, mode: str = "global",
                              lock: Sequence[str] = (), progress: Progress | None = None) -> DatumAlignment:
    """Bring a scan onto its model by reference points, each holding along its direction.

    Parameters
    ----------
    model, scan, mode, lock, progress : as for `align_on_datum_faces`
    references : the points, or a table of them: x,y,z,nx,ny,nz and maybe tolerance, in mm

    Raises
    ------
    InputError : the table cannot be read
    RefusedError : the scan shows none of the points
    """
    _check_locks(lock)
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model"):
        nominal, cloud = as_model(model), as_cloud(scan)
        held = read_references(Path(references)) if isinstance(references, (str, Path)) else list(references)
    start = np.eye(4) if lock else _near(nominal, cloud, mode, progress)
    with watch.stage("align", "Meeting the reference points"):
        found = align_on_points(held, cloud.points, start, nominal.shape.BoundBox.DiagonalLength, lock)
    if not any(fit.points for fit in found.datums):
        raise RefusedError("The scan shows none of the reference points: align it with the model first, or scan them.")
    return _result(cloud, found, tuple(f"point {number}" for number in range(1, len(held) + 1)), watch)


def read_references(path: Path) -> list[ReferencePoint]:
    """Reference points from a table (InputError where it is none)."""
    columns = ("x", "y", "z", "nx", "ny", "nz", "tolerance")
    names, rows, _ = read_table(path, "table of reference points", columns)
    missing = [name for name in columns[:6] if name not in names]
    if missing:
        raise InputError(f"The table of reference points {path} has no column {missing[0]}: it has x,y,z,nx,ny,nz and "
                         f"maybe tolerance.")
    value = {name: rows[:, names.index(name)] for name in names}
    place, along = (np.stack([value[name] for name in three], axis=1) for three in (columns[:3], columns[3:6]))
    tolerance = value.get("tolerance", np.ones(len(rows)))
    length = np.linalg.norm(along, axis=1)
    if not (np.isfinite(rows).all() and (length > 0).all() and (tolerance > 0).all()):
        raise InputError(f"The table of reference points {path} has a direction or a tolerance that is none.")
    return [ReferencePoint(*row) for row in zip(place, along / length[:, None], tolerance.tolist(), strict=True)]


def feature_of(face: WorkpieceFace) -> DatumFeature:
    """What a face is as a datum (InputError where it is free-form)."""
    surface = face.own_surface
    if isinstance(surface, Part.Plane):
        return PlaneFeature(np.array(surface.Position), np.array(surface.Axis))
    if isinstance(surface, Part.Cylinder):
        return CylinderFeature(np.array(surface.Center), np.array(surface.Axis))
    if isinstance(surface, Part.Sphere):
        return SphereFeature(np.array(surface.Center))
    raise InputError(f"{face.name} is no datum: it is free-form or a {type(surface).__name__}; choose a plane, a "
                     f"cylinder or a sphere, or reference points.")


def _near(nominal: Model, cloud: PointCloud, mode: str, progress: Progress | None) -> Array:
    return align_scan(nominal, cloud, mode, progress).alignment.T_model_scan


def _check_locks(lock: Sequence[str]) -> None:
    unknown = [name for name in lock if name not in FREEDOMS]
    if unknown:
        raise InputError(f"The degree of freedom '{unknown[0]}' is unknown: lock some of {', '.join(FREEDOMS)}.")


def _result(cloud: PointCloud, found: DatumPose, names: tuple[str, ...], watch: Stopwatch) -> DatumAlignment:
    unseen = [f"{name} is not seen by the scan and holds nothing." for name, fit in
              zip(names, found.datums, strict=True) if not fit.points]
    loose = [f"{found.free} degrees of freedom are told by no datum and stay as they were."] if found.free else []
    pose = found.T_model_scan.tolist()
    report = {"T_model_scan": pose, "verdict": AMBIGUOUS if found.free else OK,
              "confidence": 1.0 if not (found.free or unseen) else 0.5,
              "poses": [{"T_model_scan": pose, "score": 1.0, "reason": "datums"}], "warnings": unseen + loose,
              "datums": [{"name": name, **vars(fit)} for name, fit in zip(names, found.datums, strict=True)],
              "timing": watch.times()}
    return DatumAlignment(cloud.moved(found.T_model_scan, 1.0), found, names, report)
