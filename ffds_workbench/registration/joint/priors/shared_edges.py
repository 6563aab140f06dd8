# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places along the edges that two faces share: where each face has them, and which way the edge runs there."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Index
from ..surfaces import FacePlaces, JointPart, Lattices, places_on_faces

_POLE = 0.01
"""Share of the largest |S_u × S_v| along an edge below which it is that of a pole, where a normal turns anyhow with the
least displacement. Theory: it falls to zero there in proportion to the distance; from 1e-6 to 0.1 nothing changes."""


@dataclass(frozen=True)
class SharedEdgePlaces:
    """n places along all edges that two faces share, edge by edge.

    Attributes
    ----------
    first, second : the places on one face and on the other
    edge : (n,) number of the edge
    length : (n,) of the edge in mm that a place stands for
    direction : (n, 3) unit direction of the edge
    left : (2, n) whether the first and the second face lie left of it, seen from outside
    angled : (n,) whether both faces have a normal there, and so an angle
    """

    first: FacePlaces
    second: FacePlaces
    edge: Index
    length: Array
    direction: Array
    left: NDArray[np.bool_]
    angled: NDArray[np.bool_]

    def along(self, place: Array) -> Array:
        """Unit directions of the edges through places (n, 3) on them."""
        return directions(place, self.edge)

    def take(self, which: NDArray[np.bool_]) -> SharedEdgePlaces:
        """Those of the samples that ``which`` (n,) tells."""
        return SharedEdgePlaces(self.first.take(which), self.second.take(which), self.edge[which], self.length[which],
                                self.direction[which], self.left[:, which], self.angled[which])


def shared_edge_places(part: JointPart, lattices: Lattices) -> SharedEdgePlaces:
    """Places along all edges of a part that two of its faces share; poles are left out."""
    face: tuple[list[Index], list[Index]] = ([], [])
    uv: tuple[list[Array], list[Array]] = ([], [])
    edge, length, direction, left = [], [], [], []
    for number, shared in enumerate(part.edges):
        if shared.degenerate or len(shared.faces) < 2:
            continue
        for other in range(1, len(shared.faces)):
            for side, k in enumerate((0, other)):
                face[side].append(np.full(len(shared.points), shared.faces[k]))
                uv[side].append(shared.uv[k])
            along = np.gradient(shared.points, axis=0)
            step = np.linalg.norm(along, axis=1)
            edge.append(np.full(len(step), number))
            length.append(step)
            direction.append(along / np.maximum(step, 1e-12)[:, None])
            left.append(np.repeat([[shared.left[0]], [shared.left[other]]], len(step), axis=1))
    none = [np.zeros((0, 2))]
    both = places_on_faces(part.faces, lattices, np.concatenate([np.zeros(0, dtype=np.intp), *face[0], *face[1]]),
                           np.concatenate(none + uv[0] + uv[1]))
    first, second = (both.take(half) for half in np.arange(len(both)).reshape(2, -1))
    edges = np.concatenate([np.zeros(0, dtype=np.intp), *edge])
    return SharedEdgePlaces(first, second, edges, np.concatenate([np.zeros(0), *length]),
                            np.concatenate([np.zeros((0, 3)), *direction]),
                            np.concatenate([np.zeros((2, 0), dtype=bool), *left], axis=1),
                            _has_normal(first, edges) & _has_normal(second, edges))


def _has_normal(side: FacePlaces, edge: Index) -> NDArray[np.bool_]:
    """Whether a face has a normal at places on edges: at the pole of a sphere, say, S_u × S_v vanishes: (n,)."""
    area = np.linalg.norm(np.cross(side.nominal[1], side.nominal[2]), axis=1)
    largest = np.zeros(edge.max(initial=-1) + 1)
    np.maximum.at(largest, edge, area)
    return np.asarray(area > _POLE * largest[edge])


def directions(place: Array, edge: Index) -> Array:
    """Unit directions through places (n, 3) one after the other along edges (n,), by central differences: (n, 3).

    Parameters
    ----------
    place : (n, 3) in mm
    edge : (n,) number of the edge that a place lies on
    """
    after, before = np.roll(place, -1, axis=0), np.roll(place, 1, axis=0)
    last, first = np.roll(edge, -1) != edge, np.roll(edge, 1) != edge
    step = np.where(last[:, None], place, after) - np.where(first[:, None], place, before)
    return np.asarray(step / np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12))
