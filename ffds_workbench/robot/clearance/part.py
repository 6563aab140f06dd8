# SPDX-License-Identifier: LGPL-2.1-or-later
"""The triangles of a shape, solid by solid, each with the number of its face in the whole shape."""
from __future__ import annotations

from pathlib import Path

import FreeCAD
import numpy as np
import Part

from ...brep import topology
from ...brep.model_files import model_file
from ...registration.arrays import Array
from .triangles import Facets, joined, triangles

_DEVIATION = 0.05
"""How far in mm the triangles may be off the faces (unit: far below the clearance that is kept)."""


def triangles_of(shape: Part.Shape) -> Facets:
    """The triangles of all solids of a shape; faces that belong to none are taken by themselves."""
    shape.tessellate(_DEVIATION)
    numbers = topology.read(shape).solid_faces
    groups = [list(zip(of_solid, solid.Faces, strict=True))
              for of_solid, solid in zip(numbers, shape.Solids, strict=True)]
    owned = {number for of_solid in numbers for number in of_solid}
    loose = [(number, face) for number, face in enumerate(shape.Faces) if number not in owned]
    return joined([_of_faces(members) for members in [*groups, loose] if members])


def _of_faces(members: list[tuple[int, Part.Face]]) -> Facets:
    points, indices, owners, count = [], [], [], 0
    for number, face in members:
        corners, facets = face.tessellate(_DEVIATION)
        if not facets:
            continue
        points.append(np.array([tuple(corner) for corner in corners]))
        indices.append(np.array(facets) + count)
        owners.append(np.full(len(facets), number))
        count += len(corners)
    return triangles(np.concatenate(points), np.concatenate(indices), np.concatenate(owners))


def triangles_of_file(path: Path, pose: Array) -> Facets:
    """The triangles of a model file, moved by a pose (4, 4); they all count as one face.

    Raises
    ------
    InputError : the file cannot be read
    """
    shape = model_file.read(path).shape.copy()
    shape.transformShape(FreeCAD.Matrix(*pose.ravel().tolist()))
    found = triangles_of(shape)
    return Facets(found.corners, np.zeros_like(found.faces), found.normals)
