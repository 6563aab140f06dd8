# SPDX-License-Identifier: LGPL-2.1-or-later
"""The inputs of the jobs: models, scans and requests, in any form that callers have them in."""
from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ..brep import workpiece
from ..brep.model_files import Model, model_file
from ..brep.simulated_scan import surface_samples
from ..brep.workpiece import Workpiece
from ..errors import InputError
from ..registration.request import RegistrationRequest
from ..scan import sensor_profile
from ..scan import files as scan_files
from ..scan.cloud import PointCloud
from ..scan.plausibility import check_overlap

_PARTS: deque[Workpiece] = deque(maxlen=2)


def read_scan(paths: str | Path | Sequence[str | Path], unit: str = "mm") -> PointCloud:
    """Read one scan file, or fuse several of one part: points (n, 3) in mm.

    Parameters
    ----------
    paths : of the files
    unit : of the files: "mm", "cm", "m" or "in"

    Raises
    ------
    InputError : a file cannot be read, or holds no points
    """
    return scan_files.read(paths, unit)


def read_model(path: str | Path, label: str | None = None) -> Model:
    """Read a model file, in mm.

    Parameters
    ----------
    path : of a STEP, BREP, IGES or FCStd file
    label : of the object in a FreeCAD document that holds several

    Raises
    ------
    InputError : the file cannot be read, or holds no faces, or no such object
    """
    return model_file.read(path, label)


def as_model(model: Model | Part.Shape | str | Path | object) -> Model:
    """A model in any of the forms that the jobs take."""
    if isinstance(model, (str, Path)):
        return read_model(model)
    return model if isinstance(model, Model) else model_file.from_object(model)


def as_cloud(scan: PointCloud | np.ndarray | str | Path) -> PointCloud:
    """A scan in any of the forms that the jobs take; a file is one in mm."""
    if isinstance(scan, (str, Path)):
        return read_scan(scan)
    if isinstance(scan, PointCloud):
        return scan
    points = np.asarray(scan, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise InputError(f"A scan is an array of shape (n, 3), not {points.shape}.")
    finite = np.isfinite(points).all(axis=1)
    return PointCloud(points[finite], int((~finite).sum()))


def as_request(faces: Sequence[str] | None = None, **settings: Any) -> RegistrationRequest:
    """A request of plain values, as macros and the command line have them.

    Parameters
    ----------
    faces, settings : as in `RegistrationRequest`; lists do for tuples, and a preset's name or a file for the sensor

    Raises
    ------
    InputError : as `RegistrationRequest` does, or the sensor cannot be read
    """
    plain: dict[str, Any] = {"faces": faces, **settings}
    for name in ("faces", "freeze"):
        if plain.get(name) is not None:
            plain[name] = tuple(dict.fromkeys(plain[name]))
    if not isinstance(plain.get("lattice", ""), str):
        plain["lattice"] = tuple(int(count) for count in plain["lattice"])
    if plain.get("sensor") is not None:
        plain["sensor"] = sensor_profile.find(plain["sensor"])
    try:
        return RegistrationRequest(**plain)
    except TypeError as unknown:
        raise InputError(f"A registration has no such setting: {unknown}.") from None


def as_workpiece(shape: Part.Shape) -> Workpiece:
    """A shape read; the last ones are kept, for the next scan of the same part (InputError where it has no faces)."""
    for known in _PARTS:
        if known.shape.isEqual(shape):
            return known
    part = workpiece.read(shape)
    _PARTS.appendleft(part)
    return part


def check_place(scan: PointCloud, model: Model) -> None:
    """Refuse a scan that cannot be one of the model where it lies, or that is in another unit; see `check_overlap`."""
    check_overlap(scan, *box(model.shape), lambda: surface_samples(model.shape), model.unit)


def box(shape: Part.Shape) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest coordinates of a shape, (3,) each, in mm."""
    bounds = shape.BoundBox
    return np.array([bounds.XMin, bounds.YMin, bounds.ZMin]), np.array([bounds.XMax, bounds.YMax, bounds.ZMax])
