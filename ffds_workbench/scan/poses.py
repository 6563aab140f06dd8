# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigid motions that users give: checked, and read from JSON."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..registration.arrays import Array

_KEY = "T_model_scan"


def as_pose(matrix: Any, of_what: str) -> Array:
    """A motion (4, 4), a rotation and a shift in mm.

    Raises
    ------
    InputError : it is not a motion; ``of_what`` begins the sentence
    """
    try:
        pose = np.asarray(matrix, dtype=float)
    except (TypeError, ValueError):
        pose = np.empty(0)
    if pose.shape != (4, 4) or not np.isfinite(pose).all() or not (
            np.allclose(pose[3], [0.0, 0.0, 0.0, 1.0])
            and np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-6) and np.linalg.det(pose[:3, :3]) > 0):
        raise InputError(f"{of_what} is no pose: give a (4, 4) matrix of a rotation and a shift in mm.")
    return pose


def read_poses(path: Path) -> tuple[Array, ...]:
    """The poses of several scans, (4, 4) each.

    Parameters
    ----------
    path : of a JSON list of matrices, or of what ``ffds align --pose`` writes of each

    Raises
    ------
    InputError : the file cannot be read, or holds something else
    """
    try:
        content = json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise InputError(f"The poses {path} cannot be read: {error.strerror}.") from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"The poses {path} are no JSON.") from error
    if not isinstance(content, list):
        raise InputError(f"The poses {path} are no list: write one (4, 4) matrix for each scan, in their order.")
    matrices = [entry.get(_KEY) if isinstance(entry, dict) else entry for entry in content]
    return tuple(as_pose(matrix, f"Entry {number} of {path}") for number, matrix in enumerate(matrices, 1))
