# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a deformed face has folded over: its normal against the nominal's, at sample points inside the trims."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..registration.arrays import Array
from ..registration.splines import DEGREE, SplineSurface
from .surface_fit import GridFunction

_LEAST_SAMPLES, _LARGEST_SAMPLES = 17, 49
_VANISHING_NORMAL = 1e-3
"""A normal S_u × S_v shrunk by this factor counts as vanished."""


def folded(nominal: GridFunction, deformed: SplineSurface, trims: Sequence[Array]) -> bool:
    """Whether S_u × S_v of the deformed face turns by more than 90° or vanishes where the nominal's does not.

    Both normals are those of the cells of one grid of sample points, finer than the lattice where that is affordable.
    """
    u0, u1, v0, v1 = deformed.range
    u, v = _samples(u0, u1, deformed.knots_u), _samples(v0, v1, deformed.knots_v)
    inside = _inside(0.5 * (u[1:] + u[:-1]), 0.5 * (v[1:] + v[:-1]), trims)
    before, after = _cell_normals(nominal(u, v))[inside], _cell_normals(deformed.on_grid(u, v))[inside]
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
