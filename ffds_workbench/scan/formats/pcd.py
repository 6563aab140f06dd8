# SPDX-License-Identifier: LGPL-2.1-or-later
"""Point Cloud Library PCD: ascii, binary and binary_compressed, in the precision of the file.

Read here and not with open3d because open3d silently loses double precision and cut-off rows, and crashes the process
where a compressed file is damaged.
"""
from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from .. import normals
from . import lzf, rows

_LONGEST_HEADER = 65536
_AXES = ("x", "y", "z")
_KINDS = {("F", "4"): "<f4", ("F", "8"): "<f8",
          **{(sign, size): f"<{sign.lower()}{size}" for sign in "IU" for size in "1248"}}
_SIZES = 8
"""Bytes that go before compressed points: their length and that of what they stand for."""


@dataclass(frozen=True)
class _Header:
    names: list[str]
    kinds: list[str]
    counts: list[int]
    points: int
    encoding: str
    start: int

    @property
    def widths(self) -> list[int]:
        """Bytes of each field in one point."""
        return [count * int(kind[-1]) for kind, count in zip(self.kinds, self.counts, strict=True)]

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
        first = [0, *accumulate(header.counts)]
        return rows.text(path, data, header.start, header.points, first[-1], [first[place] for place in header.places])
    if header.encoding == "binary":
        first = [0, *accumulate(header.widths)]
        return rows.binary(path, data, header.start, header.points, first[-1],
                           [(first[place], header.kinds[place]) for place in header.places])
    return _compressed(path, data, header)


def _header(path: Path, data: bytes) -> _Header:
    mark = data.find(b"\nDATA ", 0, _LONGEST_HEADER)
    newline = data.find(b"\n", mark + 1)
    if mark < 0 or newline < 0:
        raise InputError(f"The scan {path} is not a PCD file, or its header is cut off.")
    lines = [line.split() for line in data[:newline].decode("latin-1").splitlines()]
    entries = {words[0].upper(): words[1:] for words in lines if words and not words[0].startswith("#")}
    try:
        names = entries.get("FIELDS") or entries["COLUMNS"]
        kinds = [_KINDS[kind.upper(), size] for kind, size in zip(entries["TYPE"], entries["SIZE"], strict=True)]
        counts = [rows.count_of(count) for count in entries.get("COUNT", ["1"] * len(names))]
        points = rows.count_of(entries["POINTS"][0]) if "POINTS" in entries else (
            rows.count_of(entries["WIDTH"][0]) * rows.count_of(entries["HEIGHT"][0]))
        header = _Header(names, kinds, counts, points, entries["DATA"][0].lower(), newline + 1)
    except (KeyError, IndexError, ValueError) as error:
        raise InputError(f"The scan {path} is damaged: its PCD header is not complete.") from error
    if not len(names) == len(kinds) == len(counts) or min(counts) < 1 or (
            header.encoding not in ("ascii", "binary", "binary_compressed")):
        raise InputError(f"The scan {path} is damaged: its PCD header makes no sense.")
    if not set(_AXES) <= set(names):
        raise InputError(f"The scan {path} is damaged: its points have no x, y and z.")
    return header


def _compressed(path: Path, data: bytes, header: _Header) -> NDArray[np.float64]:
    """Compressed points lie field by field, all of x first."""
    packed, size = (int.from_bytes(data[at : at + 4], "little") for at in (header.start, header.start + 4))
    content = data[header.start + _SIZES : header.start + _SIZES + packed]
    try:
        if len(content) < packed or size != sum(header.widths) * header.points or size > lzf.LARGEST_GAIN * packed:
            raise ValueError("the sizes do not fit")
        plain = lzf.decompress(content, size)
    except ValueError as error:
        raise InputError(f"The scan {path} is damaged or cut off: its compressed points cannot be unpacked.") from error
    first = [0, *accumulate(width * header.points for width in header.widths)]
    return np.hstack([rows.binary(path, plain, first[place], header.points, header.widths[place],
                                  [(0, header.kinds[place])]) for place in header.places])
