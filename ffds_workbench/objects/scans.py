# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scans in a document: Points objects to arrays and back, in the document's coordinates."""
from __future__ import annotations

import io
import zipfile
from typing import Any

import FreeCAD
import numpy as np
import Points
from numpy.typing import NDArray

from ..brep.files import outer_placement
from ..errors import InputError

Array = NDArray[np.float64]

_INDEX = """<Content>
<Points file="Points" mtrx="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 "/>
</Content>"""
_FAR = 1000.0
"""A scan farther from the origin than this (mm) is stored about a local origin: documents hold points as float32."""


def is_scan(item: Any) -> bool:
    """Whether a document object is a point cloud."""
    return item is not None and item.isDerivedFrom("Points::Feature")


def scan_points(item: Any) -> Array:
    """The points of a Points object in the document's coordinates, (n, 3) in mm; rows that are not finite left out.

    Raises
    ------
    InputError : the object is no point cloud, or an empty one
    """
    if not is_scan(item):
        raise InputError(f"{getattr(item, 'Label', 'The scan')} is no point cloud: select a Points object as the scan.")
    with zipfile.ZipFile(io.BytesIO(item.Points.dumpContent(0))) as archive:
        stream = archive.read(archive.namelist()[-1])
    rows = np.frombuffer(stream, np.float32, offset=4)[: 3 * (len(stream) // 12)].reshape(-1, 3).astype(float)
    points = rows[np.isfinite(rows).all(axis=1)]
    if not len(points):
        raise InputError(f"{item.Label} holds no points: import the scan anew.")
    matrix = _matrix(item.getGlobalPlacement())
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def add_scan(document: Any, points: Array, label: str) -> Any:
    """A new Points object of points (n, 3) in mm."""
    item = document.addObject("Points::Feature", "Scan")
    item.Label = label
    set_points(item, points)
    return item


def set_points(item: Any, points: Array) -> None:
    """Replace the points of a Points object by (n, 3) in the coordinates of what holds it; its placement is reset."""
    origin = _origin(points)
    item.Points = _kernel(points - origin)
    item.Placement = FreeCAD.Placement(FreeCAD.Vector(*origin.tolist()), FreeCAD.Rotation())


def as_stored(item: Any, points: Array) -> Array:
    """What `scan_points` will give after ``set_points(item, points)``."""
    origin = _origin(points)
    placement = FreeCAD.Placement(FreeCAD.Vector(*origin.tolist()), FreeCAD.Rotation())
    matrix = _matrix(outer_placement(item).multiply(placement))
    rows = (points - origin).astype(np.float32).astype(float)
    return rows @ matrix[:3, :3].T + matrix[:3, 3]


def _origin(points: Array) -> Array:
    return np.round(np.median(points, axis=0)) if np.abs(points).max() > _FAR else np.zeros(3)


def _kernel(points: Array) -> Points.Points:
    """Points as FreeCAD's own, by way of its file format: adding them one by one takes 50 times as long."""
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("Persistence.xml", _INDEX)
        archive.writestr("Points", np.uint32(len(points)).tobytes() + points.astype("<f4").tobytes())
    kernel = Points.Points()
    kernel.restoreContent(memory.getvalue())
    return kernel


def _matrix(placement: FreeCAD.Placement) -> Array:
    return np.array(placement.toMatrix().A).reshape(4, 4)
