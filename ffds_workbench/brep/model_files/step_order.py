# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stores a shape so that its STEP file reads back with the same numbers.

Edges and vertices are numbered in the order in which a walk through faces and loops meets them. A STEP file holds less
than a shape: no edge lists its end before its start, and a loop that runs against its face is reversed where OCCT's
reader repairs something in it, be it a pcurve that ends a hair off its vertex (``ShapeFix_Face`` makes the wire anew,
FORWARD, with its edges in the other order). So the loops of every free-form face are stored along the face, begun so
that the edges that they meet first keep their order; where no beginning does that, the surface is turned, and with it
the sense of its loops. An edge is turned where its vertices, both met there first, would change places.
"""
from __future__ import annotations

from dataclasses import replace
from typing import cast

import numpy as np
import Part

from ...registration.arrays import Array
from ..occt_text.curves import read_curve
from ..occt_text.instances import Instance, Locations, composed, product, walk
from ..occt_text.records import (
    BrepText,
    Curve3d,
    CurveOnSurface,
    EdgeCurves,
    FaceSurface,
    ShapeReference,
    VertexPoint,
    dump,
    parse,
)
from ..occt_text.turned import PlaneRecord, SplineRecord, read_surface, turned_curve
from .step_loops import Loop, LoopEdge, backwards, begun, chained, in_order, other


def ordered(shape: Part.Shape) -> Part.Shape:
    """The shape, its loops, surfaces and edges turned where its STEP file would not keep the numbers otherwise.

    Raises
    ------
    RefusedError : the shape's BREP text cannot be read
    """
    brep = parse(shape.exportBrepToString())
    arrangement = _Arrangement(brep)
    arrangement.turn_loops()
    arrangement.turn_edges()
    result = Part.Shape()
    result.importBrepFromString(dump(_rewritten(arrangement)))
    return result


def disordered(shape: Part.Shape) -> tuple[int, ...]:
    """Indices of the faces round which the edges go in an order that is neither that of their numbers nor its reverse.

    No STEP file can number them so: OCCT's reader first of all puts the edges of a loop in the order in which they
    follow each other in space (``ShapeFix_Wire::FixReorder``). Only what it divides later, an edge through the pole of
    a face met after this one, comes into this loop in another order.
    """
    return _Arrangement(parse(shape.exportBrepToString())).disordered()


class _Arrangement:
    """What has to be turned, by position of the shape in the text; the first place where a shape stands decides.

    Attributes
    ----------
    brep : the records; geometry that is turned is changed or added here
    loops : for each face whose loops change, its wires anew
    faces, edges : the positions of those that are turned
    """

    def __init__(self, brep: BrepText) -> None:
        self.brep = brep
        self.loops: dict[int, list[Loop]] = {}
        self.faces: set[int] = set()
        self.edges: set[int] = set()
        self._locations = Locations(brep.locations)
        self._instances = walk(brep, self._locations)
        self._number = {instance: index for index, instance in enumerate(self._instances.edges)}
        self._ends = [self._ends_of(uses) for uses in self._instances.edge_ends]
        self._degenerated = [self._curves(edge.shape).degenerated for edge in self._instances.edges]
        users = [shape.geometry.surface for shape in brep.shapes if isinstance(shape.geometry, FaceSurface)]
        self._users = {surface: users.count(surface) for surface in set(users)}

    @staticmethod
    def _ends_of(uses: list[tuple[int, str]]) -> tuple[int, int]:
        found = {orientation: vertex for vertex, orientation in uses}
        return found.get("+", -1), found.get("-", -1)

    def _curves(self, edge: int) -> EdgeCurves:
        curves = self.brep.shapes[edge].geometry
        assert isinstance(curves, EdgeCurves)
        return curves

    def _surface(self, face: int) -> FaceSurface:
        surface = self.brep.shapes[face].geometry
        assert isinstance(surface, FaceSurface)
        return surface

    def turn_loops(self) -> None:
        """Store loops along their faces, begun where they should."""
        met: set[int] = set()
        for face, uses in zip(self._instances.faces, self._instances.face_uses, strict=True):
            if face.shape not in self.loops:
                self._arrange(face, met)
            met.update(use.edge for use in uses)

    def disordered(self) -> tuple[int, ...]:
        """The faces whose loops begin nowhere as they should, along the face or against it."""
        met: set[int] = set()
        found = []
        for index, face in enumerate(self._instances.faces):
            loops = self._loops(face)
            against = [backwards(loop) for loop in loops]
            if not any(map(self._is_whole, loops)) and None is self._begun(loops, met) is self._begun(against, met):
                found.append(index)
            met.update(use.edge for loop in loops for use in loop)
        return tuple(found)

    def _loops(self, face: Instance) -> list[Loop]:
        """The loops of a face in order, none of them where one has no order."""
        wires = [child for child in self.brep.shapes[face.shape].children if self.brep.shapes[child.shape].kind == "Wi"]
        loops = [self._chained(face.shape, self._loop(face, wire)) for wire in wires]
        return [loop for loop in loops if loop] if all(loops) else []

    def _arrange(self, face: Instance, met: set[int]) -> None:
        loops = self._loops(face)
        if not loops:
            return
        number = self._surface(face.shape).surface
        surface = read_surface(self.brep.surfaces[number - 1]) if self._users[number] == 1 else None
        if len(loops) == 1 and isinstance(surface, SplineRecord) and self._is_whole(loops[0]):
            self._turn(face.shape, self._as_read_whole(face.shape, loops[0], surface), loops)
            return
        begun_loops = self._begun(loops, met)
        if begun_loops is not None:
            self.loops[face.shape] = begun_loops
        elif surface is not None:
            begun_loops = self._begun([backwards(loop) for loop in loops], met)
            if begun_loops is not None:
                self._turn(face.shape, surface.turned(), [backwards(loop) for loop in begun_loops])

    def _is_ring(self, loop: Loop) -> bool:
        """Whether the loop is two seams that meet in one vertex, as on a torus: by that they follow each other in any
        order, and those who draw a torus list them in either."""
        return len(loop) == 4 and len({use.edge for use in loop}) == 2 == len(
            {use.edge for use in loop if self._ends[use.edge][0] == self._ends[use.edge][1]})

    def _is_whole(self, loop: Loop) -> bool:
        """Whether the loop is one seam there and back, as round a sphere: STEP says of such a face just one vertex."""
        return len({use.edge for use in loop if not self._degenerated[use.edge]}) == 1 and len(loop) == 4

    def _as_read_whole(self, face: int, loop: Loop, surface: SplineRecord) -> SplineRecord:
        """The surface turned so that the loop that readers put around all of it meets its edges in their order.

        They begin at the side u = a, then come v = a, u = b and v = b.
        """
        poles = sorted(use.edge for use in loop if self._degenerated[use.edge])
        seam = next(use.edge for use in loop if use.edge not in poles)
        turned, axis = (surface.exchanged(), 0) if poles[0] < seam else (surface, 1)
        ends = (self._uv(face, next(use for use in loop if use.edge == pole)) for pole in poles)
        first, last = (np.mean(cast(Array, uv), axis=0) for uv in ends)  # a pole is nothing but its pcurve
        backwards_now = (turned.matrix @ (last - first))[axis] < 0
        return turned.turned(axis) if backwards_now else turned

    def _loop(self, face: Instance, wire: ShapeReference) -> Loop:
        """The uses of a wire in the order in which they follow each other along the face."""
        place = product(face.place, self._locations.chain(wire.location))
        stored = [(Instance(child.shape, product(place, self._locations.chain(child.location))), child)
                  for child in self.brep.shapes[wire.shape].children]
        uses = tuple(LoopEdge(self._number[edge], composed(wire.orientation, child.orientation), child)
                     for edge, child in stored)
        return uses[::-1] if wire.orientation == "-" else uses

    def _chained(self, face: int, loop: Loop) -> Loop | None:
        """The loop in order, whatever the order it is stored in."""
        if in_order(loop, self._ends) and not self._is_ring(loop):
            return loop
        uv = [self._uv(face, use) for use in loop]
        known = all(ends is not None for ends in uv)
        return chained(loop, self._ends, np.array(uv) if known else np.zeros((len(loop), 2, 2)))

    def _uv(self, face: int, use: LoopEdge) -> Array | None:
        """Where a use begins and ends in the face's (u, v): (2, 2)."""
        surface = self._surface(face).surface
        item = next((item for item in self._curves(use.reference.shape).representations
                     if isinstance(item, CurveOnSurface) and item.surface == surface), None)
        if item is None:
            return None
        index = item.pcurves[-1 if use.orientation == "-" else 0]
        ends = read_curve(self.brep.curves_2d[index - 1], 2)(np.array([item.first, item.last]))
        return ends[::-1] if use.orientation == "-" else ends

    def _begun(self, loops: list[Loop], met: set[int]) -> list[Loop] | None:
        """All loops of a face begun as they should be, or None."""
        met, result = set(met), []
        for loop in loops:
            turned = begun(loop, met, self._degenerated)
            if turned is None:
                return None
            result.append(turned)
            met.update(use.edge for use in loop)
        return result

    def _turn(self, face: int, surface: PlaneRecord | SplineRecord, loops: list[Loop]) -> None:
        """Give a face a turned surface; its pcurves follow, and its loops and its use where the normal turned too."""
        number = self._surface(face).surface
        self.brep.surfaces[number - 1] = surface.text()
        for edge in {use.reference.shape for loop in loops for use in loop}:
            items = tuple(self._on_turned(item, surface) if isinstance(item, CurveOnSurface)
                          and item.surface == number else item for item in self._curves(edge).representations)
            self._change(edge, items)
        self.loops[face] = [backwards(loop) for loop in loops] if surface.reversed else loops
        if surface.reversed:
            self.faces.add(face)

    def _on_turned(self, item: CurveOnSurface, surface: PlaneRecord | SplineRecord) -> CurveOnSurface:
        """A pcurve on a turned surface; of a seam's two the first belongs to the other use where that is turned."""
        records = [surface.pcurve(read_curve(self.brep.curves_2d[index - 1], 2), item.first, item.last)
                   for index in item.pcurves]
        added = self._added(self.brep.curves_2d, records)
        return replace(item, pcurves=added[::-1] if surface.reversed else added)

    def _change(self, edge: int, items: tuple) -> None:
        shape = self.brep.shapes[edge]
        self.brep.shapes[edge] = replace(shape, geometry=replace(self._curves(edge), representations=items))

    @staticmethod
    def _added(records: list[str], new: list[str]) -> tuple[int, ...]:
        records += new
        return tuple(range(len(records) - len(new) + 1, len(records) + 1))

    def turn_edges(self) -> None:
        """Turn the edges whose vertices would change places."""
        met: set[int] = set()
        for edge, (first, last) in zip(self._instances.edges, self._ends, strict=True):
            if 0 <= last < first and not {first, last} & met and edge.shape not in self.edges:
                self._turn_edge(edge.shape)
            met.update((first, last))

    def _turn_edge(self, edge: int) -> None:
        """Turn an edge's curve, pcurves and vertices; not where a vertex says at which parameter of a curve it is."""
        shape = self.brep.shapes[edge]
        vertices = [self.brep.shapes[child.shape].geometry for child in shape.children]
        if any(isinstance(vertex, VertexPoint) and vertex.representations for vertex in vertices):
            return
        self.edges.add(edge)
        self._change(edge, tuple(self._turned(item) for item in self._curves(edge).representations))
        children = sorted((replace(child, orientation=other(child.orientation)) for child in shape.children),
                          key=lambda child: child.orientation != "+")
        self.brep.shapes[edge] = replace(self.brep.shapes[edge], children=tuple(children))

    def _turned(self, item: object) -> object:
        """A representation of an edge that is turned; a seam's first pcurve goes with the other use now."""
        if isinstance(item, Curve3d):
            records = [turned_curve(read_curve(self.brep.curves_3d[item.curve - 1], 3), item.first, item.last)]
            return replace(item, curve=self._added(self.brep.curves_3d, records)[0])
        if isinstance(item, CurveOnSurface):
            records = [turned_curve(read_curve(self.brep.curves_2d[index - 1], 2), item.first, item.last)
                       for index in item.pcurves]
            return replace(item, pcurves=self._added(self.brep.curves_2d, records)[::-1])
        return item


def _rewritten(arrangement: _Arrangement) -> BrepText:
    """The text with its loops anew, and with turned faces and edges used the other way."""
    brep, shapes = arrangement.brep, []
    turned = arrangement.faces | arrangement.edges
    written: dict[int, int] = {}

    def used(child: ShapeReference) -> ShapeReference:
        orientation = other(child.orientation) if child.shape in turned else child.orientation
        return replace(child, orientation=orientation, shape=write(child.shape))

    def write(position: int) -> int:
        if position not in written:
            shape = brep.shapes[position]
            loops = iter(arrangement.loops.get(position, ()))
            children = []
            for child in shape.children:
                if position in arrangement.loops and brep.shapes[child.shape].kind == "Wi":
                    uses = tuple(used(replace(use.reference, orientation=use.orientation)) for use in next(loops))
                    shapes.append(replace(brep.shapes[child.shape], children=uses))
                    children.append(replace(child, orientation="+", shape=len(shapes) - 1))
                else:
                    children.append(used(child))
            shapes.append(replace(shape, children=tuple(children)))
            written[position] = len(shapes) - 1
        return written[position]

    root = used(brep.root)
    return replace(brep, shapes=shapes, root=root)
