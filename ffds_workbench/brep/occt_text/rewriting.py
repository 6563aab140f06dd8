# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rewrites the shapes of a BREP text that change, per place they stand at, and keeps all others verbatim.

This module owns the new text: it is told the new geometry of faces, edges and vertices by index and gives records in
local coordinates. It decides nothing about the geometry itself.
"""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...registration.arrays import Array
from ...registration.splines import DEGREE, SplineSurface
from .curves import Spline, knots_text, numbers_text, print_curve
from .instances import Chain, Instance, Instances, Locations, product
from .pcurves import UsedEdge
from .records import BrepText, Curve3d, CurveOnSurface, EdgeCurves, FaceSurface, ShapeReference, TShape, VertexPoint

_ANYWHERE: Chain = ((0, 0),)
"""The place of a shape that does not change: none has it, as elementary locations are numbered from 1."""


@dataclass(frozen=True)
class NewFace:
    """A face's new surface in world coordinates, and the edges it uses."""

    surface: SplineSurface
    edges: tuple[UsedEdge, ...]


@dataclass(frozen=True)
class NewEdge:
    """An edge's new curve in world coordinates, None where it keeps the old one (or has none), and its tolerance."""

    curve: Spline | None
    tolerance: float


@dataclass(frozen=True)
class NewVertex:
    """A vertex's new point (3,) in world coordinates, None where it keeps the old one, and its tolerance."""

    point: Array | None
    tolerance: float


def surface_text(surface: SplineSurface) -> str:
    """The record of a B-spline surface; a periodic direction is rolled up again as OCCT has it."""
    points = surface.control_points
    knots = []
    directions = (surface.knots_u, surface.periodic_u), (surface.knots_v, surface.periodic_v)
    for axis, (flat, periodic) in enumerate(directions):
        if periodic:
            points = np.moveaxis(np.moveaxis(points, axis, 0)[:-DEGREE], 0, axis)
            flat = flat[DEGREE:-DEGREE]
        knots.append(flat)
    counts = [len(np.unique(flat)) for flat in knots]
    head = (f"9 0 0 {surface.periodic_u:d} {surface.periodic_v:d} {surface.degree_u} {surface.degree_v} "
            f"{points.shape[0]} {points.shape[1]} {counts[0]} {counts[1]}")
    return "\n".join([head, numbers_text(points), knots_text(knots[0]), knots_text(knots[1])])


class Rewriter:
    """Builds the new text. Every changed face, edge and vertex is given by its index."""

    def __init__(self, brep: BrepText, locations: Locations, instances: Instances, faces: Mapping[int, NewFace],
                 edges: Mapping[int, NewEdge], vertices: Mapping[int, NewVertex]) -> None:
        self._old, self._locations, self._instances = brep, locations, instances
        self._faces, self._edges, self._vertices = faces, edges, vertices
        self._new = BrepText(list(brep.locations), list(brep.curves_2d), list(brep.curves_3d), list(brep.surfaces), [],
                             brep.root)
        self._number: dict[tuple[str, Instance], int] = {}
        for kind, listed in (("Fa", instances.faces), ("Ed", instances.edges), ("Ve", instances.vertices)):
            self._number.update({(kind, instance): index for index, instance in enumerate(listed)})
        self._changed: dict[Instance, bool] = {}
        self._written: dict[Instance, int] = {}
        self._location_records: dict[Chain, int] = {}
        for index in range(len(brep.locations), -1, -1):
            self._location_records[locations.chain(index)] = index
        self._surface_records: dict[int, int] = {}
        self._pcurve_records: dict[str, int] = {}

    def text(self) -> BrepText:
        """The new text."""
        for index, face in self._faces.items():
            self._surface_records[index] = self._add_surface(index, face)
        root = self._old.root
        position = self._write(root, ())
        self._new.root = replace(root, shape=position)
        return self._new

    def _write(self, reference: ShapeReference, outer: Chain) -> int:
        """Position of the referred shape in the new text, written if it is not there yet."""
        place = product(outer, self._locations.chain(reference.location))
        instance = Instance(reference.shape, place)
        # Shapes that do not change are shared by all their places.
        key = instance if self._changes(instance) else Instance(reference.shape, _ANYWHERE)
        if key not in self._written:
            old = self._old.shapes[reference.shape]
            children = tuple(replace(child, shape=self._write(child, place)) for child in old.children)
            geometry = self._geometry(old, instance) if key is instance else old.geometry
            self._new.shapes.append(TShape(old.kind, geometry, old.flags, children))
            self._written[key] = len(self._new.shapes) - 1
        return self._written[key]

    def _changes(self, instance: Instance) -> bool:
        if instance not in self._changed:
            shape = self._old.shapes[instance.shape]
            index = self._number.get((shape.kind, instance))
            own = {"Fa": self._faces, "Ed": self._edges, "Ve": self._vertices}.get(shape.kind, {})
            below = [
                self._changes(Instance(child.shape, product(instance.place, self._locations.chain(child.location))))
                for child in shape.children]
            self._changed[instance] = index in own or any(below)
        return self._changed[instance]

    def _geometry(self, old: TShape, instance: Instance) -> VertexPoint | EdgeCurves | FaceSurface | None:
        index = self._number.get((old.kind, instance), -1)
        if isinstance(old.geometry, FaceSurface) and index in self._faces:
            return replace(old.geometry, natural_restriction=False, surface=self._surface_records[index])
        if isinstance(old.geometry, EdgeCurves) and index in self._edges:
            return self._edge(old.geometry, index)
        if isinstance(old.geometry, VertexPoint) and index in self._vertices:
            return self._vertex(old.geometry, index)
        return old.geometry

    def _edge(self, old: EdgeCurves, index: int) -> EdgeCurves:
        new = self._edges[index]
        items: list[Curve3d | CurveOnSurface] = []
        for item in old.representations:
            if isinstance(item, Curve3d) and new.curve is None:
                items.append(item)
        on_surfaces = [item for face in self._instances.edge_faces[index] if face in self._faces
                       for item in self._on_face(face, index)]
        if new.curve is not None:
            local = np.linalg.inv(self._locations.matrix(self._instances.edges[index].place))
            self._new.curves_3d.append(print_curve(new.curve.mapped(local[:3, :3], local[:3, 3])))
            first, last = float(new.curve.knots[0]), float(new.curve.knots[-1])
            items.append(Curve3d(len(self._new.curves_3d), 0, first, last))
        if any(face not in self._faces for face in self._instances.edge_faces[index]):
            # The edge's representations on other, unchanged faces.
            items += [item for item in old.representations if isinstance(item, CurveOnSurface)]
        return replace(old, tolerance=new.tolerance, representations=tuple(items + on_surfaces))

    def _on_face(self, face: int, edge: int) -> list[CurveOnSurface]:
        return [CurveOnSurface(tuple(self._pcurve(pcurve.record) for pcurve in used.pcurves), used.continuity,
                               self._surface_records[face], self._location(used.place), used.pcurves[0].first,
                               used.pcurves[0].last)
                for used in self._faces[face].edges if used.edge == edge]

    def _pcurve(self, record: int | str) -> int:
        if isinstance(record, int):
            return record
        if record not in self._pcurve_records:
            self._new.curves_2d.append(record)
            self._pcurve_records[record] = len(self._new.curves_2d)
        return self._pcurve_records[record]

    def _vertex(self, old: VertexPoint, index: int) -> VertexPoint:
        new = self._vertices[index]
        if new.point is None:
            return replace(old, tolerance=new.tolerance)
        local = np.linalg.inv(self._locations.matrix(self._instances.vertices[index].place))
        x, y, z = (local[:3, :3] @ new.point + local[:3, 3]).tolist()
        return VertexPoint(new.tolerance, (x, y, z))

    def _add_surface(self, index: int, face: NewFace) -> int:
        instance = self._instances.faces[index]
        old = self._old.shapes[instance.shape].geometry
        assert isinstance(old, FaceSurface)
        local = np.linalg.inv(self._locations.matrix(product(instance.place, self._locations.chain(old.location))))
        points = face.surface.control_points @ local[:3, :3].T + local[:3, 3]
        self._new.surfaces.append(surface_text(replace(face.surface, control_points=points)))
        return len(self._new.surfaces)

    def _location(self, chain: Chain) -> int:
        if chain not in self._location_records:
            factors = " ".join(f"{index} {power}" for index, power in reversed(chain))
            self._new.locations.append(f"2 {factors} 0")
            self._location_records[chain] = len(self._new.locations)
        return self._location_records[chain]
