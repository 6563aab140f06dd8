# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a shape can be shown and machined: every face gives triangles, and together they close."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import Part

_DEVIATION = 0.5e-2 / 3.0
"""Unit: how far, as a share of the box's extents in all, a mesh may be off: what FreeCAD shows a part with."""
_OTHERS = (0.5, 2.0)
"""Unit: deviations, as shares of the first, at which a face without triangles is tried again. OCCT's mesher gives up on
a sound face now and then, at one deviation and not at the next; on a broken one it does at all."""


@dataclass(frozen=True)
class Mesh:
    """What a shape's mesh lacks.

    Attributes
    ----------
    empty : indices of faces that give no triangles, be they finer or coarser
    open_edges : number of the mesh's edges that belong to one triangle only
    """

    empty: tuple[int, ...]
    open_edges: int


def mesh(shape: Part.Shape) -> Mesh:
    """Mesh a shape as finely as FreeCAD shows it."""
    box = shape.BoundBox
    deviation = _DEVIATION * (box.XLength + box.YLength + box.ZLength)
    _, triangles = shape.tessellate(deviation)
    empty = tuple(index for index, face in enumerate(shape.Faces) if _gives_none(face, deviation))
    if not triangles:
        return Mesh(empty, 0)
    corners = np.array(triangles)
    sides = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    _, uses = np.unique(sides[:, 0] * (int(sides.max()) + 1) + sides[:, 1], return_counts=True)
    return Mesh(empty, int((uses == 1).sum()))


def _gives_none(face: Part.Face, deviation: float) -> bool:
    """Whether a face gives no triangles at a deviation in mm, and at others neither."""
    return not face.tessellate(deviation)[1] and not any(
        face.copy().tessellate(share * deviation)[1] for share in _OTHERS)
