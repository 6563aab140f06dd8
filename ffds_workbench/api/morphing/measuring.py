# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``field --points``: the field through few measured points, filled in by the part's stiffness."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD
import numpy as np
import Part
from scipy.spatial import cKDTree

from ...brep import topology, workpiece
from ...brep.continuity import closing_displacements
from ...brep.joint_part import joint_part
from ...brep.model_files import Model
from ...brep.workpiece import Workpiece
from ...errors import InputError
from ...fields import VectorField
from ...fields.combination import places_of
from ...fields.csv_file import COLUMNS, SIGMA, read_table
from ...registration.arrays import Array, Index
from ...registration.measured import MeasuredRows, register_points
from ...registration.uv_raster import make_raster
from ..inputs import as_model

_NORMAL_COLUMNS = ("x", "y", "z", "nx", "ny", "nz", "deviation")
_USUAL_SIGMA = 0.01
"""Standard deviation in mm of points that come without one (unit: a measuring machine's)."""
_FARTHEST = 0.02
"""Over the size of the part, beside its deviation: a point farther from the part was measured on something else
(unit)."""
_CELLS, _EDGE_PLACES = 48, 21
"""Cells along a side of a face, in the nearest of which a point is looked for, and places of the field along an edge
(unit: time)."""


def field_of_points(model: Model | Part.Shape | str | Path | Any, points: str | Path) -> VectorField:
    """The field through measured points of a part, with standard deviations.

    Parameters
    ----------
    model : the nominal model: a `Model`, a file, a shape or a document object
    points : a table: x,y,z,nx,ny,nz,deviation[,sigma] along normals, or vectors x,y,z,dx,dy,dz[,sigma], in mm

    Raises
    ------
    InputError : the table cannot be read, or a point does not lie on the part
    RefusedError : there is not enough memory
    """
    nominal = as_model(model)
    part = workpiece.read(nominal.shape)
    place, along, value, sigma = _read(Path(points))
    rasters = [make_raster(part.geometry(index), _CELLS) for index in range(len(part.faces))]
    cells = np.concatenate([raster.position[raster.inside] for raster in rasters])
    normal = np.concatenate([raster.normal[raster.inside] for raster in rasters])
    owner = np.repeat(np.arange(len(rasters)), [int(raster.inside.sum()) for raster in rasters])
    face, uv = _on_faces(part, place, cells, owner, float(np.abs(value).max()), Path(points))
    moved = max(float(np.abs(value).max()), float(sigma.max()))
    found = register_points(joint_part(part), MeasuredRows(face, uv, along, value, sigma), cells + moved * normal)
    closed = closing_displacements(part, dict(enumerate(found.displacements)))
    positions, vectors, sigmas, numbers = [], [], [], []
    for index, inside in enumerate(places_of(part)):
        own = np.concatenate([inside.uv, *_edge_parameters(part, index)])
        where = part.faces[index].at(own)
        positions.append(where)
        vectors.append(closed[index].evaluate(own, where))
        sigmas.append(found.sigma(index, own))
        numbers.append(np.full(len(own), index + 1))
    return VectorField(np.concatenate(positions), np.concatenate(vectors), np.concatenate(sigmas),
                       np.concatenate(numbers))


def _read(path: Path) -> tuple[Array, Array, Array, Array]:
    """Places (n, 3), directions (n, 3), displacements along them (n,) and standard deviations (n,); of a vector three
    rows."""
    names, rows, _ = read_table(path, "table of measured points", (*_NORMAL_COLUMNS, SIGMA))
    if not np.isfinite(rows).all():
        raise InputError(f"The table of measured points {path} holds what is no number: leave these rows out.")
    value = {name: rows[:, names.index(name)] for name in names}
    sigma = np.asarray(value.get(SIGMA, np.full(len(rows), _USUAL_SIGMA)))
    if not (sigma > 0).all():
        raise InputError(f"The table of measured points {path} has a sigma that is not above 0.")
    for columns in (_NORMAL_COLUMNS, COLUMNS):
        if all(name in value for name in columns):
            break
    else:
        raise InputError(f"The table of measured points {path} has not the columns x,y,z,nx,ny,nz,deviation or "
                         f"x,y,z,dx,dy,dz.")
    place, three = (np.stack([value[name] for name in some], axis=1) for some in (columns[:3], columns[3:6]))
    if columns == COLUMNS:
        return (np.repeat(place, 3, axis=0), np.tile(np.eye(3), (len(place), 1)), three.ravel(), np.repeat(sigma, 3))
    length = np.linalg.norm(three, axis=1)
    if not (length > 0).all():
        raise InputError(f"The table of measured points {path} has a normal without a length.")
    return place, three / length[:, None], value["deviation"], sigma


def _on_faces(part: Workpiece, place: Array, cells: Array, owner: Index, moved: float, path: Path
              ) -> tuple[Index, Array]:
    """Face and parameters of every place (n, 3) on the part."""
    distance, nearest = cKDTree(cells).query(place)
    size = part.shape.BoundBox.DiagonalLength
    face, uv = owner[nearest], np.zeros((len(place), 2))
    for number, (index, point) in enumerate(zip(face.tolist(), place.tolist(), strict=True)):
        vertex = Part.Vertex(FreeCAD.Vector(*point))
        around = {index, *part.topology.faces_around([index])}
        off, face[number] = min((part.faces[other].face.distToShape(vertex)[0], other) for other in sorted(around))
        if off > _FARTHEST * size + moved:
            raise InputError(f"Point {number + 1} of {path} lies {off:.3g} mm off the part: points are given at their "
                             f"nominal places, in mm.")
        uv[number] = part.faces[face[number]].own_surface.parameter(FreeCAD.Vector(*point))
    return face, uv


def _edge_parameters(part: Workpiece, index: int) -> list[Array]:
    """Parameters (n, 2) along the edges of a face."""
    fractions = np.linspace(0.0, 1.0, _EDGE_PLACES)
    return [trace.uv for edge in part.topology.face_edges[index]
            for trace in topology.edge_traces(part.faces[index].face, part.edges[edge], fractions)]
