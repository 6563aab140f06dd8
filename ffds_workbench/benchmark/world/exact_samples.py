# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random points on the faces of any shape, evaluated by OCCT on the exact surfaces: nothing of FFDS's own reading of
faces takes part, so that a mistake there shows as an error."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import Part
from FreeCAD import Vector
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...registration.arrays import Array

_SAG, _FINEST = 2e-4, 0.015
"""Largest distance of the mesh from the faces, of the diagonal of the part's box, and the least in mm: below some
0.01 mm OCCT's mesher makes hundreds of thousands of triangles of a small torus. The mesh says where to draw points and
what hides what, not where a point lies (unit; the least calibrated: by hand, on a rod end of 6 mm)."""
_LONGEST = 1 / 120
"""Longest side of a triangle, of the same diagonal: what is flat may be bent afterwards."""


@dataclass(frozen=True)
class Triangles:
    """The meshes of all faces: corners (m, 3, 5) as x, y, z in mm and u, v; face index (m,)."""

    corners: Array
    face: NDArray[np.intp]

    @property
    def points(self) -> Array:
        """Corners in space, (m, 3, 3)."""
        return self.corners[:, :, :3]

    @property
    def area_vectors(self) -> Array:
        """Outward normals as long as twice the areas, (m, 3)."""
        a, b, c = self.points.transpose(1, 0, 2)
        return np.cross(b - a, c - a)


@dataclass(frozen=True)
class ExactSamples:
    """Points on faces: positions and outward unit normals (n, 3), face index (n,), (u, v) (n, 2)."""

    points: Array
    normals: Array
    face: NDArray[np.intp]
    uv: Array


def triangulate(shape: Part.Shape) -> Triangles:
    """Mesh every face; one that OCCT cannot mesh has no triangles."""
    size = shape.BoundBox.DiagonalLength
    meshes = [_divided(_mesh(face, _sag(size)), _LONGEST * size) for face in shape.Faces]
    return Triangles(np.concatenate(meshes), np.repeat(np.arange(len(meshes)), [len(mesh) for mesh in meshes]))


def draw(shape: Part.Shape, triangles: Triangles, counts: NDArray[np.intp], rng: np.random.Generator) -> ExactSamples:
    """So many random points on each face (per face, (faces,)), uniform over the area; none where there is no mesh."""
    chosen, across = [], triangles.area_vectors
    area = np.linalg.norm(across, axis=1)
    for index, count in enumerate(counts):
        own = np.flatnonzero(triangles.face == index)
        if len(own) and area[own].sum() > 0:
            chosen.append(rng.choice(own, count, p=area[own] / area[own].sum()))
    pick = np.concatenate(chosen)
    weights = rng.dirichlet(np.ones(3), len(pick))
    drawn = np.einsum("nc,nck->nk", weights, triangles.corners[pick])
    outward = across[pick] / np.maximum(area[pick], 1e-300)[:, None]
    face, size = triangles.face[pick], shape.BoundBox.DiagonalLength
    points, normals, uv = np.empty_like(outward), outward.copy(), drawn[:, 3:].copy()
    for index in np.unique(face):
        own = np.flatnonzero(face == index)
        surface = shape.Faces[index].Surface
        points[own], uv[own] = _on_surface(surface, uv[own], drawn[own, :3], 4 * _sag(size))
        normals[own] = _normals(surface, uv[own], outward[own])
    return ExactSamples(points, normals, face, uv)


def _sag(size: float) -> float:
    """Largest distance in mm of the mesh from the faces of a part of that size."""
    return max(_SAG * size, _FINEST)


def _mesh(face: Part.Face, sag: float) -> Array:
    """Triangles of a face, (m, 3, 5); the parameters of a corner are those of the mesh's node in its place."""
    vertices, triangles = face.tessellate(sag)
    if not triangles:
        return np.zeros((0, 3, 5))
    uv, value = np.array(face.getUVNodes()), face.Surface.value
    points = np.array([tuple(point) for point in vertices])
    nodes = np.array([tuple(value(u, v)) for u, v in uv.tolist()])
    uv = uv[cKDTree(nodes).query(points)[1]]
    return np.concatenate([points, uv], axis=1)[np.array(triangles)]


def _divided(corners: Array, longest: float) -> Array:
    """Halve triangles across their longest side until none is longer; slivers are cut into strips, of which there are
    fewer."""
    done = []
    while len(corners):
        sides = np.linalg.norm(corners[:, :, :3] - np.roll(corners[:, :, :3], -1, axis=1), axis=2)
        large, narrow = sides.max(axis=1) > longest, sides.min(axis=1) <= longest
        done.append(corners[~large])
        strips = _strips(corners[large & narrow], sides[large & narrow], longest)
        corners, start = corners[large & ~narrow], sides[large & ~narrow].argmax(axis=1)
        row = np.arange(len(corners))
        a, b, c = (corners[row, (start + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        corners = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1), *strips])
    return np.concatenate(done) if done else corners


def _strips(corners: Array, sides: Array, longest: float) -> list[Array]:
    """Triangles (m, 3, 5) cut along their shortest side, no strip wider than ``longest``, and every strip in two."""
    first = sides.argmin(axis=1)
    row = np.arange(len(corners))
    b, c, apex = (corners[row, (first + k) % 3] for k in range(3))
    pieces = np.ceil(sides.max(axis=1) / longest).astype(int)
    result = []
    for count in np.unique(pieces):
        own = pieces == count
        share = np.linspace(0, 1, count + 1)[:, None]
        left, right = (apex[own, None] + share * (end[own, None] - apex[own, None]) for end in (b, c))
        result += [np.stack([left[:, :-1], left[:, 1:], right[:, 1:]], axis=2).reshape(-1, 3, 5),
                   np.stack([left[:, 1:-1], right[:, 2:], right[:, 1:-1]], axis=2).reshape(-1, 3, 5)]
    return result


def _on_surface(surface: Part.Surface, uv: Array, near: Array, sag: float) -> tuple[Array, Array]:
    """Points at (u, v) and the (u, v); where a triangle lies across a seam, those closest to the mesh instead."""
    points = np.array([tuple(surface.value(u, v)) for u, v in uv.tolist()])
    for k in np.flatnonzero(np.linalg.norm(points - near, axis=1) > sag):
        uv[k] = surface.parameter(Vector(*near[k]))
        points[k] = tuple(surface.value(*uv[k]))
    return points, uv


def _normals(surface: Part.Surface, uv: Array, outward: Array) -> Array:
    """Unit normals of the surface on the side of the mesh's; the mesh's where the surface has none."""
    normals = outward.copy()
    for k, (u, v) in enumerate(uv.tolist()):
        try:
            normals[k] = tuple(surface.normal(u, v))
        except (RuntimeError, Part.OCCError):  # a pole
            continue
    return normals * np.where(np.einsum("ij,ij->i", normals, outward) < 0, -1.0, 1.0)[:, None]
