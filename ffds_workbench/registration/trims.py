# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which parameters of a face carry material: its trims filled by the even-odd rule."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .arrays import Array
from .face_geometry import FaceGeometry

_ON_BOUNDARY = 1e-7
"""Of the range, or in mm: what is nearer to a boundary lies on it (theory: far above rounding)."""


def inside_trims(face: FaceGeometry, u: Array, v: Array) -> NDArray[np.bool_]:
    """Whether the nodes of the grid u × v lie on the trimmed face; (len(u), len(v)).

    Parameters
    ----------
    u, v : increasing parameters in the face's range; a node exactly on the border of the range counts as just inside it

    Notes
    -----
    A scan line per v: a node is inside if an odd number of trim crossings lies at smaller u. Trims on a closed
    direction may leave the range, so they are also taken one period to either side.
    """
    u0, u1, v0, v1 = face.surface.range
    u, v = _inwards(u, u0, u1), _inwards(v, v0, v1)
    start, end = _segments(face.trims)
    if face.surface.periodic_v:
        shifts = np.array([[0.0, k * (v1 - v0)] for k in (-1, 0, 1)])
        start, end = _repeated(start, shifts), _repeated(end, shifts)
    first = np.searchsorted(v, np.minimum(start[:, 1], end[:, 1]))
    last = np.searchsorted(v, np.maximum(start[:, 1], end[:, 1]))
    count = last - first
    segment = np.repeat(np.arange(len(start)), count)
    line = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count - first, count)
    a, b = start[segment], end[segment]
    crossing = a[:, 0] + (v[line] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    if face.surface.periodic_u:
        crossing = np.concatenate([crossing + k * (u1 - u0) for k in (-1, 0, 1)])
        line = np.tile(line, 3)
    crossings = np.zeros((len(u) + 1, len(v)), dtype=np.intp)
    np.add.at(crossings, (np.searchsorted(u, crossing), line), 1)
    return np.asarray(np.cumsum(crossings[:-1], axis=0) % 2 == 1)


def inside_polylines(trims: Sequence[Array], uv: Array) -> NDArray[np.bool_]:
    """Whether parameters ``uv`` (n, 2) lie on the face: even-odd rule over its ``trims``, closed polylines (k, 2)."""
    inside = np.zeros(len(uv), dtype=bool)
    x, y = uv[:, :1], uv[:, 1:]
    for polyline in trims:
        (x0, y0), (x1, y1) = polyline[:-1].T, polyline[1:].T
        run = np.where(y1 == y0, 1.0, y1 - y0)
        for some in np.array_split(np.arange(len(uv)), len(uv) * len(x0) // 2_000_000 + 1):
            crossed = (y0 > y[some]) != (y1 > y[some])
            left = x[some] < x0 + (x1 - x0) * (y[some] - y0) / run
            inside[some] ^= (crossed & left).sum(axis=1) % 2 == 1
    return inside


def boundary_points(face: FaceGeometry, spacing: float) -> Array:
    """Points in space along the trims of a ``face``, no farther apart than about ``spacing`` mm; (n, 3).

    Seams of a closed direction and poles are no boundary and are left out.
    """
    start, end = _boundary(face, spacing)
    return face.surface(0.5 * (start + end)) if len(start) else np.zeros((0, 3))


def boundary_pieces(face: FaceGeometry, spacing: float) -> tuple[Array, Array]:
    """Middles of straight pieces along the trims of a ``face`` and half of each piece as a vector, (n, 3) each in mm.

    Parameters
    ----------
    spacing : longest piece in mm, about
    """
    start, end = _boundary(face, spacing)
    if not len(start):
        return np.zeros((0, 3)), np.zeros((0, 3))
    a, b = face.surface(start), face.surface(end)
    return 0.5 * (a + b), 0.5 * (b - a)


def _boundary(face: FaceGeometry, spacing: float) -> tuple[Array, Array]:
    """Start and end in (u, v) of pieces along the boundary, (n, 2) each."""
    start, end = _segments(face.trims)
    u0, u1, v0, v1 = face.surface.range
    real = np.ones(len(start), dtype=bool)
    for axis, periodic, low, high in ((0, face.surface.periodic_u, u0, u1), (1, face.surface.periodic_v, v0, v1)):
        if periodic:
            near = _ON_BOUNDARY * (high - low)
            a, b = start[:, axis], end[:, axis]
            real &= ~((np.abs(a - b) < near) & ((np.abs(a - low) < near) | (np.abs(a - high) < near)))
    start, end = start[real], end[real]
    if not len(start):
        return start, end
    middle = face.surface(0.5 * (start + end))
    a, b = face.surface(start), face.surface(end)
    length = np.linalg.norm(middle - a, axis=1) + np.linalg.norm(b - middle, axis=1)
    pieces = np.where(length > _ON_BOUNDARY, np.ceil(length / spacing), 0).astype(np.intp)
    segment = np.repeat(np.arange(len(start)), pieces)
    step = np.arange(len(segment)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    a, run = start[segment], ((end - start) / np.maximum(pieces, 1)[:, None])[segment]
    return a + step[:, None] * run, a + (step[:, None] + 1) * run


def _inwards(x: Array, low: float, high: float) -> Array:
    margin = _ON_BOUNDARY * (high - low)
    return np.clip(x, low + margin, high - margin)


def _segments(trims: tuple[Array, ...]) -> tuple[Array, Array]:
    """Start and end of every piece of the closed polylines, (k, 2) each."""
    return np.concatenate(trims), np.concatenate([np.roll(trim, -1, axis=0) for trim in trims])


def _repeated(points: Array, shifts: Array) -> Array:
    return (points[None] + shifts[:, None]).reshape(-1, 2)
