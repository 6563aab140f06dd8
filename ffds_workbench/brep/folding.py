# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a deformed face has folded over: its normal against the nominal's, at sample points inside the trims."""
from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..errors import RefusedError
from ..registration.arrays import Array
from ..registration.splines import DEGREE, SplineSurface
from .face_displacement import FaceDisplacement
from .surface_fit import GridFunction
from .workpiece import Workpiece

_LEAST_SAMPLES, _LARGEST_SAMPLES = 17, 49
"""Places per direction of a face at which its normal is looked at, at least and at the most (unit: time)."""
_VANISHING_NORMAL = 1e-3
"""A normal S_u × S_v shrunk by this factor counts as vanished (theory: far above rounding)."""


def folded(nominal: GridFunction, deformed: SplineSurface, trims: Sequence[Array]) -> bool:
    """Whether S_u × S_v of the deformed face turns by more than 90° or vanishes where the nominal's does not.

    Both normals are those of the cells of one grid of sample points, finer than the lattice where that is affordable.
    """
    u0, u1, v0, v1 = deformed.range
    u, v = _samples(u0, u1, deformed.knots_u), _samples(v0, v1, deformed.knots_v)
    return _turned(u, v, nominal(u, v), deformed.on_grid(u, v), trims)


def refuse_folds(workpiece: Workpiece, displacements: Mapping[int, FaceDisplacement]) -> None:
    """Refuse displacements that fold a face over, before any surface is made of them (RefusedError)."""
    for index, displacement in sorted(displacements.items()):
        face = workpiece.faces[index]
        ends = (face.box.u0, face.box.u1), (face.box.v0, face.box.v1)
        u, v = (np.linspace(*end, _LARGEST_SAMPLES) for end in ends)
        points = face.on_grid(u, v)
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        moved = points + displacement.evaluate(uv, points.reshape(-1, 3)).reshape(points.shape)
        if _turned(u, v, points, moved, face.trims):
            raise folds_over(face.name)


def folds_over(name: str) -> RefusedError:
    """The sentence about a face that folds over."""
    return RefusedError(f"{name} would fold over: the displacement is too large for its size.")


def _turned(u: Array, v: Array, nominal: Array, deformed: Array, trims: Sequence[Array]) -> bool:
    """Whether a cell inside the trims turned or vanished: points (m, n, 3) over the grid u (m,), v (n,)."""
    inside = _inside(0.5 * (u[1:] + u[:-1]), 0.5 * (v[1:] + v[:-1]), trims)
    before, after = _cell_normals(nominal)[inside], _cell_normals(deformed)[inside]
    area = np.linalg.norm(before, axis=1)
    regular = area > 1e-6 * area.max(initial=0.0)
    agreement = np.einsum("ij,ij->i", before, after)[regular]
    shrunk = np.linalg.norm(after, axis=1)[regular] < _VANISHING_NORMAL * area[regular]
    return bool(np.any(agreement <= 0.0) or np.any(shrunk))


def _samples(start: float, end: float, knots: Array) -> Array:
    spans = len(np.unique(knots[DEGREE:-DEGREE])) - 1
    return np.linspace(start, end, int(np.clip(2 * spans + 1, _LEAST_SAMPLES, _LARGEST_SAMPLES)))


def _cell_normals(points: Array) -> Array:
    """Vector area of the cells of a grid of points, half the cross product of the diagonals: (m-1, n-1, 3)."""
    return 0.5 * np.cross(points[1:, 1:] - points[:-1, :-1], points[:-1, 1:] - points[1:, :-1])


def _inside(u: Array, v: Array, trims: Sequence[Array]) -> Array:
    """Even-odd rule on the grid u × v: (len(u), len(v)) bool."""
    inside = np.zeros((len(u), len(v)), dtype=bool)
    for polyline in trims:
        a, b = polyline[:-1], polyline[1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            at = (u[:, None] - a[:, 0]) / (b[:, 0] - a[:, 0])
            height = a[:, 1] + at * (b[:, 1] - a[:, 1])
        spans = (a[:, 0] > u[:, None]) != (b[:, 0] > u[:, None])
        for row in range(len(u)):
            crossed = height[row, spans[row]]
            inside[row] ^= np.count_nonzero(crossed[:, None] > v, axis=0) % 2 == 1
    return inside
