# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which face, edge and vertex of a shape touches which, by index, as FreeCAD numbers them; and where the edges run.

Owns the adjacency and the sampling of edges; it moves nothing. Two shapes with equal topologies have the same
sub-shapes in the same order, connected in the same way.
"""
from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import Part

from ..compat import stored_edges
from ..registration.arrays import Array

Incidence = tuple[tuple[int, ...], ...]

_SAME_PARAMETERS = 1e-9
"""Two pcurves of an edge are one below this difference (theory: those of a seam are a period of the surface apart)."""


class _Numbering:
    """Number of a sub-shape in a list of sub-shapes, whatever its orientation."""

    def __init__(self, subshapes: Iterable[Part.Shape]) -> None:
        self._buckets: dict[int, list[tuple[int, Part.Shape]]] = defaultdict(list)
        for index, subshape in enumerate(subshapes):
            self._buckets[subshape.hashCode()].append((index, subshape))

    def __call__(self, subshape: Part.Shape) -> int:
        for index, candidate in self._buckets[subshape.hashCode()]:
            if candidate.isSame(subshape):
                return index
        return -1

    def all(self, subshapes: Iterable[Part.Shape]) -> tuple[int, ...]:
        return tuple(self(subshape) for subshape in subshapes)


def _invert(incidence: Incidence, count: int) -> Incidence:
    inverse: list[list[int]] = [[] for _ in range(count)]
    for owner, members in enumerate(incidence):
        for member in members:
            inverse[member].append(owner)
    return tuple(map(tuple, inverse))


@dataclass(frozen=True)
class Topology:
    """A shape's adjacency by index; equal for shapes with the same sub-shapes in the same order.

    Attributes
    ----------
    counts : number of compounds, solids, shells, faces, wires, edges and vertices, as FreeCAD counts them
    solid_faces, shell_faces : faces of each solid and of each shell
    face_wires : for each face, for each of its wires, the edges in stored order; a seam stands there twice
    wire_senses : beside each edge in ``face_wires``, whether it runs along its curve there, seen from outside
    face_edges : edges of each face, each once
    edge_vertices : vertices of each edge, each once
    edge_starts : the vertex where each edge's parameter range begins, −1 where there is none
    reversed_faces : whether a face is used REVERSED
    degenerate : whether an edge is a point: the pole of a sphere, the apex of a cone
    """

    counts: dict[str, int]
    solid_faces: Incidence
    shell_faces: Incidence
    face_wires: tuple[Incidence, ...]
    wire_senses: tuple[tuple[tuple[bool, ...], ...], ...]
    face_edges: Incidence
    edge_vertices: Incidence
    edge_starts: tuple[int, ...]
    reversed_faces: tuple[bool, ...]
    degenerate: tuple[bool, ...]

    @cached_property
    def edge_faces(self) -> Incidence:
        """Faces at each edge, each once."""
        return _invert(self.face_edges, self.counts["edges"])

    @cached_property
    def vertex_edges(self) -> Incidence:
        """Edges at each vertex, each once."""
        return _invert(self.edge_vertices, self.counts["vertices"])

    @cached_property
    def face_vertices(self) -> Incidence:
        """Vertices of each face, each once."""
        return tuple(tuple(sorted({vertex for edge in edges for vertex in self.edge_vertices[edge]}))
                     for edges in self.face_edges)

    @cached_property
    def vertex_faces(self) -> Incidence:
        """Faces at each vertex, each once."""
        return _invert(self.face_vertices, self.counts["vertices"])

    @cached_property
    def seams(self) -> frozenset[tuple[int, int]]:
        """(face, edge) where the face meets itself along the edge."""
        uses = Counter((face, edge) for face, wires in enumerate(self.face_wires) for wire in wires for edge in wire)
        return frozenset(use for use, times in uses.items() if times > 1)

    def faces_around(self, faces: Iterable[int]) -> set[int]:
        """The faces that share a vertex or an edge with any of ``faces``, and these themselves."""
        faces = set(faces)
        vertices = {vertex for face in faces for vertex in self.face_vertices[face]}
        return faces | {other for vertex in vertices for other in self.vertex_faces[vertex]}


def bodies(shape: Part.Shape) -> list[Part.Shape]:
    """The solids of a shape, and what else lies in it by itself, where they stand."""
    if shape.ShapeType in ("Compound", "CompSolid"):
        return [body for child in shape.childShapes() for body in bodies(child)]
    return [shape]


def read(shape: Part.Shape) -> Topology:
    """Adjacency of a shape."""
    faces, edges, vertices = shape.Faces, shape.Edges, shape.Vertexes
    face_number, edge_number, vertex_number = _Numbering(faces), _Numbering(edges), _Numbering(vertices)
    counts = {"compounds": len(shape.Compounds), "solids": len(shape.Solids), "shells": len(shape.Shells),
              "faces": len(faces), "wires": len(shape.Wires), "edges": len(edges), "vertices": len(vertices)}
    wires = [[(wire.Orientation == "Forward", stored_edges(wire, face)) for wire in face.Wires] for face in faces]
    return Topology(
        counts=counts,
        solid_faces=tuple(face_number.all(solid.Faces) for solid in shape.Solids),
        shell_faces=tuple(face_number.all(shell.Faces) for shell in shape.Shells),
        face_wires=tuple(tuple(edge_number.all(edges) for _, edges in of_face) for of_face in wires),
        wire_senses=tuple(tuple(tuple((edge.Orientation == "Forward") == forward for edge in edges)
                                for forward, edges in of_face) for of_face in wires),
        face_edges=tuple(edge_number.all(face.Edges) for face in faces),
        edge_vertices=tuple(vertex_number.all(edge.Vertexes) for edge in edges),
        edge_starts=tuple(next((vertex_number(vertex) for vertex in edge.childShapes(False, True)
                                if vertex.Orientation == "Forward"), -1) for edge in edges),
        reversed_faces=tuple(face.Orientation == "Reversed" for face in faces),
        degenerate=tuple(bool(edge.Degenerated) for edge in edges))


@dataclass(frozen=True)
class EdgeTrace:
    """An edge as one of its faces sees it.

    Attributes
    ----------
    points : (n, 3) on the edge's own curve in mm; the vertex, n times, where the edge is degenerate
    uv : (n, 2) the face's parameters there, along the edge's pcurve
    """

    points: Array
    uv: Array


def points_on_edge(edge: Part.Edge, fractions: Array) -> Array:
    """Points of an edge at fractions 0…1 of its parameter range: (n,) to (n, 3) in mm."""
    if edge.Degenerated:
        return np.repeat([tuple(edge.Vertexes[0].Point)], len(fractions), axis=0)
    first, last = edge.ParameterRange
    return _on_curve(edge.Curve, first, last, fractions)


def _on_curve(curve: Any, first: float, last: float, fractions: Array) -> Array:
    """Points of a curve at fractions 0…1 from a first parameter to a last one, (n, 3), or (n, 2) of a pcurve; of a line
    from its ends."""
    if isinstance(curve, (Part.Line, Part.Geom2d.Line2d)):
        start, end = _values(curve, [first, last])
        return np.where(fractions[:, None] == 1.0, end, start + fractions[:, None] * (end - start))
    return _values(curve, (first + (last - first) * fractions).tolist())


def _values(curve: Any, parameters: list[float]) -> Array:
    points = [curve.value(t) for t in parameters]
    if isinstance(curve, Part.Geom2d.Curve2d):
        return np.array([(point.x, point.y) for point in points])
    return np.array([tuple(point) for point in points])


def edge_traces(face: Part.Face, edge: Part.Edge, fractions: Array) -> list[EdgeTrace]:
    """The traces of an edge on a face at fractions 0…1 of its range: one, or two where it is a seam."""
    points, some = points_on_edge(edge, fractions), [0, len(fractions) // 2, -1]
    few = fractions[some]
    traces: dict[str, EdgeTrace] = {}
    for side in (edge, edge.reversed()):
        pcurve = face.curveOnSurface(side)
        if pcurve is None:
            continue
        curve, first, last = pcurve[:3]
        known = traces.get(edge.Orientation)
        if known is None or np.abs(_on_curve(curve, first, last, few) - known.uv[some]).max() > _SAME_PARAMETERS:
            traces[side.Orientation] = EdgeTrace(points, _on_curve(curve, first, last, fractions))
    if len(traces) == 2:
        # A face cut out of a closed one may have kept the far curve of a seam that it no longer meets twice.
        used = {(use if wire.Orientation == "Forward" else use.reversed()).Orientation
                for wire in face.Wires for use in stored_edges(wire, face) if use.isSame(edge)}
        traces = {side: trace for side, trace in traces.items() if side in used}
    return list(traces.values())
