# SPDX-License-Identifier: LGPL-2.1-or-later
"""ASTM E57, read by FreeCAD's own importer.

FreeCAD keeps points in single precision. A cloud whose coordinates are too large for that is refused rather than
read with steps in it.
"""
from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import _freecad
from ..errors import InputError

_STEPS_PER_SIZE = 1e5


def read(path: Path) -> NDArray[np.float64]:
    """The points of all scans in the file, (n, 3), as the file holds them.

    Raises
    ------
    InputError : not an E57 file, damaged, or with coordinates too large for single precision
    """
    if not path.read_bytes()[:8] == b"ASTM-E57":
        raise InputError(f"the scan {path} is not an E57 file")
    _freecad.activate()
    import FreeCAD
    import Points

    document = FreeCAD.newDocument("FFDS_scan", hidden=True, temp=True)
    try:
        Points.insert(str(path), document.Name)
        clouds = [_array(item.Points) for item in document.Objects if hasattr(item, "Points")]
    except (RuntimeError, OSError, FreeCAD.Base.FreeCADError) as error:
        raise InputError(f"the scan {path} is damaged: FreeCAD cannot read this E57 file") from error
    finally:
        FreeCAD.closeDocument(document.Name)
    points = np.concatenate([np.empty((0, 3)), *clouds])
    _check_precision(path, points)
    return points


def _array(points: object) -> NDArray[np.float64]:
    return np.array([(p.x, p.y, p.z) for p in points.Points], dtype=np.float64).reshape(-1, 3)  # type: ignore[attr-defined]


def _check_precision(path: Path, points: NDArray[np.float64]) -> None:
    finite = points[np.isfinite(points).all(axis=1)]
    if len(finite) < 2:
        return
    step = np.spacing(np.float32(np.abs(finite).max()))
    if step * _STEPS_PER_SIZE > np.linalg.norm(np.ptp(finite, axis=0)):
        raise InputError(f"the scan {path} lies too far from its origin for FreeCAD's single precision: move it "
                         f"there, or save it as PLY with double precision")
