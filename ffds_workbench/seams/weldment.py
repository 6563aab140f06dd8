# SPDX-License-Identifier: LGPL-2.1-or-later
"""A shape as a weldment: parts, and edges with the faces on both sides.

Owns the evaluation of edges, of face normals along them, and of the nearest point of a part. Sub-shapes are indices,
0-based, in FreeCAD's order; an edge's *fraction* is 0 at the start of its parameter range and 1 at its end.
"""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import FreeCAD
import numpy as np
import Part

from ..brep import topology
from ..brep.model_files import Model, model_file
from ..errors import InputError, RefusedError
from ..registration.arrays import Array

_INWARDS = 1e-4
"""Step in fractions away from an edge's end where its face has no normal: the apex of a cone."""


@dataclass(frozen=True)
class CurvePoints:
    """An edge's curve at some fractions: points in mm and derivatives by the fraction, all (n, 3)."""

    points: Array
    first: Array
    second: Array

    @property
    def tangents(self) -> Array:
        """Unit tangents towards growing fractions, (n, 3)."""
        return self.first / np.linalg.norm(self.first, axis=1, keepdims=True)

    @property
    def curvatures(self) -> Array:
        """|C′ × C″| / |C′|³ in 1/mm, (n,)."""
        return np.linalg.norm(np.cross(self.first, self.second), axis=1) / np.linalg.norm(self.first, axis=1) ** 3


@dataclass(frozen=True)
class NearestPoints:
    """Nearest points of some faces: (n, 3) points, (n, 3) outward normals there, (n,) distances, (n,) face indices."""

    points: Array
    normals: Array
    distances: Array
    faces: Array


class Weldment:
    """The parts of a shape, its edges and faces."""

    def __init__(self, shape: Part.Shape) -> None:
        self.shape = shape
        self.edges, self.faces = shape.Edges, shape.Faces
        self.topology = topology.read(shape)

    @classmethod
    def of(cls, model: Model | Part.Shape | object) -> Weldment:
        """The weldment of a model, a shape, or a document object where it stands."""
        return cls(model.shape if isinstance(model, Model) else model_file.from_object(model).shape)

    @cached_property
    def parts(self) -> tuple[tuple[int, ...], ...]:
        """Faces of each part: of each solid, or of each shell where the shape has no solids."""
        return self.topology.solid_faces or self.topology.shell_faces

    @cached_property
    def part_of_face(self) -> dict[int, int]:
        """Part of each face that belongs to one."""
        return {face: part for part, faces in enumerate(self.parts) for face in faces}

    def edge_index(self, name: str) -> int:
        """0-based index of "EdgeN".

        Raises
        ------
        InputError
            The shape has no edge of that name.
        """
        number = name[4:] if name.startswith("Edge") else name
        if not number.isdecimal() or not 1 <= int(number) <= len(self.edges):
            raise InputError(f"There is no {name}: the model has Edge1 to Edge{len(self.edges)}.")
        return int(number) - 1

    def sides(self, edge: int) -> tuple[int, int]:
        """The two faces of an edge, the lower-numbered one first.

        Raises
        ------
        RefusedError
            The edge is a point, or has not exactly two faces.
        """
        name = f"Edge{edge + 1}"
        if self.topology.degenerate[edge]:
            raise RefusedError(f"{name} is a point (a pole or an apex) and no seam: name an edge with a length.")
        faces = self.topology.edge_faces[edge]
        if not faces:
            raise RefusedError(f"{name} has no adjacent faces: a torch direction needs two.")
        if len(faces) == 1:
            where = "is where a closed face meets itself" if (faces[0], edge) in self.topology.seams else "is open"
            raise RefusedError(f"{name} {where} and has one adjacent face only: a torch direction needs two.")
        if len(faces) > 2:
            raise RefusedError(f"{name} has {len(faces)} adjacent faces: a torch direction needs two.")
        return min(faces), max(faces)

    def curve(self, edge: int, fractions: Array) -> CurvePoints:
        """An edge's curve at fractions (n,) of its range.

        Raises
        ------
        RefusedError
            The curve stands still somewhere: it has no tangent there.
        """
        curve, (start, end) = self.edges[edge].Curve, self.edges[edge].ParameterRange
        span = end - start
        parameters = (start + span * fractions).tolist()
        points = np.array([tuple(curve.value(t)) for t in parameters])
        first = span * np.array([tuple(curve.getD1(t)[1]) for t in parameters])
        second = span**2 * np.array([tuple(curve.getD2(t)[2]) for t in parameters])
        if np.linalg.norm(first, axis=1).min() < 1e-9:
            raise RefusedError(f"Edge{edge + 1} has no direction at some point: repair the edge first.")
        return CurvePoints(points, first, second)

    def normals_beside(self, face: int, edge: int, fractions: Array) -> Array:
        """Outward unit normals of a face along one of its edges, (n, 3)."""
        uv = self._uv(face, edge, fractions)
        inner = self._uv(face, edge, np.clip(fractions, _INWARDS, 1.0 - _INWARDS))
        return np.array([self._normal(face, *at, *instead)
                         for at, instead in zip(uv.tolist(), inner.tolist(), strict=True)])

    def _uv(self, face: int, edge: int, fractions: Array) -> Array:
        return topology.edge_traces(self.faces[face], self.edges[edge], fractions)[0].uv

    def _normal(self, face: int, u: float, v: float, u_instead: float, v_instead: float) -> tuple[float, float, float]:
        try:
            x, y, z = self.faces[face].normalAt(u, v)
        except (RuntimeError, Part.OCCError, FreeCAD.Base.FreeCADError):
            x, y, z = self.faces[face].normalAt(u_instead, v_instead)
        return x, y, z

    def nearest(self, faces: Iterable[int], points: Array) -> NearestPoints:
        """Nearest points of the given (trimmed) faces to points (n, 3)."""
        found: list[NearestPoints] = [self._nearest_on(face, points) for face in faces]
        distances = np.stack([one.distances for one in found])
        best, row = distances.argmin(axis=0), np.arange(len(points))
        points_of, normals_of, faces_of = (np.stack([getattr(one, name) for one in found])[best, row]
                                           for name in ("points", "normals", "faces"))
        return NearestPoints(points_of, normals_of, distances[best, row], faces_of)

    def distances(self, face: int, points: Array) -> Array:
        """Distances in mm of points (n, 3) from a (trimmed) face, (n,)."""
        surface = self.faces[face]
        return np.array([Part.Vertex(*point).distToShape(surface)[0] for point in points.tolist()])

    @cached_property
    def areas(self) -> tuple[float, ...]:
        """Of all faces in mm²."""
        return tuple(face.Area for face in self.faces)

    def _nearest_on(self, face: int, points: Array) -> NearestPoints:
        surface = self.faces[face]
        closest, normals, distances = [], [], []
        for point in points.tolist():
            distance, pairs, supports = Part.Vertex(*point).distToShape(surface)
            kind, index, parameter = supports[0][3:6]
            foot = pairs[0][1]
            # On the boundary the answer names an edge or a vertex; the normal is still the face's.
            u, v = parameter if kind == "Face" else surface.Surface.parameter(foot)
            closest.append(tuple(foot))
            normals.append(self._normal(face, u, v, *towards_middle(surface, u, v)))
            distances.append(distance)
        return NearestPoints(np.array(closest), np.array(normals), np.array(distances), np.full(len(points), face))

    def in_material(self, point: Array) -> bool:
        """Whether a point lies inside any solid."""
        at = FreeCAD.Vector(*point.tolist())
        return any(solid.BoundBox.isInside(at) and solid.isInside(at, 1e-6, False) for solid in self._solids)

    @cached_property
    def _solids(self) -> list[Part.Solid]:
        return self.shape.Solids


def towards_middle(face: Part.Face, u: float, v: float) -> tuple[float, float]:
    """Parameters a little nearer to the middle of the face's range: off a pole or an apex."""
    u0, u1, v0, v1 = face.ParameterRange
    return u + _INWARDS * (0.5 * (u0 + u1) - u), v + _INWARDS * (0.5 * (v0 + v1) - v)
