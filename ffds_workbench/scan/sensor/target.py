# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the virtual sensor looks at: trimmed faces, each deformed or not, sampled in their own (u, v).

Points are exact: they are evaluated on the face's surface and displaced there, never taken from a mesh.
"""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...registration.arrays import Array
from ...registration.face_geometry import FaceGeometry

Displace = Callable[[Array, Array], Array]
"""(uv (n, 2), nominal points (n, 3)) to displacements (n, 3) in mm."""

_CELL = 1.5
_MOST_LINES = 700


@dataclass(frozen=True)
class Samples:
    """Points on a target's faces: positions (n, 3), outward unit normals (n, 3), face index (n,), (u, v) (n, 2)."""

    points: Array
    normals: Array
    face: NDArray[np.intp]
    uv: Array

    def __getitem__(self, pick: NDArray) -> Samples:
        return Samples(self.points[pick], self.normals[pick], self.face[pick], self.uv[pick])

    def __len__(self) -> int:
        return len(self.points)


def inside_outlines(trims: Sequence[Array], uv: Array) -> NDArray[np.bool_]:
    """Which of the parameters (n, 2) lie on the material side of the trims, by the even-odd rule; (n,)."""
    from matplotlib.path import Path as Polygon

    inside = np.zeros(len(uv), dtype=bool)
    for polyline in trims:
        near = np.flatnonzero(((uv >= polyline.min(axis=0)) & (uv <= polyline.max(axis=0))).all(axis=1))
        inside[near] ^= Polygon(polyline).contains_points(uv[near])
    return inside


class Scene:
    """Faces and what displaces them.

    Parameters
    ----------
    faces : the faces, each with its outward side
    displace : per face index, how its points move; faces that are not named stand still
    """

    def __init__(self, faces: Sequence[FaceGeometry], displace: Mapping[int, Displace] | None = None) -> None:
        self.faces = tuple(faces)
        self.displace = dict(displace or {})

    def points(self, index: int, uv: Array) -> Array:
        """Points of a face, as it is now: (n, 2) to (n, 3)."""
        return self._displaced(index, uv, self.nominal(index, uv))

    def nominal(self, index: int, uv: Array) -> Array:
        """Points of a face before it was displaced: (n, 2) to (n, 3)."""
        return self.faces[index].surface(uv) if len(uv) else np.empty((0, 3))

    def on_grid(self, index: int, u: Array, v: Array) -> Array:
        """Points of a face on the grid u × v: (len(u), len(v), 3)."""
        nominal = self.faces[index].surface.on_grid(u, v).reshape(-1, 3)
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        return self._displaced(index, uv, nominal).reshape(len(u), len(v), 3)

    def _displaced(self, index: int, uv: Array, nominal: Array) -> Array:
        move = self.displace.get(index)
        return nominal if move is None else nominal + move(uv, nominal)

    @cached_property
    def cells(self) -> tuple[_FaceCells, ...]:
        """Per face, small (u, v) cells with their areas and normals."""
        return tuple(_cells(self, i) for i in range(len(self.faces)))

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """Lower and upper corner of the bounding box, (3,) each."""
        points = self.grid(2.0)
        return points.min(axis=0), points.max(axis=0)

    @property
    def centre(self) -> Array:
        return 0.5 * (self.box[0] + self.box[1])

    def sample(self, density: float | Sequence[float], rng: np.random.Generator) -> Samples:
        """Random points, uniform over the area, ``density`` per mm² (one number, or one per face)."""
        per_face = np.broadcast_to(np.asarray(density, dtype=float), len(self.faces))
        found = [cells.sample(self, i, d, rng) for i, (cells, d) in enumerate(zip(self.cells, per_face, strict=True))]
        return Samples(*(np.concatenate(parts) for parts in zip(*found, strict=True)))

    def boundary(self, step: float) -> Array:
        """Points along the trims of all faces, no farther apart than ``step`` mm; seams are no boundary; (n, 3)."""
        found = [np.empty((0, 3))]
        for i, face in enumerate(self.faces):
            for polyline in face.trims:
                start, end = polyline[:-1], polyline[1:]
                real = ~_on_seam(face, start, end)
                start, end = start[real], end[real]
                length = np.linalg.norm(self.points(i, end) - self.points(i, start), axis=1)
                middle = self.points(i, 0.5 * (start + end))
                length = np.maximum(length, 2 * np.linalg.norm(middle - self.points(i, start), axis=1))
                pieces = np.ceil(length / step).astype(int)
                segment = np.repeat(np.arange(len(start)), pieces)
                share = (np.arange(len(segment)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[segment]
                found.append(self.points(i, start[segment] + share[:, None] * (end - start)[segment]))
        return np.concatenate(found)

    def grid(self, step: float) -> Array:
        """Regular points no farther apart than ``step`` mm, on all faces, boundaries left out; (n, 3)."""
        return np.concatenate([cells.grid(self, i, step) for i, cells in enumerate(self.cells)])


@dataclass(frozen=True)
class _FaceCells:
    """Cells of one face between the lines u (m,) and v (n,): areas (m−1, n−1) in mm², outward normals (m−1, n−1, 3).

    ``sides``: longest side of the cells of each strip, in u (m−1,) and in v (n−1,), in mm.
    """

    u: Array
    v: Array
    area: Array
    normal: Array
    sides: tuple[Array, Array]

    def sample(self, target: Scene, index: int, density: float, rng: np.random.Generator) -> tuple:
        area = self.area.ravel()
        count = int(np.floor(area.sum() * density + rng.random()))
        cell = np.searchsorted(np.cumsum(area), rng.random(count) * area.sum(), side="right")
        cell = np.minimum(cell, area.size - 1)
        i, j = np.unravel_index(cell, self.area.shape)
        u = self.u[i] + rng.random(count) * (self.u[i + 1] - self.u[i])
        v = self.v[j] + rng.random(count) * (self.v[j + 1] - self.v[j])
        uv = np.stack([u, v], axis=1)
        kept = inside_outlines(target.faces[index].trims, uv)
        uv, cell = uv[kept], cell[kept]
        return target.points(index, uv), self.normal.reshape(-1, 3)[cell], np.full(len(uv), index), uv

    def grid(self, target: Scene, index: int, step: float) -> Array:
        u = _divided(self.u, self.sides[0], step)
        v = _divided(self.v, self.sides[1], step)
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        kept = inside_outlines(target.faces[index].trims, uv)
        return target.on_grid(index, u, v).reshape(-1, 3)[kept]


def _on_seam(face: FaceGeometry, start: Array, end: Array) -> NDArray[np.bool_]:
    """Which pieces of a trim, (k, 2) each, run along the seam of a closed direction; (k,)."""
    u0, u1, v0, v1 = face.surface.range
    seam = np.zeros(len(start), dtype=bool)
    for axis, closed, low, high in ((0, face.surface.periodic_u, u0, u1), (1, face.surface.periodic_v, v0, v1)):
        if closed:
            for side in (low, high):
                seam |= np.abs(np.stack([start, end])[:, :, axis] - side).max(axis=0) < 1e-7 * (high - low)
    return seam


def _divided(lines: Array, sides: Array, step: float) -> Array:
    """Mid-points of equal parts of every strip, as many as keep the step."""
    pieces = np.maximum(1, np.ceil(sides / step)).astype(int)
    strip = np.repeat(np.arange(len(pieces)), pieces)
    within = np.arange(len(strip)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    return lines[strip] + (within + 0.5) / pieces[strip] * np.diff(lines)[strip]


def _cells(target: Scene, index: int) -> _FaceCells:
    """Every span of the surface's knots, divided until a cell measures about a millimetre or two."""
    face = target.faces[index]
    u0, u1, v0, v1 = face.surface.range
    low = np.maximum(np.concatenate(face.trims).min(axis=0), (u0, v0))
    high = np.minimum(np.concatenate(face.trims).max(axis=0), (u1, v1))
    lines = []
    for k, knots in enumerate((face.surface.knots_u, face.surface.knots_v)):
        inner = np.unique(knots[(knots > low[k]) & (knots < high[k])])
        lines.append(np.concatenate([[low[k]], inner, [high[k]]]))
    for _ in range(2):      # the first pass measures coarse cells, the second what came of them
        u, v = lines
        points = target.on_grid(index, u, v)
        sides = (np.linalg.norm(np.diff(points, axis=0), axis=2).max(axis=1),
                 np.linalg.norm(np.diff(points, axis=1), axis=2).max(axis=0))
        lines = [_refined(line, side) for line, side in zip(lines, sides, strict=True)]
    u, v = lines
    points = target.on_grid(index, u, v)
    diagonal, other = points[1:, 1:] - points[:-1, :-1], points[:-1, 1:] - points[1:, :-1]
    normal = 0.5 * face.outward * np.cross(diagonal, other)
    area = np.linalg.norm(normal, axis=2)
    sides = (np.linalg.norm(np.diff(points, axis=0), axis=2).max(axis=1),
             np.linalg.norm(np.diff(points, axis=1), axis=2).max(axis=0))
    return _FaceCells(u, v, area, normal / np.maximum(area, 1e-300)[..., None], sides)


def _refined(lines: Array, sides: Array) -> Array:
    pieces = np.maximum(1, np.ceil(sides / _CELL)).astype(int)
    if pieces.sum() > _MOST_LINES:
        pieces = np.maximum(1, pieces * _MOST_LINES // pieces.sum())
    parts = [np.linspace(a, b, k, endpoint=False) for a, b, k in zip(lines[:-1], lines[1:], pieces, strict=True)]
    return np.concatenate([*parts, lines[-1:]])
