# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sub-shapes of a BREP text as FreeCAD numbers them: every TShape once per place it stands at.

This module owns the walk through the text: locations, order, and which edges bound which face with which
orientation. It reads records and changes none.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...errors import RefusedError
from ...registration.arrays import Array
from .records import BrepText, ShapeReference

Chain = tuple[tuple[int, int], ...]
"""A location as OCCT compares it: elementary locations (index from 1) and their powers, outermost first."""

_ROUNDING = 1e-9
"""Largest difference of a determinant from ±1 of a placement that does not scale (theory: far above rounding)."""


class Locations:
    """Location records as chains and as matrices."""

    def __init__(self, records: Sequence[str]) -> None:
        self._matrices: dict[int, Array] = {}
        self._chains: list[Chain] = [()]
        for index, record in enumerate(records, start=1):
            tokens = record.split()
            if tokens[0] == "1":
                matrix = np.vstack([np.array(tokens[1:], dtype=float).reshape(3, 4), [0.0, 0.0, 0.0, 1.0]])
                if abs(abs(np.linalg.det(matrix[:3, :3])) - 1.0) > _ROUNDING:
                    raise RefusedError("The shape contains a scaled instance: apply the scale to its geometry first.")
                self._matrices[index] = matrix
                self._chains.append(((index, 1),))
            else:
                # Listed from the rightmost factor to the leftmost, ended by 0.
                chain: Chain = ()
                for factor, power in zip(tokens[1:-1:2], tokens[2:-1:2], strict=True):
                    chain = product(_power(self._chains[int(factor)], int(power)), chain)
                self._chains.append(chain)

    def chain(self, index: int) -> Chain:
        """Chain of location record ``index`` (0: the identity)."""
        return self._chains[index]

    def matrix(self, chain: Chain) -> Array:
        """(4, 4) matrix of a chain, local to outer coordinates."""
        matrix = np.eye(4)
        for index, power in chain:
            matrix = matrix @ np.linalg.matrix_power(self._matrices[index], power)
        return matrix


def product(a: Chain, b: Chain) -> Chain:
    """The location a·b, powers of one elementary location merged as OCCT merges them."""
    result = list(a)
    for index, power in b:
        if result and result[-1][0] == index:
            power += result.pop()[1]
        if power:
            result.append((index, power))
    return tuple(result)


def _power(chain: Chain, power: int) -> Chain:
    step = chain if power > 0 else inverse(chain)
    result: Chain = ()
    for _ in range(abs(power)):
        result = product(result, step)
    return result


def inverse(chain: Chain) -> Chain:
    """The location's inverse."""
    return tuple((index, -power) for index, power in reversed(chain))


@dataclass(frozen=True)
class EdgeUse:
    """One edge in a face's wires: index of the edge, orientation with the face taken FORWARD, its place in the face."""

    edge: int
    orientation: str
    place: Chain


@dataclass(frozen=True)
class Instance:
    """A TShape (position in the text) at a place (its whole location)."""

    shape: int
    place: Chain


@dataclass(frozen=True)
class Instances:
    """Faces, edges and vertices in FreeCAD's order, and how they meet.

    Attributes
    ----------
    faces, edges, vertices : instances; their position is FreeCAD's index
    face_uses : per face, the edges in its wires, in stored order; a seam appears twice
    edge_ends : per edge, its vertices as (vertex index, orientation with the edge taken FORWARD)
    edge_faces : per edge, the faces that use it, each once
    """

    faces: list[Instance] = field(default_factory=list)
    edges: list[Instance] = field(default_factory=list)
    vertices: list[Instance] = field(default_factory=list)
    face_uses: list[list[EdgeUse]] = field(default_factory=list)
    edge_ends: list[list[tuple[int, str]]] = field(default_factory=list)
    edge_faces: list[list[int]] = field(default_factory=list)


def composed(outer: str, inner: str) -> str:
    """Orientation of a child within its parent's orientation (OCCT's TopAbs::Compose)."""
    if inner in "ie" or outer == "+":
        return inner
    if outer in "ie":
        return outer
    return "-" if inner == "+" else "+"


def walk(brep: BrepText, locations: Locations) -> Instances:
    """Find all instances by the depth-first walk in which OCCT numbers sub-shapes."""
    result = Instances()
    containers: list[Instance] = []
    lists = {"Fa": result.faces, "Ed": result.edges, "Ve": result.vertices}
    known: dict[Instance, int] = {}

    def placed(reference: ShapeReference, outer: Chain) -> Instance:
        return Instance(reference.shape, product(outer, locations.chain(reference.location)))

    def visit(reference: ShapeReference, outer: Chain) -> None:
        instance = placed(reference, outer)
        if instance in known:
            return
        shape = brep.shapes[instance.shape]
        same_kind = lists.get(shape.kind, containers)
        known[instance] = len(same_kind)
        same_kind.append(instance)
        for child in shape.children:
            visit(child, instance.place)

    visit(brep.root, ())
    for edge in result.edges:
        result.edge_faces.append([])
        result.edge_ends.append([(known[placed(child, edge.place)], child.orientation)
                                 for child in brep.shapes[edge.shape].children])
    for index, face in enumerate(result.faces):
        uses = []
        for wire in brep.shapes[face.shape].children:
            in_wire = locations.chain(wire.location)
            for child in brep.shapes[wire.shape].children if brep.shapes[wire.shape].kind == "Wi" else ():
                place = product(in_wire, locations.chain(child.location))
                number = known[Instance(child.shape, product(face.place, place))]
                uses.append(EdgeUse(number, composed(wire.orientation, child.orientation), place))
                if index not in result.edge_faces[number]:
                    result.edge_faces[number].append(index)
        result.face_uses.append(uses)
    return result
