# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the joint solve knows of a part: its faces, the edges they share, and which faces make a solid."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...face_geometry import FaceGeometry


@dataclass(frozen=True)
class SharedEdge:
    """One edge, sampled at the same places on each face that it bounds.

    Attributes
    ----------
    name : "Edge12", numbered as FreeCAD numbers the shape
    faces : indices of its faces into ``JointPart.faces``; twice the same face where the edge is a seam, one face where
        the edge is free
    uv : one (m, 2) array of parameters per entry of ``faces``
    left : per entry of ``faces``, whether the face lies left of the edge, seen from outside the material
    points : (m, 3) in mm, the edge itself, at the same places
    degenerate : the edge is a single point (the apex of a cone, the pole of a sphere)
    """

    name: str
    faces: tuple[int, ...]
    uv: tuple[Array, ...]
    left: tuple[bool, ...]
    points: Array
    degenerate: bool = False

    @property
    def is_seam(self) -> bool:
        """Whether a face meets itself here."""
        return len(self.faces) == 2 and self.faces[0] == self.faces[1]


@dataclass(frozen=True)
class JointPart:
    """All faces of a workpiece, free of FreeCAD.

    Attributes
    ----------
    faces : the faces in FreeCAD's order
    edges : the edges in FreeCAD's order
    solids : (k,) indices of the faces of each solid; faces outside any solid form a group of their own
    frozen : indices of faces that must not move
    """

    faces: tuple[FaceGeometry, ...]
    edges: tuple[SharedEdge, ...]
    solids: tuple[NDArray[np.intp], ...]
    frozen: frozenset[int] = frozenset()

    @property
    def solid_of_face(self) -> NDArray[np.intp]:
        """Number of the solid that a face belongs to: (faces,)."""
        owner = np.zeros(len(self.faces), dtype=np.intp)
        for number, solid in enumerate(self.solids):
            owner[solid] = number
        return owner
