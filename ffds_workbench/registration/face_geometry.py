# SPDX-License-Identifier: LGPL-2.1-or-later
"""What registration knows of a face: its surface as a B-spline in the face's own (u, v), and its trims."""
from __future__ import annotations

from dataclasses import dataclass

from .arrays import Array
from .splines import SplineSurface


@dataclass(frozen=True)
class FaceGeometry:
    """One face of the workpiece, free of FreeCAD.

    Attributes
    ----------
    name : "Face6", numbered as FreeCAD numbers the shape
    kind : OCCT's surface type: "Plane", "Cylinder", "Cone", "Sphere", "Toroid", "BSplineSurface", ...
    surface : S₀(u, v) in mm, world coordinates, within 4e-6 mm of the face's own surface at the same (u, v);
        its range covers the face
    trims : closed polylines in (u, v), each (k, 2), the outer boundary and the holes; material by the even-odd rule
    outward : +1 if S_u × S_v points out of the material, −1 if it points into it
    """

    name: str
    kind: str
    surface: SplineSurface
    trims: tuple[Array, ...]
    outward: int
