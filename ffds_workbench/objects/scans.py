# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scans in a document: Points objects to point clouds and back, in the document's coordinates.

Normals are kept as FreeCAD's own import keeps them: in the property Normal, where a scan has them.
"""
from __future__ import annotations

import io
import zipfile
from typing import Any

import FreeCAD
import numpy as np
import Points
from numpy.typing import NDArray

from ..brep.model_files import outer_placement
from ..errors import InputError
from ..scan.cloud import PointCloud
from ..scan.normals import unit_normals
from . import views

Array = NDArray[np.float64]

_NORMAL = "Normal"
_VECTORS = """<Content>
<VectorList file="Normal"/>
</Content>"""
_INDEX = """<Content>
<Points file="Points" mtrx="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 "/>
</Content>"""
_FAR_FROM_ORIGIN = 1000.0
"""A scan farther from the origin than this (mm) is stored about a local origin: documents hold points as float32."""


def is_scan(item: Any) -> bool:
    """Whether a document object is a point cloud."""
    return item is not None and item.isDerivedFrom("Points::Feature")


def scan_points(item: Any) -> Array:
    """The points of `scan_cloud`, (n, 3) in mm."""
    return scan_cloud(item).points


def scan_cloud(item: Any) -> PointCloud:
    """The scan of a Points object in the document's coordinates; points that are not finite left out.

    Raises
    ------
    InputError : the object is no point cloud, or an empty one
    """
    if not is_scan(item):
        raise InputError(f"{getattr(item, 'Label', 'The scan')} is no point cloud: select a Points object as the scan.")
    rows = _rows(item.Points.dumpContent(0))
    finite = np.isfinite(rows).all(axis=1)
    if not finite.any():
        raise InputError(f"{item.Label} holds no points: import the scan anew.")
    normals = _rows(item.dumpPropertyContent(_NORMAL, Compression=0)) if _has_normals(item) else rows[:0]
    return _stored(rows[finite], normals[finite] if len(normals) == len(rows) else None,
                   item.getGlobalPlacement())


def add_scan(document: Any, points: Array, label: str, normals: Array | None = None) -> Any:
    """A new Points object of points (n, 3) in mm, and their unit normals if there are any."""
    item = document.addObject("Points::Feature", "Scan")
    item.Label = label
    set_points(item, points, normals)
    views.dress(item, None)
    item.purgeTouched()
    return item


def set_points(item: Any, points: Array, normals: Array | None = None) -> None:
    """Replace the points of a Points object by (n, 3) in the coordinates of what holds it; its placement is reset."""
    origin = _origin(points)
    item.Points = _kernel(points - origin)
    item.Placement = FreeCAD.Placement(FreeCAD.Vector(*origin.tolist()), FreeCAD.Rotation())
    if normals is not None:
        if not _has_normals(item):
            item.addProperty("Points::PropertyNormalList", _NORMAL, "Points", "The normals of the points")
        item.restorePropertyContent(_NORMAL, _content(_VECTORS, _NORMAL, normals))
    elif _has_normals(item):
        setattr(item, _NORMAL, [])


def as_stored(item: Any, scan: PointCloud) -> PointCloud:
    """What `scan_cloud` will give after ``set_points(item, scan.points, scan.normals)``."""
    origin = _origin(scan.points)
    placement = FreeCAD.Placement(FreeCAD.Vector(*origin.tolist()), FreeCAD.Rotation())
    normals = None if scan.normals is None else scan.normals.astype(np.float32).astype(float)
    return _stored((scan.points - origin).astype(np.float32).astype(float), normals,
                   outer_placement(item).multiply(placement))


def _stored(points: Array, normals: Array | None, placement: FreeCAD.Placement) -> PointCloud:
    return PointCloud(points, normals=None if normals is None else unit_normals(normals)).moved(_matrix(placement))


def _has_normals(item: Any) -> bool:
    return _NORMAL in item.PropertiesList and item.getTypeIdOfProperty(_NORMAL) == "Points::PropertyNormalList"


def _origin(points: Array) -> Array:
    return np.round(np.median(points, axis=0)) if np.abs(points).max() > _FAR_FROM_ORIGIN else np.zeros(3)


def _kernel(points: Array) -> Points.Points:
    """Points as FreeCAD's own, by way of its file format: adding them one by one takes 50 times as long."""
    kernel = Points.Points()
    kernel.restoreContent(_content(_INDEX, "Points", points))
    return kernel


def _content(index: str, name: str, rows: Array) -> bytes:
    """Rows (n, 3) as FreeCAD saves them: an index and a file of single precision."""
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("Persistence.xml", index)
        archive.writestr(name, np.uint32(len(rows)).tobytes() + rows.astype("<f4").tobytes())
    return memory.getvalue()


def _rows(content: bytes) -> Array:
    """The rows (n, 3) in what FreeCAD saves."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        stream = archive.read(archive.namelist()[-1])
    return np.frombuffer(stream, np.float32, offset=4)[: 3 * (len(stream) // 12)].reshape(-1, 3).astype(float)


def _matrix(placement: FreeCAD.Placement) -> Array:
    return np.array(placement.toMatrix().A).reshape(4, 4)
