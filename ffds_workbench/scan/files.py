# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scan files of every supported format, read into one point cloud in mm.

Each format has a module of its own whose ``read(path)`` returns the coordinates as the file holds them, (n, 3)
float64, or (n, 6) with its normals after them; units, non-finite rows and unusable files are handled here, once.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .cloud import FARTHEST, PointCloud
from .formats import e57, foreign, pcd, ply, stl, text
from .normals import fused, unit_normals
from .units import MILLIMETRES

_READERS: dict[str, Callable[[Path], NDArray[np.float64]]] = {
    ".ply": ply.read, ".pcd": pcd.read, ".stl": stl.read, ".e57": e57.read,
    ".las": foreign.las, ".laz": foreign.las, ".obj": foreign.obj,
    ".xyz": text.read, ".asc": text.read, ".txt": text.read, ".csv": text.read, ".pts": text.read,
}
FORMATS = tuple(_READERS)


def read(paths: str | Path | Sequence[str | Path], unit: str = "mm") -> PointCloud:
    """Read one scan, or fuse several scans of one part that share a coordinate system.

    Parameters
    ----------
    paths : one file or several, of the `FORMATS`
    unit : unit of the files' coordinates: "mm", "cm", "m" or "in"

    Raises
    ------
    InputError : a file is missing, damaged, of an unknown format, or holds no scan; the unit is unknown
    """
    if unit not in MILLIMETRES:
        raise InputError(f"The scan unit '{unit}' is unknown: use one of {', '.join(MILLIMETRES)}.")
    files = [paths] if isinstance(paths, (str, Path)) else list(paths)
    if not files:
        raise InputError("No scan file was named.")
    clouds = [_read_one(Path(path)) for path in files]
    points = np.concatenate([cloud.points for cloud in clouds]) * MILLIMETRES[unit]
    normals = fused([cloud.normals for cloud in clouds], [len(cloud.points) for cloud in clouds])
    return PointCloud(points, sum(cloud.dropped for cloud in clouds), unit, normals)


def _read_one(path: Path) -> PointCloud:
    reader = _READERS.get(path.suffix.lower())
    if path.is_dir():
        raise InputError(f"The scan {path} is a folder: name a file.")
    if not path.exists():
        raise InputError(f"The scan {path} does not exist.")
    if reader is None:
        raise InputError(f"The scan {path} is of an unknown format: use one of {' '.join(FORMATS)}.")
    try:
        if path.stat().st_size == 0:
            raise InputError(f"The scan {path} is empty.")
        with np.errstate(all="ignore"):  # what is not finite is dropped below
            rows = reader(path)
    except OSError as error:
        raise InputError(f"The scan {path} cannot be read: {error.strerror or error}.") from error
    return _usable(path, rows)


def _usable(path: Path, rows: NDArray[np.float64]) -> PointCloud:
    """Only finite points of plausible size; a file without two different points is refused."""
    finite = (np.abs(rows[:, :3]) < FARTHEST).all(axis=1)
    points = np.ascontiguousarray(rows[finite, :3], dtype=np.float64)
    dropped = int(len(rows) - len(points))
    if len(points) == 0:
        lost = f" (its {dropped} rows are not finite numbers)" if dropped else ""
        raise InputError(f"The scan {path} holds no points{lost}: nothing can be registered to it.")
    if len(points) == 1:
        raise InputError(f"The scan {path} holds a single point: a scan needs many.")
    if not np.ptp(points, axis=0).any():
        raise InputError(f"The scan {path} is not a scan: all its {len(points)} points are the same.")
    return PointCloud(points, dropped, normals=unit_normals(rows[finite, 3:]) if rows.shape[1] > 3 else None)
