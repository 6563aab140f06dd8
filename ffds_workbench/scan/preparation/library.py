# SPDX-License-Identifier: LGPL-2.1-or-later
"""open3d, loaded when a step needs it (half a second), with an error that says where it is missing."""
from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array


def open3d(step: str) -> Any:
    """The library, for a step that is named in the error (InputError where it is not installed)."""
    try:
        return importlib.import_module("open3d")
    except ImportError as error:
        raise InputError(f"open3d is not installed, and {step} needs it: install it (Debian: python3-open3d), or leave "
                         f"this step out.") from error


def cloud(library: Any, points: Array, normals: Array | None = None) -> Any:
    """Points (n, 3), and normals (n, 3), as open3d holds them, in double precision."""
    result = library.geometry.PointCloud(library.utility.Vector3dVector(np.ascontiguousarray(points)))
    if normals is not None:
        result.normals = library.utility.Vector3dVector(np.ascontiguousarray(normals))
    return result
