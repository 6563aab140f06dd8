# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closest points on a spline surface, with or without a displacement, exact to rounding.

Registration itself uses `footpoints`, which are faster and exact enough.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from .arrays import Array
from .splines import SplineSurface
from .uv_raster import dot

_CHUNK = 20000
"""Points that are projected together (unit: memory)."""
_SEED_POINTS = 96
"""Places per direction that the steps start from (unit: time)."""
_NEWTON_STEPS = 25
"""Steps at the most (theory: Newton's double their digits; damped ones take a few more)."""
_CONVERGED_STEP = 1e-9
"""Movement in mm below which the steps end (theory: far below any tolerance, above rounding)."""


@dataclass(frozen=True)
class Projection:
    """Closest points.

    Attributes
    ----------
    uv : (n, 2), inside the surface's range
    foot : (n, 3) in mm
    height : (n,) component along the unit normal S_u × S_v of the way from the foot to the point, in mm: the signed
        distance, except beyond the sides of the range
    """

    uv: Array
    foot: Array
    height: Array


def project(surface: SplineSurface, points: Array, displacement: SplineSurface | None = None) -> Projection:
    """Closest points of S, or of S + d, by damped Newton steps from the nearest of a grid of surface points.

    Parameters
    ----------
    points : (n, 3) in mm
    displacement : d over the same (u, v), or None
    """
    terms = [surface] if displacement is None else [surface, displacement]
    fields = [[t.derivative(*order) for t in terms] for order in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))]
    u0, u1, v0, v1 = surface.range
    grid = np.stack(np.meshgrid(np.linspace(u0, u1, _SEED_POINTS), np.linspace(v0, v1, _SEED_POINTS), indexing="ij"),
                    axis=-1)
    grid = grid.reshape(-1, 2)
    tree = cKDTree(_sum(fields[0], grid))
    parts = [_project(surface, fields, points[k : k + _CHUNK], grid[tree.query(points[k : k + _CHUNK])[1]])
             for k in range(0, max(len(points), 1), _CHUNK)]
    uv, foot, height = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Projection(uv, foot, height)


def _project(surface: SplineSurface, fields: list[list[SplineSurface]], points: Array, uv: Array
             ) -> tuple[Array, Array, Array]:
    foot = _sum(fields[0], uv)
    squared = dot(points - foot, points - foot)
    damping = np.full(len(points), 1e-6)
    for _ in range(_NEWTON_STEPS):
        s_u, s_v, s_uu, s_uv, s_vv = (_sum(f, uv) for f in fields[1:])
        r = points - foot
        e, f, g = dot(s_u, s_u), dot(s_u, s_v), dot(s_v, s_v)
        a, b, c = e - dot(r, s_uu), f - dot(r, s_uv), g - dot(r, s_vv)
        convex = (a > 0) & (c > 0) & (a * c - b * b > 0.01 * (e * g - f * f))
        a, b, c = np.where(convex, a, e), np.where(convex, b, f), np.where(convex, c, g)
        a, c = a + damping * e + 1e-300, c + damping * g + 1e-300
        p, q = dot(r, s_u), dot(r, s_v)
        determinant = a * c - b * b
        trial = surface.inside(uv + np.stack([c * p - b * q, a * q - b * p], axis=1) / determinant[:, None])
        moved = _sum(fields[0], trial)
        trial_squared = dot(points - moved, points - moved)
        better = trial_squared <= squared
        step = float(np.linalg.norm((moved - foot)[better], axis=1).max(initial=0.0))
        uv, foot = np.where(better[:, None], trial, uv), np.where(better[:, None], moved, foot)
        squared = np.where(better, trial_squared, squared)
        damping = np.where(better, damping * 0.1, np.maximum(damping * 10, 1e-3))
        if step < _CONVERGED_STEP:
            break
    normal = np.cross(_sum(fields[1], uv), _sum(fields[2], uv))
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    return uv, foot, dot(points - foot, normal)


def _sum(terms: list[SplineSurface], uv: Array) -> Array:
    return sum((term(uv) for term in terms[1:]), start=terms[0](uv))
