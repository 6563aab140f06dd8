# SPDX-License-Identifier: LGPL-2.1-or-later
"""The normals in scan files: the names of their columns, and which numbers are normals at all."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NAMES = (("nx", "ny", "nz"), ("normal_x", "normal_y", "normal_z"))
_UNIT, _NEARLY_ALL = 1e-2, 0.95
"""Rows are of unit length within the first. Where no more than the second of those that are not zero are, they are
colours or something else."""


def columns(names: Sequence[str]) -> list[int]:
    """Places of the normal's three components among the names of a file's columns; none without normals."""
    for wanted in _NAMES:
        if set(wanted) <= set(names):
            return [names.index(name) for name in wanted]
    return []


def unit_normals(rows: Array) -> Array | None:
    """Rows (n, 3) as unit normals, zero where a row is none; None where they are no normals."""
    with np.errstate(over="ignore"):  # columns of anything
        length = np.linalg.norm(rows, axis=1)
    unit = np.abs(length - 1.0) < _UNIT
    if unit.sum() <= _NEARLY_ALL * (length != 0.0).sum():
        return None
    return np.where(unit[:, None], rows, 0.0) / np.where(unit, length, 1.0)[:, None]


def fused(normals: Sequence[Array | None], counts: Sequence[int]) -> Array | None:
    """The normals of several scans of ``counts`` points one after the other, zero for scans without; None without any.
    """
    if all(part is None for part in normals):
        return None
    return np.concatenate([np.zeros((count, 3)) if part is None else part
                           for part, count in zip(normals, counts, strict=True)])
