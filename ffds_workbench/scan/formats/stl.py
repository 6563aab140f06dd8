# SPDX-License-Identifier: LGPL-2.1-or-later
"""STL, ascii and binary: the corners of the triangles, each of them once, with the mean normals of their triangles.

Read here and not with open3d because open3d rounds the numbers of an ascii file to single precision and takes a damaged
file for an empty one.
"""
from __future__ import annotations

import io
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER = 84
_TOGETHER = 1 << 16
"""Triangles whose normals are computed at a time: what that needs besides them would be several times the file."""
_LAST = 1024
"""Bytes at the end of the file among which its text says that it ends."""


def read(path: Path) -> NDArray[np.float64]:
    """The different corners and the normals there, (n, 6), in the order of their first appearance.

    Raises
    ------
    InputError : not an STL file, or truncated
    """
    return _merged(triangles(path))


def triangles(path: Path) -> NDArray[np.floating]:
    """The corners of the triangles in the order of the file, (m, 3, 3). Raises as `read` does."""
    data = path.read_bytes()
    count = int.from_bytes(data[80:_HEADER], "little") if len(data) >= _HEADER else -1
    if count >= 0 and len(data) == _HEADER + count * _FACET.itemsize:
        return np.asarray(np.frombuffer(data, _FACET, count, _HEADER)["corners"])
    if data.lstrip()[:5].lower() == b"solid":
        return _ascii(path, data)
    if count > 0 and len(data) > _HEADER:
        raise InputError(f"The scan {path} is cut off or no STL file: it promises {count} triangles and its length "
                         f"does not fit.")
    raise InputError(f"The scan {path} is not an STL file.")


def _merged(triangles: NDArray[np.floating]) -> NDArray[np.float64]:
    """The different corners of triangles (m, 3, 3) with unit normals, to which larger ones contribute more: (n, 6).

    The order of a triangle's corners tells its side; the normals that the file holds besides are often missing.
    """
    corners = triangles.reshape(-1, 3)
    first, number = _different(corners)
    normal = np.concatenate([np.zeros((0, 3)), *(_across(triangles[start : start + _TOGETHER])
                                                 for start in range(0, len(triangles), _TOGETHER))])
    points = np.empty((len(first), 6))
    points[:, :3] = corners[first]
    for axis in range(3):
        points[:, 3 + axis] = np.bincount(number, np.repeat(normal[:, axis], 3), len(first))
    length = np.linalg.norm(points[:, 3:], axis=1, keepdims=True)
    points[:, 3:] /= np.where(length > 0, length, 1.0)
    return points


def _different(corners: NDArray[np.floating]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Where each different corner stands first, ascending, and for every corner (n, 3) which of these it is."""
    order = np.lexsort(corners.T)  # stable: of equal corners the first comes first
    in_order = corners[order]
    different = np.append(True, (in_order[1:] != in_order[:-1]).any(axis=1))[: len(order)]
    first = order[different]
    rank = np.empty(len(first), dtype=np.intp)
    rank[np.argsort(first)] = np.arange(len(first))
    number = np.empty(len(order), dtype=np.intp)
    number[order] = rank[np.cumsum(different) - 1]
    return np.sort(first), number


def _across(triangles: NDArray[np.floating]) -> NDArray[np.float64]:
    """Normals of triangles (m, 3, 3), as long as twice their areas: (m, 3)."""
    a, b, c = triangles.astype(np.float64).transpose(1, 0, 2)
    return np.cross(b - a, c - a)


def _ascii(path: Path, data: bytes) -> NDArray[np.float64]:
    if b"endsolid" not in data[-_LAST:].lower():
        raise InputError(f"The scan {path} is cut off: its STL text has no end.")
    lines = io.TextIOWrapper(io.BytesIO(data), "latin-1")
    corners = (line for line in lines if line.lstrip()[:6].lower() == "vertex")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # "input contained no data"
            return np.loadtxt(corners, usecols=(1, 2, 3), ndmin=2, comments=None).reshape(-1, 3, 3)
    except ValueError as error:
        raise InputError(f"The scan {path} is damaged: a corner is not made of three numbers.") from error
