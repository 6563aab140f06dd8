# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which faces adapt to an edit, and the edges that have to stay where they are."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from ..workpiece import Workpiece
from .cutoff import SPACING, Cutoff
from .edge_samples import EdgeSamples, along_edge, join_samples
from .radial_basis import RadialField

_ROOM_FACTOR = 5.0
"""An edge may stay if it is farther from the edited faces than this many times the displacement there (theory: the
slope of what fades is then below a half), …"""
_SPARE_REACH = 1.1
"""… and if it needs no more than this many times that distance to hold, or the edited faces would be held as well
(theory: at its reach a straight edge is 1.2 away, and the factor has become 1 from 1.05 on)."""
_TAPER_SHARES = 0.05, 0.5
"""Where a frozen face touches an edited one, the displacement fades over five times itself, but between these shares of
the edited face's size (unit)."""
_TOLERANCE_ROOM = 30.0
"""Least reach of a held edge over its tolerance (theory: its faces' own traces of it then lie where the factor is
exactly 0)."""


@dataclass(frozen=True)
class Held:
    """What an edit moves and what it must not.

    Attributes
    ----------
    adapting : indices of the faces that adapt, the edited ones not among them
    cutoff : factor that is 0 along the edges that stay
    """

    adapting: tuple[int, ...]
    cutoff: Cutoff


@dataclass(frozen=True)
class _EdgeCandidate:
    """An edge, or a vertex alone, that may have to stay: samples, and the reach of the factor there in mm."""

    samples: EdgeSamples
    reach: Array
    crowded: bool
    still: bool


class _Surroundings:
    """Displacement and distance from the edited faces, as seen from an edge or vertex."""

    def __init__(self, workpiece: Workpiece, edited: frozenset[int], frozen: frozenset[int], smooth: RadialField,
                 tree: cKDTree, size: float) -> None:
        topology = workpiece.topology
        self.workpiece, self.smooth, self.tree, self.size = workpiece, smooth, tree, size
        touching = topology.faces_around(edited) & frozen
        self.touched_edges = {edge for face in touching for edge in topology.face_edges[face]}
        self.touched_vertices = {vertex for face in touching for vertex in topology.face_vertices[face]}
        self._edges: dict[int, _EdgeCandidate] = {}

    def edge(self, edge: int) -> _EdgeCandidate:
        if edge not in self._edges:
            touched = edge in self.touched_edges
            samples = along_edge(self.workpiece, edge, lambda points: SPACING * self._reach(points, touched))
            resolved = samples.lengths / SPACING
            tolerance = self.workpiece.edges[edge].Tolerance
            self._edges[edge] = self._candidate(samples, touched, np.maximum(resolved, _TOLERANCE_ROOM * tolerance))
        return self._edges[edge]

    def vertex(self, vertex: int) -> _EdgeCandidate:
        shape = self.workpiece.shape.Vertexes[vertex]
        points = np.array([tuple(shape.Point)])
        touched = vertex in self.touched_vertices
        reach = self._reach(points, touched)
        samples = EdgeSamples(np.array([-1]), np.zeros(1), points, reach)
        return self._candidate(samples, touched, np.full(1, max(_TOLERANCE_ROOM * shape.Tolerance, 1e-6)))

    def _candidate(self, samples: EdgeSamples, touched: bool, least: Array) -> _EdgeCandidate:
        displacement = np.linalg.norm(self.smooth(samples.points), axis=1)
        distance = self.tree.query(samples.points)[0]
        near = self._reach(samples.points, touched)
        crowded = (distance < _ROOM_FACTOR * displacement) | (least > _SPARE_REACH * near)
        return _EdgeCandidate(samples, np.maximum(near, least), bool(crowded.any()), not displacement.any())

    def _reach(self, points: Array, touched: bool) -> Array:
        distance = self.tree.query(points)[0]
        if not touched:
            return distance
        displacement = np.linalg.norm(self.smooth(points), axis=1)
        least, largest = _TAPER_SHARES
        return np.maximum(distance, np.clip(_ROOM_FACTOR * displacement, least * self.size, largest * self.size))


def held_edges(workpiece: Workpiece, edited: frozenset[int], frozen: frozenset[int], smooth: RadialField,
               tree: cKDTree, size: float) -> Held:
    """Grow the set of adapting faces until what stays is far enough away, and hold the rest.

    The faces that share a vertex with an edited face adapt; then, while an edge that must stay is nearer to the edited
    faces than five times the displacement there, or than it takes to hold it, the faces across it too. Frozen faces
    never do.

    Parameters
    ----------
    workpiece : the shape
    edited, frozen : indices of faces
    smooth : Φ, the displacement before anything is held
    tree : points on the edited faces
    size : size of the largest edited face in mm
    """
    surroundings = _Surroundings(workpiece, edited, frozen, smooth, tree, size)
    moving = workpiece.topology.faces_around(edited) - frozen
    while True:
        edges, vertices = _border(workpiece, moving)
        edge_candidates = {edge: surroundings.edge(edge) for edge in edges}
        vertex_candidates = {vertex: surroundings.vertex(vertex) for vertex in vertices}
        crowded = _owners(workpiece.topology.edge_faces, edge_candidates) | _owners(workpiece.topology.vertex_faces,
                                                                                   vertex_candidates)
        if not crowded - moving - frozen:
            break
        moving |= crowded - frozen
    held = [candidate for candidate in (*edge_candidates.values(), *vertex_candidates.values()) if not candidate.still]
    samples = join_samples(candidate.samples for candidate in held)
    reach = np.concatenate([candidate.reach for candidate in held]) if held else np.empty(0)
    return Held(tuple(sorted(moving - edited)), Cutoff(samples.points, samples.lengths, reach))


def _border(workpiece: Workpiece, moving: set[int]) -> tuple[set[int], set[int]]:
    """Edges and lone vertices of the moving faces that belong to a face that stays, too."""
    topology = workpiece.topology
    edges = {edge for face in moving for edge in topology.face_edges[face]
             if not moving.issuperset(topology.edge_faces[edge])}
    on_edges = {vertex for edge in edges for vertex in topology.edge_vertices[edge]}
    vertices = {vertex for face in moving for vertex in topology.face_vertices[face]
                if vertex not in on_edges and not moving.issuperset(topology.vertex_faces[vertex])}
    return edges, vertices


def _owners(incidence: tuple[tuple[int, ...], ...], candidates: dict[int, _EdgeCandidate]) -> set[int]:
    """Faces at the edges or vertices that are too near to stay."""
    crowded: Iterable[int] = (number for number, candidate in candidates.items() if candidate.crowded)
    return {face for number in crowded for face in incidence[number]}
