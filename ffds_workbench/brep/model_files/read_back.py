# SPDX-License-Identifier: LGPL-2.1-or-later
"""A written file, read back and compared with the shape that was written, number by number."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import Part

from ...registration.arrays import Array
from .. import topology
from ..topology import Topology
from ..validity import listed

_QUARTERS = np.array([0.25, 0.5, 0.75])
"""Where on an edge it is compared (theory: three places tell curves apart that have the same ends)."""
_SHIFT = 0.01
"""Unit: a reader may begin and end an edge elsewhere on its curve, which moves its middle by less than this share of
its length; another edge's middle lies farther off."""


@dataclass(frozen=True)
class ReadBack:
    """A file as it reads back.

    Attributes
    ----------
    suffix : its format
    shape, topology : what it holds
    faces, edges, vertices : the indices under which it has another one than the shape that was written, or that one
        put together differently
    edge_offset : largest distance in mm of an edge's middle from that of the edge written under the same number
    """

    suffix: str
    shape: Part.Shape
    topology: Topology
    faces: tuple[int, ...]
    edges: tuple[int, ...]
    vertices: tuple[int, ...]
    edge_offset: float

    def counts(self, written: Topology) -> list[str]:
        """What the file holds more or less of than was written.

        Compounds only hold things together, and STEP puts a shell around faces that stand by themselves.
        """
        here, there = self.topology.counts, written.counts
        alone = there["faces"] - len({face for faces in written.shell_faces for face in faces})
        free = {"compounds"} | ({"shells"} if alone else set())
        return [f"{here[kind]} {kind} instead of {there[kind]}" for kind in here
                if kind not in free and here[kind] != there[kind]]

    def differences(self, written: Topology) -> str:
        """Which numbers would refer to something else in the file, in words; empty if none."""
        counts = self.counts(written)
        if counts:
            return "hold " + ", ".join(counts)
        parts = [listed([f"{kind}{index + 1}" for index in indices]) for kind, indices in
                 (("Face", self.faces), ("Edge", self.edges), ("Vertex", self.vertices)) if indices]
        return f"give other numbers to {' and '.join(parts)}" if parts else ""


def compare(suffix: str, shape: Part.Shape, written: Topology, back: Part.Shape) -> ReadBack:
    """What was read back beside what was written.

    Loops may begin elsewhere and run against their surface's normal, and edges against their curve, as long as they
    go round their face as they did, seen from outside.
    """
    read = topology.read(back)
    result = ReadBack(suffix, back, read, (), (), (), float("inf"))
    if result.counts(written):
        return result
    here, there = _places(shape), _places(back)
    turned = (np.linalg.norm(here - there[:, ::-1], axis=2).sum(axis=1)
              < np.linalg.norm(here - there, axis=2).sum(axis=1))
    middles = np.linalg.norm(here[:, 1] - there[:, 1], axis=1)
    allowed = np.array([a.Tolerance + b.Tolerance for a, b in zip(shape.Edges, back.Edges, strict=True)])
    allowed += _SHIFT * np.linalg.norm(np.diff(here, axis=1), axis=2).sum(axis=1)
    points = np.array([tuple(vertex.Point) for part in (shape, back) for vertex in part.Vertexes])
    apart = np.linalg.norm(np.subtract(*points.reshape(2, -1, 3)), axis=1)
    near = np.array([a.Tolerance + b.Tolerance for a, b in zip(shape.Vertexes, back.Vertexes, strict=True)])
    edges = [index for index, (was, is_now) in enumerate(zip(written.edge_vertices, read.edge_vertices, strict=True))
             if set(was) != set(is_now) or middles[index] > allowed[index]
             or written.degenerate[index] != read.degenerate[index]]
    faces = [index for index in range(written.counts["faces"])
             if _loops(written, index, np.zeros_like(turned)) != _loops(read, index, turned)]
    if written.solid_faces != read.solid_faces or not set(written.shell_faces) <= set(read.shell_faces):
        faces = list(range(written.counts["faces"]))
    return replace(result, faces=tuple(faces), edges=tuple(edges),
                   vertices=tuple(np.flatnonzero(apart > near).tolist()), edge_offset=float(middles.max(initial=0.0)))


def _places(shape: Part.Shape) -> Array:
    """Each edge at a quarter, half and three quarters of its range: (n, 3, 3) in mm."""
    return np.array([topology.points_on_edge(edge, _QUARTERS) for edge in shape.Edges]).reshape(-1, 3, 3)


def _loops(of: Topology, face: int, turned: Array) -> list[list[tuple[int, bool]]]:
    """The loops of a face as the edges they go along and the sense in which they do; senses of points say nothing."""
    return [sorted((edge, bool(sense != turned[edge]) and not of.degenerate[edge])
                   for edge, sense in zip(edges, senses, strict=True))
            for edges, senses in zip(of.face_wires[face], of.wire_senses[face], strict=True)]
