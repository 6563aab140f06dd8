# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses held by the model: each by the nearest edge or face, so that it moves and turns with what is there.

A pose near an edge is held by (edge, fraction) and turns with the edge's torch frame; any other by (face, u, v) and
turns with the face's tangent plane. Its offset from the model is kept, rotated.
"""
from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import FreeCAD
import numpy as np
import Part

from ...errors import RefusedError
from ...registration.arrays import Array
from ..chains import Stretch
from ..find import NAMED_TOLERANCE
from ..frames import torch_frames
from ..joints import find_joints
from ..pairing import PairedFace, paired_face, paired_fractions
from ..stations import beside
from ..weldment import Weldment, towards_middle

EDGE_REACH = 1.0
"""A pose nearer than this (mm) to an edge is held by it, as a seam is."""
_REACH_SHARE = 0.5
"""Poses farther away than this share of the model's diagonal are held by nothing."""


@dataclass(frozen=True)
class Motion:
    """How poses move from the nominal to the as-built model.

    Attributes
    ----------
    held : (n,) False where a pose is too far from the model to move with it
    origin, target : (n, 3) points of the nominal and the as-built model that hold the poses, in mm
    rotation : (n, 3, 3)
    """

    held: Array
    origin: Array
    target: Array
    rotation: Array

    def points(self, points: Array) -> Array:
        """Points (n, 3) carried along."""
        return self.target + self.vectors(points - self.origin)

    def vectors(self, vectors: Array) -> Array:
        """Directions (n, 3), or frames (n, 3, 3) with axes as columns, turned along."""
        if vectors.ndim == 2:
            return np.einsum("nij,nj->ni", self.rotation, vectors)
        return self.rotation @ vectors


@dataclass(frozen=True)
class _Anchor:
    edge: int | None
    face: int | None
    at: tuple[float, float]


def motion(nominal: Weldment, as_built: Weldment, points: Array) -> Motion:
    """How the model carries poses at points (n, 3) of the nominal model along.

    Raises
    ------
    RefusedError : no pose is near the model, or a face's parameters were not kept
    """
    finder = _Finder(nominal)
    candidates = [finder(point) for point in points]
    held_by = Counter(anchor.edge for several in candidates for anchor in several)
    # Where edges meet, the path stays with the one that it follows elsewhere.
    anchors = [max(several, key=lambda anchor: held_by[anchor.edge]) if several else None for several in candidates]
    held = np.array([anchor is not None for anchor in anchors])
    if not held.any():
        raise RefusedError("No pose of the path is near the nominal model: is the path in mm, and in the model's "
                           "frame?")
    origin, target, rotation = points.copy(), points.copy(), np.tile(np.eye(3), (len(points), 1, 1))
    for edge in sorted({anchor.edge for anchor in anchors if anchor and anchor.edge is not None}):
        rows = np.array([i for i, anchor in enumerate(anchors) if anchor and anchor.edge == edge])
        fractions = np.array([anchors[i].at[0] for i in rows])
        origin[rows], target[rows], rotation[rows] = _edge_motion(nominal, as_built, edge, fractions)
    paired = {face: paired_face(nominal, as_built, face) for face in
              {anchor.face for anchor in anchors if anchor and anchor.face is not None}}
    for row, anchor in enumerate(anchors):
        if anchor and anchor.face is not None:
            origin[row], target[row], rotation[row] = _face_motion(nominal, as_built, anchor.face,
                                                                   paired[anchor.face], anchor.at)
    return Motion(held, origin, target, rotation)


class _Finder:
    """What can hold a pose: an edge, or several where they meet, or a face, or nothing near enough."""

    def __init__(self, nominal: Weldment) -> None:
        self._nominal = nominal
        topology = nominal.topology
        self._edges = [edge for edge in range(len(nominal.edges))
                       if not topology.degenerate[edge] and len(topology.edge_faces[edge]) == 2]
        self._wires = Part.makeCompound([nominal.edges[edge] for edge in self._edges]) if self._edges else None
        self._surfaces = Part.makeCompound(nominal.faces)
        self._reach = _REACH_SHARE * nominal.shape.BoundBox.DiagonalLength

    def __call__(self, point: Array) -> list[_Anchor]:
        vertex = Part.Vertex(*point.tolist())
        distance, feet, supports = vertex.distToShape(self._surfaces)
        if distance > self._reach:
            return []
        if self._wires is not None:
            to_edge, on_edge, _ = vertex.distToShape(self._wires)
            if to_edge <= max(EDGE_REACH, distance + 1e-6):
                return self._on_edges(vertex, to_edge, on_edge[0][1])
        kind, index, parameter = supports[0][3:6]
        if kind != "Face":
            faces = self._nominal.faces
            index = min(range(len(faces)), key=lambda face: vertex.distToShape(faces[face])[0])
            parameter = faces[index].Surface.parameter(feet[0][1])
        return [_Anchor(None, index, parameter)]

    def _on_edges(self, vertex: Part.Vertex, distance: float, foot: FreeCAD.Vector) -> list[_Anchor]:
        anchors = []
        for index in self._edges:
            edge = self._nominal.edges[index]
            if edge.distToShape(vertex)[0] <= distance + 1e-6:
                start, end = edge.ParameterRange
                at = edge.Curve.parameter(foot)
                if edge.isClosed():
                    at = start + (at - start) % (end - start)
                anchors.append(_Anchor(index, None, (float(np.clip((at - start) / (end - start), 0.0, 1.0)), 0.0)))
        return anchors


def _edge_motion(nominal: Weldment, as_built: Weldment, edge: int, fractions: Array) -> tuple[Array, Array, Array]:
    stretch = Stretch(edge, 0.0, 1.0, nominal.sides(edge))
    joints, _ = find_joints(nominal, NAMED_TOLERANCE, [edge])
    if joints:
        longest = max(joints, key=lambda joint: joint.end - joint.start)
        stretch = Stretch(edge, 0.0, 1.0, longest.faces)
    before = beside(nominal, stretch, fractions)
    after = beside(as_built, stretch, paired_fractions(nominal, as_built, edge, fractions))
    turned = [torch_frames(place.tangents, place.n1, place.n2) for place in (before, after)]
    return before.positions, after.positions, turned[1] @ np.swapaxes(turned[0], 1, 2)


def _face_motion(nominal: Weldment, as_built: Weldment, face: int, paired: PairedFace,
                 uv: tuple[float, float]) -> tuple[Array, Array, Array]:
    places = [_tangent_plane(nominal.faces[face], *uv), _tangent_plane(as_built.faces[face], *paired.uv(*uv))]
    places[1][1][:, :2] = places[1][1][:, :2] @ paired.turn
    places[1][1][:, 2] *= np.linalg.det(paired.turn)
    # The rotation nearest to the map of the tangent planes, by polar decomposition.
    left, _, right = np.linalg.svd(places[1][1] @ np.linalg.inv(places[0][1]))
    turn = left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    return places[0][0], places[1][0], turn


def _tangent_plane(face: Part.Face, u: float, v: float) -> tuple[Array, Array]:
    """A point of a face, and as columns both derivatives and the unit normal; off the face's poles."""
    at = np.array(tuple(face.Surface.value(u, v)))
    inner_u, inner_v = towards_middle(face, u, v)
    along_u, along_v = (np.array(tuple(face.Surface.getDN(inner_u, inner_v, *order))) for order in ((1, 0), (0, 1)))
    normal = np.cross(along_u, along_v)
    return at, np.stack([along_u, along_v, normal / np.linalg.norm(normal)], axis=1)
