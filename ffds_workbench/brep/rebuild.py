# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes a deformed workpiece back as a shape with the same topology.

Faces that move get a cubic B-spline surface over the same (u, v); their pcurves stay, so edges, holes and trims
follow. Edges and vertices take the mean of their traces on the faces, and tolerances cover the rest. Everything else
keeps its record.
"""
from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import Part

from ..errors import RefusedError
from ..registration.arrays import Array
from ..registration.splines import SplineSurface
from .edge_geometry import EdgeGeometry
from .face_displacement import FaceDisplacement
from .folding import folded, folds_over
from .occt_text import Locations, NewFace, PcurveReader, Rewriter, dump, parse, walk
from .surface_fit import approximate
from .validity import listed, newly_invalid
from .workpiece import Workpiece, WorkpieceFace

SURFACE_TOLERANCE = 2e-6
"""Largest distance in mm of a new surface from the nominal one plus its displacement, where nothing else is asked
(unit: far below the noise of scanners, above what a fit leaves)."""


def rebuild(workpiece: Workpiece, displacements: Mapping[int, FaceDisplacement],
            tolerance: float = SURFACE_TOLERANCE) -> Part.Shape:
    """The workpiece with some of its faces displaced and its topology unchanged.

    Parameters
    ----------
    displacements : by face index (0-based). Faces that are not named, and the edges between them, stay exactly as they
        are; along an edge between a named and an unnamed face the displacement must be zero
    tolerance : largest distance in mm of a face's new surface from the nominal surface plus its displacement. Edges
        gape by about as much; looser is coarser and faster

    Raises
    ------
    RefusedError
        a face would fold over or tear off a face that stays, or the result is not valid where the nominal is
    """
    if not displacements:
        return workpiece.shape.copy()
    brep = parse(workpiece.shape.exportBrepToString())
    locations = Locations(brep.locations)
    instances = walk(brep, locations)
    reader = PcurveReader(brep, locations, instances)
    faces = {index: NewFace(displaced_surface(workpiece.faces[index], displacements[index], tolerance),
                            tuple(reader.face_edges(index)))
             for index in sorted(displacements)}
    _refuse_folds(workpiece, faces)
    geometry = EdgeGeometry(brep, locations, instances, faces, tolerance)
    geometry.refuse_tears(displacements, workpiece)
    edges = {index: geometry.edge(index) for index in geometry.edges}
    edges, vertices = geometry.start_late(edges, geometry.vertices(edges))
    rewriter = Rewriter(brep, locations, instances, geometry.faces(), edges, vertices)
    shape = Part.Shape()
    shape.importBrepFromString(dump(rewriter.text()))
    worse = newly_invalid(workpiece.shape, shape)
    if worse:
        raise RefusedError(f"The rebuilt shape is not valid in {listed(worse)}: the displacement is too large or too "
                           "uneven for this part.")
    return shape


def displaced_surface(face: WorkpieceFace, displacement: FaceDisplacement, tolerance: float) -> SplineSurface:
    """A face's new surface: a cubic spline within ``tolerance`` of S(u, v) + d(u, v), in world coordinates."""
    def moved(u: Array, v: Array) -> Array:
        points = face.on_grid(u, v)
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        return points + displacement.evaluate(uv, points.reshape(-1, 3)).reshape(points.shape)

    own_u, own_v = face.own_knots
    seeds_u = _joined(own_u, displacement.knots_u, face.box.u1 - face.box.u0)
    seeds_v = _joined(own_v, displacement.knots_v, face.box.v1 - face.box.v0)
    return approximate(moved, face.box, seeds_u, seeds_v, tolerance)


def _joined(own: Array, more: Array, length: float) -> Array:
    """Own knots, and those of ``more`` that lie apart from them: a knot met twice would lose a derivative."""
    more = np.unique(np.asarray(more, dtype=float))
    if len(own) and len(more):
        more = more[np.abs(more[:, None] - own).min(axis=1) > 1e-6 * length]
    return np.concatenate([own, more])


def _refuse_folds(workpiece: Workpiece, faces: Mapping[int, NewFace]) -> None:
    for index, new in faces.items():
        face = workpiece.faces[index]
        if folded(face.on_grid, new.surface, face.trims):
            raise folds_over(face.name)
