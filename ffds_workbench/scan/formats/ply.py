# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stanford PLY: the vertices and their normals, in the precision of the file, whatever else the file holds.

Read here and not with open3d because open3d fills the missing rows of a truncated file with numbers of its own.
"""
from __future__ import annotations

from dataclasses import dataclass, field
from itertools import accumulate
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from .. import normals
from . import rows

_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
          "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
          "double": "f8", "float64": "f8"}
_ORDER = {"binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 65536


@dataclass
class _Element:
    name: str
    count: int
    properties: list[tuple[str, str]] = field(default_factory=list)
    has_list: bool = False

    @property
    def places(self) -> list[int]:
        """Where in a row each property begins, in bytes, and the length of the row."""
        return [0, *accumulate(int(kind[1]) for _, kind in self.properties)]


def read(path: Path) -> NDArray[np.float64]:
    """The vertices as the file holds them, (n, 3), or (n, 6) with normals; the rest of the file is skipped.

    Raises
    ------
    InputError : not a PLY file, truncated, or without x, y and z
    """
    data = path.read_bytes()
    encoding, elements, start = _header(path, data)
    before = []
    for element in elements:
        if element.name == "vertex":
            break
        before.append(element)
    else:
        raise InputError(f"The scan {path} has no vertices: nothing can be registered to it.")
    names = [name for name, _ in element.properties]
    if not {"x", "y", "z"} <= set(names):
        raise InputError(f"The scan {path} is damaged: its vertices have no x, y and z.")
    if element.has_list or len(set(names)) < len(names) or any(other.has_list for other in before):
        raise InputError(f"The scan {path} has vertices of an unusual layout: save it as plain points.")
    columns = [*map(names.index, "xyz"), *normals.columns(names)]
    if element.count == 0:
        return np.empty((0, 3))
    if encoding == "ascii":
        return rows.text(path, data, start, element.count, len(names), columns, sum(other.count for other in before))
    start += sum(other.count * other.places[-1] for other in before)
    fields = [(element.places[column], _ORDER[encoding] + element.properties[column][1]) for column in columns]
    return rows.binary(path, data, start, element.count, element.places[-1], fields)


def _header(path: Path, data: bytes) -> tuple[str, list[_Element], int]:
    """Encoding, elements and the offset of the first byte of data."""
    end = data.find(b"end_header", 0, _LONGEST_HEADER)
    newline = data.find(b"\n", end)
    if not data.startswith(b"ply") or end < 0 or newline < 0:
        raise InputError(f"The scan {path} is not a PLY file, or its header is cut off.")
    encoding = ""
    elements: list[_Element] = []
    try:
        for line in data[:end].decode("latin-1").splitlines():
            words = line.split()
            if words[:1] == ["format"]:
                encoding = words[1]
            elif words[:1] == ["element"]:
                elements.append(_Element(words[1], rows.count_of(words[2])))
            elif words[:2] == ["property", "list"]:
                elements[-1].has_list = True
            elif words[:1] == ["property"]:
                elements[-1].properties.append((words[2], _TYPES[words[1]]))
    except (IndexError, KeyError, ValueError) as error:
        raise InputError(f"The scan {path} is damaged: its PLY header has the line '{line.strip()[:60]}'.") from error
    if encoding != "ascii" and encoding not in _ORDER:
        raise InputError(f"The scan {path} is damaged: its PLY header names no known format.")
    return encoding, elements, newline + 1
