# SPDX-License-Identifier: LGPL-2.1-or-later
"""The alignment of a scan from points picked on it and on the part: for scans that are not aligned automatically."""
from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ... import api
from ...brep.model_files import model_file
from ...errors import InputError
from ...registration.rigid import pose_of_pairs
from ...report.stopwatch import Progress
from ..scans import scan_cloud, set_points
from ..sources import standing_for

Picks = Sequence[tuple[float, float, float]]

_last: dict[str, api.PointCloud] = {}


def align_by_points(source: Any, scan: Any, on_scan: Picks, on_part: Picks, refine: bool = True) -> Any:
    """Move a scan onto a part, starting where three or more picked pairs of points meet. Returns the scan.

    Parameters
    ----------
    source, scan : the part and the Points object
    on_scan, on_part : (x, y, z) in mm in the document's coordinates, pair by pair
    refine : go on from there by a fine alignment; else the points alone decide

    Raises
    ------
    InputError : the points, the part or the scan cannot be used
    RefusedError : the fine alignment finds no pose there that explains the scan
    """
    found = prepare(source, scan, on_scan, on_part, refine)(None)
    set_points(scan, found.points, found.normals)
    return scan


def prepare(source: Any, scan: Any, on_scan: Picks, on_part: Picks,
            refine: bool = True) -> Callable[[Progress | None], api.PointCloud]:
    """The alignment as a function that touches no document, for any thread (call this on the main thread).

    It gives the scan on the part, in the document's coordinates.

    Raises
    ------
    InputError : as `align_by_points` does
    """
    start = pose_of_pairs(np.array(on_scan, dtype=float), np.array(on_part, dtype=float))
    cloud, model = scan_cloud(scan), model_file.from_object(standing_for(source))
    if scan.getParentGeoFeatureGroup() is not None:
        raise InputError(f"{scan.Label} lies in a part: drag it out into the document before aligning it.")
    key = hashlib.blake2b(model.shape.exportBrepToString().encode() + cloud.tobytes() + start.tobytes()
                          + bytes([refine])).hexdigest()

    def run(progress: Progress | None = None) -> api.PointCloud:
        if not refine:
            return cloud.moved(start)
        if key not in _last:
            found = api.align_scan(model, cloud, "fine", progress, start).scan
            _last.clear()
            _last[key] = found
        return _last[key]

    return run
