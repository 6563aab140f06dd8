# SPDX-License-Identifier: LGPL-2.1-or-later
"""Point Cloud Library PCD: ascii, binary and binary_compressed, in the precision of the file.

Only the decompression is left to open3d: its reader of plain files loses doubles and cut-off rows without a word.
"""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from . import normals

_LONGEST_HEADER = 65536
_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class _Header:
    names: list[str]
    kinds: list[str]
    counts: list[int]
    points: int
    encoding: str
    start: int

    @property
    def dtype(self) -> np.dtype:
        """One point; padding fields ("_") may repeat, so the fields are named by their place."""
        return np.dtype([(str(place), kind, (count,)) for place, (kind, count)
                         in enumerate(zip(self.kinds, self.counts, strict=True))])

    @property
    def places(self) -> list[int]:
        """Of x, y and z among the fields, and of the normal's components where there are any."""
        return [*map(self.names.index, _AXES), *normals.columns(self.names)]


def read(path: Path) -> NDArray[np.float64]:
    """The points as the file holds them, (n, 3), or (n, 6) with normals; with the NaN rows of organised clouds.

    Raises
    ------
    InputError : not a PCD file, truncated, or without x, y and z
    """
    data = path.read_bytes()
    header = _header(path, data)
    if header.points == 0:
        return np.empty((0, 3))
    if header.encoding == "ascii":
        return _ascii(path, data[header.start :], header)
    if header.encoding == "binary":
        found = (len(data) - header.start) // header.dtype.itemsize
        if found < header.points:
            raise _truncated(path, header.points, found)
        rows = np.frombuffer(data, header.dtype, header.points, header.start)
        return np.stack([rows[str(place)][:, 0].astype(np.float64) for place in header.places], axis=1)
    return _compressed(path, header)


def _header(path: Path, data: bytes) -> _Header:
    mark = data.find(b"\nDATA ", 0, _LONGEST_HEADER)
    newline = data.find(b"\n", mark + 1)
    if mark < 0 or newline < 0:
        raise InputError(f"The scan {path} is not a PCD file, or its header is cut off.")
    lines = [line.split() for line in data[:newline].decode("latin-1").splitlines()]
    entries = {words[0].upper(): words[1:] for words in lines if words and not words[0].startswith("#")}
    try:
        names = entries.get("FIELDS") or entries["COLUMNS"]
        kinds = ["<" + kind.lower() + size for kind, size in zip(entries["TYPE"], entries["SIZE"], strict=True)]
        counts = [int(count) for count in entries.get("COUNT", ["1"] * len(names))]
        points = int(entries["POINTS"][0]) if "POINTS" in entries else (
            int(entries["WIDTH"][0]) * int(entries["HEIGHT"][0]))
        header = _Header(names, kinds, counts, points, entries["DATA"][0].lower(), newline + 1)
        usable = header.dtype.itemsize > 0 and len(names) == len(kinds) and points >= 0
    except (KeyError, IndexError, ValueError, TypeError) as error:
        raise InputError(f"The scan {path} is damaged: its PCD header is not complete.") from error
    if not usable or header.encoding not in ("ascii", "binary", "binary_compressed"):
        raise InputError(f"The scan {path} is damaged: its PCD header makes no sense.")
    if not set(_AXES) <= set(names):
        raise InputError(f"The scan {path} is damaged: its points have no x, y and z.")
    return header


def _ascii(path: Path, data: bytes, header: _Header) -> NDArray[np.float64]:
    lines = [line for line in data.decode("latin-1").splitlines() if line.strip()]
    if lines and len(lines[-1].split()) < sum(header.counts):
        lines = lines[:-1]
    if len(lines) < header.points:
        raise _truncated(path, header.points, len(lines))
    first = np.concatenate([[0], np.cumsum(header.counts)])
    columns = [int(first[place]) for place in header.places]
    try:
        return np.loadtxt(lines[: header.points], usecols=columns, ndmin=2, comments=None)
    except ValueError as error:
        raise InputError(f"The scan {path} is damaged: a point is not made of numbers.") from error


def _compressed(path: Path, header: _Header) -> NDArray[np.float64]:
    import open3d

    with open3d.utility.VerbosityContextManager(open3d.utility.VerbosityLevel.Error):
        cloud = open3d.t.io.read_point_cloud(str(path), format="pcd")
    if "positions" not in cloud.point or len(cloud.point["positions"]) != header.points:
        raise InputError(f"The scan {path} is damaged or cut off: its compressed points cannot be unpacked.")
    wanted = ["positions", "normals"] if "normals" in cloud.point else ["positions"]
    return np.hstack([cloud.point[name].numpy().astype(np.float64) for name in wanted])


def _truncated(path: Path, promised: int, found: int) -> InputError:
    return InputError(f"The scan {path} is cut off: its header promises {promised} points, {found} are there.")
