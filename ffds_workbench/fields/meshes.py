# SPDX-License-Identifier: LGPL-2.1-or-later
"""The field between two meshes with the same numbering."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import InputError
from ..registration.arrays import Array
from ..scan.formats.stl import triangles
from .field import VectorField

_SAME_CORNER = 1e-3
"""How far what is one corner of the nominal mesh may be apart in the other, over the size of the part (unit: above
single precision, below an edge of a mesh)."""


def field_between_meshes(nominal: Path, displaced: Path) -> VectorField:
    """How the corners of one STL mesh move to those of another one.

    Raises
    ------
    InputError : a file cannot be read, they have not the same triangles, or corners that were one move apart
    """
    before, after = (_corners(path) for path in (nominal, displaced))
    if len(before) != len(after):
        raise InputError(f"The meshes have not the same numbering: {len(before) // 3} and {len(after) // 3} triangles. "
                         "Give the mesh of the nominal part, and the same one with its nodes moved.")
    places, first, number = np.unique(before, axis=0, return_index=True, return_inverse=True)
    moved = (after - before)[first]
    apart = np.linalg.norm((after - before) - moved[number.ravel()], axis=1).max()
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    if apart > _SAME_CORNER * size:
        raise InputError(f"The meshes have not the same numbering: what is one corner in {nominal} is up to "
                         f"{apart:.3g} mm apart in {displaced}.")
    return VectorField(places, moved)


def _corners(path: Path) -> Array:
    """Corners of the triangles in the order of the file: (n, 3)."""
    if path.suffix.lower() != ".stl":
        raise InputError(f"The mesh {path} is no .stl file.")
    if not path.is_file():
        raise InputError(f"The mesh {path} does not exist.")
    return np.asarray(triangles(path), dtype=float).reshape(-1, 3)
