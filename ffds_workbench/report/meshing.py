# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a shape can be shown and machined: every face gives triangles, and together they close."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import Part

_DEVIATION = 0.5e-2 / 3.0
"""Unit: how far, as a share of the box's extents in all, a mesh may be off: what FreeCAD shows a part with."""
_FINER = 0.7, 0.5, 0.3, 0.1
"""What is tried over that where a face gave no triangles: OCCT's mesher fails on some faces at one fineness and not at
the next, also on nominal ones."""


@dataclass(frozen=True)
class Mesh:
    """What a shape's mesh lacks.

    Attributes
    ----------
    empty : indices of faces without triangles
    open_edges : number of the mesh's edges that belong to one triangle only
    """

    empty: tuple[int, ...]
    open_edges: int


def mesh(shape: Part.Shape) -> Mesh:
    """Mesh a shape as finely as FreeCAD shows it."""
    deviation = _deviation(shape)
    _, triangles = shape.tessellate(deviation)
    empty = tuple(index for index, face in enumerate(shape.Faces) if not face.tessellate(deviation)[1])
    if not triangles:
        return Mesh(empty, 0)
    corners = np.array(triangles)
    sides = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    _, uses = np.unique(sides[:, 0] * (int(sides.max()) + 1) + sides[:, 1], return_counts=True)
    return Mesh(empty, int((uses == 1).sum()))


def meshes_finer(face: Part.Face, shape: Part.Shape) -> bool:
    """Whether a face of a shape gives triangles at any of some finenesses beyond FreeCAD's."""
    deviation = _deviation(shape)
    return any(face.copy().tessellate(share * deviation)[1] for share in _FINER)


def _deviation(shape: Part.Shape) -> float:
    box = shape.BoundBox
    return float(_DEVIATION * (box.XLength + box.YLength + box.ZLength))
