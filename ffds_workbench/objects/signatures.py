# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that are found again after their part was changed: FreeCAD numbers them anew when one is added or removed."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import Part

from ..errors import InputError

_SAME_PLACE, _SAME_AREA = 1e-3, 0.01
"""The same face: its centre moved by less than this share of the part's size, its area changed by less than that."""


def signatures(shape: Part.Shape, names: Sequence[str]) -> list[str]:
    """One line per named face: its name, how many faces there are, its kind, centre (mm) and area (mm²)."""
    return [f"{name} {len(shape.Faces)} {_line(shape.Faces[int(name[4:]) - 1])}" for name in names]


def found_again(lines: Sequence[str], shape: Part.Shape, label: str) -> dict[str, str]:
    """New names of faces by their old ones; names stay while the number of faces does.

    Raises
    ------
    InputError : a face is not found, or several could be it
    """
    renamed = {}
    for line in lines:
        name, count, signature = line.split(" ", 2)
        if int(count) == len(shape.Faces):
            renamed[name] = name
            continue
        like = [k for k, face in enumerate(shape.Faces, 1) if _is_same(signature, _line(face), shape)]
        if len(like) != 1:
            raise InputError(f"{label} has other faces than before, and {name} is not among them: choose the faces "
                             f"anew.")
        renamed[name] = f"Face{like[0]}"
    return renamed


def _line(face: Part.Face) -> str:
    centre = face.CenterOfMass
    return f"{type(face.Surface).__name__} {centre.x:.9g} {centre.y:.9g} {centre.z:.9g} {face.Area:.9g}"


def _parsed(signature: str) -> tuple[str, np.ndarray]:
    """The kind that a signature names, and its numbers (4,)."""
    kind, *numbers = signature.split()
    return kind, np.array(numbers, dtype=float)


def _is_same(first: str, second: str, shape: Part.Shape) -> bool:
    kind, a = _parsed(first)
    other, b = _parsed(second)
    size = shape.BoundBox.DiagonalLength
    return kind == other and np.linalg.norm(a[:3] - b[:3]) < _SAME_PLACE * size and abs(a[3] - b[3]) < _SAME_AREA * a[3]
