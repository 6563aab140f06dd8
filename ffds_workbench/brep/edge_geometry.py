# SPDX-License-Identifier: LGPL-2.1-or-later
"""New curves, points and tolerances of the edges and vertices around the faces that are displaced."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import cast

import numpy as np

from ..errors import RefusedError
from ..registration.arrays import Array
from .edges import PlacedCurve, Trace, edge_curve, largest_gap
from .face_displacement import FaceDisplacement
from .occt_text import (BrepText, Curve3d, EdgeCurves, Instances, Locations, NewEdge, NewFace, NewVertex, Pcurve,
                        Spline, UsedEdge, VertexPoint, product, read_curve)
from .pcurve_start import delay_pcurve_start
from .workpiece import Workpiece

_OCCT_PRECISION = 9e-8
"""A gap below this, in mm, is within Open CASCADE's own precision (theory: Open CASCADE's own precision, 1e-7, and a
little less)."""
_NO_DISPLACEMENT = 1e-5
"""A displacement below this, in mm, counts as none, where a moved face meets one that stays (unit: far below any
tolerance)."""


class EdgeGeometry:
    """New curves, points and tolerances of the edges and vertices around the displaced faces."""

    def __init__(self, brep: BrepText, locations: Locations, instances: Instances, faces: Mapping[int, NewFace],
                 tolerance: float) -> None:
        self._brep, self._locations, self._instances, self._faces = brep, locations, instances, faces
        self._tolerance = 0.5 * tolerance
        self._uses: dict[int, list[tuple[int, UsedEdge]]] = {}
        for face, new in faces.items():
            for used in new.edges:
                self._uses.setdefault(used.edge, []).append((face, used))
        self._gaps: dict[int, tuple[PlacedCurve, list[float]]] = {}
        self._late: dict[tuple[int, int], Pcurve] = {}
        self.edges = sorted(self._uses)
        self._staying_vertices = {vertex for edge, ends in enumerate(instances.edge_ends)
                                  if edge not in self._uses or self._stays(edge) for vertex, _ in ends}

    def _curves(self, edge: int) -> EdgeCurves:
        return cast(EdgeCurves, self._brep.shapes[self._instances.edges[edge].shape].geometry)

    def _traces(self, edge: int) -> list[Trace]:
        return [Trace(self._faces[face].surface, pcurve) for face, used in self._uses[edge] for pcurve in used.pcurves]

    def _stays(self, edge: int) -> bool:
        """Whether a face that is not displaced, or no face at all, uses the edge."""
        users = self._instances.edge_faces[edge]
        return not users or any(face not in self._faces for face in users)

    def refuse_tears(self, displacements: Mapping[int, FaceDisplacement], workpiece: Workpiece) -> None:
        """Refuse a displacement that is not zero where its face meets one that stays, be it at a vertex."""
        for edge in self.edges:
            fraction = np.linspace(0.0, 1.0, 65)
            if not self._stays(edge):
                fraction = np.array([0.0 if orientation == "+" else 1.0
                                     for vertex, orientation in self._instances.edge_ends[edge]
                                     if vertex in self._staying_vertices and orientation in "+-"])
            for face, used in self._uses[edge] if len(fraction) else ():
                uv = Trace(self._faces[face].surface, used.pcurves[0]).uv(fraction)
                moved = displacements[face].evaluate(uv, workpiece.faces[face].at(uv))
                if np.linalg.norm(moved, axis=1).max() > _NO_DISPLACEMENT:
                    raise RefusedError(f"Face{face + 1} would tear off at Edge{edge + 1}, where its neighbour stays.")

    def edge(self, edge: int) -> NewEdge:
        """New curve and tolerance of an edge of a displaced face."""
        old, traces = self._curves(edge), self._traces(edge)
        if old.degenerated:
            return NewEdge(None, old.tolerance)
        item = next((item for item in old.representations if isinstance(item, Curve3d)), None)
        if self._stays(edge) and item is not None:
            place = product(self._instances.edges[edge].place, self._locations.chain(item.location))
            curve = PlacedCurve(read_curve(self._brep.curves_3d[item.curve - 1], 3), self._locations.matrix(place),
                                item.first, item.last)
            return self._new_edge(edge, None, curve)
        if not old.same_parameter:
            raise RefusedError(f"Edge{edge + 1} and its faces run at different parameters: repair the shape first.")
        span = item or self._uses[edge][0][1].pcurves[0]
        closed = len({vertex for vertex, _ in self._instances.edge_ends[edge]}) == 1
        new = edge_curve(traces, span.first, span.last, closed, self._tolerance)
        return self._new_edge(edge, new, PlacedCurve(new, np.eye(4), span.first, span.last))

    def _new_edge(self, edge: int, new: Spline | None, curve: PlacedCurve) -> NewEdge:
        """The edge with a tolerance that covers how far its faces are from its curve; keeps both for `start_late`."""
        gaps = [largest_gap(curve, [trace]) for trace in self._traces(edge)]
        self._gaps[edge] = curve, gaps
        return NewEdge(new, max(self._curves(edge).tolerance, _covering(max(gaps, default=0.0))))

    def start_late(self, edges: Mapping[int, NewEdge], vertices: Mapping[int, NewVertex]
                   ) -> tuple[dict[int, NewEdge], dict[int, NewVertex]]:
        """The edges and vertices with tolerances for the pcurves that start late (see `pcurve_start`), one per edge."""
        edges, vertices = dict(edges), dict(vertices)
        for edge, (curve, gaps) in self._gaps.items():
            starts = [vertex for vertex, orientation in self._instances.edge_ends[edge] if orientation == "+"]
            if max(gaps, default=0.0) <= _OCCT_PRECISION or not starts:
                continue
            moved = vertices[starts[0]].point
            start = self._point(starts[0]) if moved is None else moved
            later = self._later(edge, curve, gaps, start)
            if later is None:
                continue
            reach = float(np.linalg.norm(later.at(np.zeros(1)) - start))
            least = _covering(largest_gap(curve, [later]))
            edges[edge] = replace(edges[edge], tolerance=max(edges[edge].tolerance, least))
            for vertex, _ in self._instances.edge_ends[edge]:
                vertices[vertex] = replace(vertices[vertex], tolerance=max(vertices[vertex].tolerance, least,
                                                                           _covering(reach)))
        return edges, vertices

    def _later(self, edge: int, curve: PlacedCurve, gaps: list[float], vertex: Array) -> Trace | None:
        """One trace of the edge starting late, off seams if possible, and the one that gapes most: readers of STEP may
        make its pcurve anew, and worse, where another one has the largest distance."""
        uses = [(face, len(used.pcurves) == 1) for face, used in self._uses[edge] for _ in used.pcurves]
        single = [(trace.at_seam(0.0), -gap, face, trace) for (face, alone), trace, gap in
                  zip(uses, self._traces(edge), gaps, strict=True) if alone]
        for _, _, face, trace in sorted(single, key=lambda use: use[:3]):
            later = delay_pcurve_start(trace, curve, max(gaps), vertex)
            if later is not None:
                self._late[face, edge] = later.pcurve
                return later
        return None

    def _point(self, vertex: int) -> Array:
        """Where a vertex of the workpiece is, in world coordinates."""
        instance = self._instances.vertices[vertex]
        matrix = self._locations.matrix(instance.place)
        point = cast(VertexPoint, self._brep.shapes[instance.shape].geometry).point
        return matrix[:3, :3] @ np.array(point) + matrix[:3, 3]

    def faces(self) -> dict[int, NewFace]:
        """The displaced faces, with the pcurves that start late."""
        return {face: replace(new, edges=tuple(
                    replace(used, pcurves=(self._late[face, used.edge],)) if (face, used.edge) in self._late else used
                    for used in new.edges)) for face, new in self._faces.items()}

    def vertices(self, edges: Mapping[int, NewEdge]) -> dict[int, NewVertex]:
        """New points and tolerances of all vertices of displaced faces.

        A vertex is the mean of the ends that meet there; on the seam of a closed face it is that face's own point, as
        its edges are that face's own curves (see `edge_curve`).
        """
        ends: dict[int, list[Array]] = {}
        on_seams: dict[int, list[Array]] = {}
        least: dict[int, float] = {}
        for edge, new in edges.items():
            traces = self._traces(edge)
            for vertex, orientation in self._instances.edge_ends[edge]:
                least[vertex] = max(least.get(vertex, 0.0), new.tolerance)
                if orientation not in "+-":
                    continue
                end = 0.0 if orientation == "+" else 1.0
                points = [trace.at(np.array([end])) for trace in traces]
                on_seams.setdefault(vertex, []).extend(
                    point for point, trace in zip(points, traces, strict=True) if trace.at_seam(end))
                if new.curve is not None:
                    points.append(new.curve.poles[[0 if orientation == "+" else -1]])
                ends.setdefault(vertex, []).extend(points)
        return {vertex: self._vertex(vertex, np.concatenate(points), np.concatenate(on_seams[vertex] or points),
                                     least[vertex], vertex in self._staying_vertices)
                for vertex, points in ends.items()}

    def _vertex(self, vertex: int, ends: Array, deciding: Array, least: float, stays: bool) -> NewVertex:
        old = self._brep.shapes[self._instances.vertices[vertex].shape].geometry
        assert isinstance(old, VertexPoint)
        point = self._point(vertex) if stays else deciding.mean(axis=0)
        distance = float(np.linalg.norm(ends - point, axis=1).max())
        tolerance = max(old.tolerance, distance + min(0.05 * distance, 3e-5) + 2e-8, least)
        return NewVertex(None if stays else point, tolerance)


def _covering(gap: float) -> float:
    """A tolerance that also covers the gap between samples."""
    return gap + min(0.3 * gap, 3e-5) + 2e-8
