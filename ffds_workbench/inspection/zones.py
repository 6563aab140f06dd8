# SPDX-License-Identifier: LGPL-2.1-or-later
"""Minimum zones: the narrowest that holds all points, over what may still move, by linear programming.

Residuals are linear in the motion, r + J x. Only few points touch a zone: it is found for the farthest ones, those
that stick out of it are added, until none does. What comes out is exact for the linear problem.
"""
from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from ..errors import RefusedError
from ..registration.arrays import Array

Mode = Literal["width", "symmetric", "contact"]
_FIRST, _ROUNDS = 24, 60
_OUTSIDE = 1e-10
"""Points that stick out of a zone by less than this, in mm, lie in it."""
_SCALE_FLOOR = 1e-12
MOVES = 1e-7
"""A motion by 1 mm that moves the points of a feature by less than this, in mm, does not move it."""


def least_zone(residual: Array, jacobian: Array, mode: Mode) -> tuple[float, Array]:
    """The narrowest zone of signed distances.

    Parameters
    ----------
    residual : (n,) in mm
    jacobian : (n, k) its change with the motion
    mode : "width" for max − min, "symmetric" for twice the largest size, "contact" for max − min with max = 0

    Returns
    -------
    width in mm, and the motion (k,)
    """
    basis = _row_space(jacobian)
    rows = jacobian @ basis
    chosen = np.unique(np.concatenate([np.argsort(residual)[:_FIRST], np.argsort(residual)[-_FIRST:]]))
    low, high, x = 0.0, 0.0, np.zeros(rows.shape[1])
    for _ in range(_ROUNDS):
        low, high, x = _zone_of(residual[chosen], rows[chosen], mode)
        moved = residual + rows @ x
        outside = np.maximum(moved - high, low - moved)
        worst = np.argsort(outside)[-_FIRST:]
        worst = worst[outside[worst] > _OUTSIDE]
        if not len(worst):
            break
        chosen = np.union1d(chosen, worst)
    return high - low, basis @ x


def least_tube(residual: Array, jacobian: Array) -> tuple[float, Array]:
    """The narrowest tube (a cylinder, or one about a curve) that holds all points: its diameter, and the motion.

    Parameters
    ----------
    residual : (n, 3) distances from the axis in mm, as vectors
    jacobian : (n, 3, k) their change with the motion

    Notes
    -----
    max |e_i + J_i x| is convex: it is the largest of all u · (e_i + J_i x) over unit vectors u. Directions are added
    where the last answer is farthest (Kelley's cutting planes), until the best tube and the largest distance agree.
    """
    count, _, _ = jacobian.shape
    flat = jacobian.reshape(3 * count, -1)
    basis = _row_space(flat)
    rows = (flat @ basis).reshape(count, 3, -1)
    x, heights, slopes = np.zeros(rows.shape[2]), [], []
    radius = 0.0
    for _ in range(_ROUNDS):
        moved = residual + rows @ x
        distance = np.linalg.norm(moved, axis=1)
        if distance.max() - radius <= _OUTSIDE or rows.shape[2] == 0:
            radius = float(distance.max())
            break
        for place in np.argsort(distance)[-_FIRST:]:
            unit = moved[place] / max(distance[place], _SCALE_FLOOR)
            heights.append(unit @ residual[place])
            slopes.append(unit @ rows[place])
        bounds = np.array(heights), np.stack(slopes)
        x, radius = _largest(*bounds)
    else:
        radius = float(np.linalg.norm(residual + rows @ x, axis=1).max())
    return 2.0 * radius, basis @ x


def free_part(residual: Array, jacobian: Array, even: NDArray[np.bool_]) -> Array:
    """Residuals (…, n) less what a motion explains by least squares of those that are ``even`` (n,); ``jacobian`` is
    (n, k)."""
    if not jacobian.shape[1]:
        return residual
    left, values, right = np.linalg.svd(jacobian[even], full_matrices=False)
    kept = values > MOVES * np.sqrt(len(left))
    motions = ((residual[..., even] @ left[:, kept]) / values[kept]) @ right[kept]
    return np.asarray(residual - motions @ jacobian.T)


def _row_space(jacobian: Array) -> Array:
    """Orthonormal directions (k, m) of the motions that change anything."""
    if not jacobian.shape[1]:
        return np.zeros((0, 0))
    _, values, rows = np.linalg.svd(jacobian, full_matrices=False)
    return np.asarray(rows[values > MOVES * np.sqrt(len(jacobian))].T)


def _zone_of(residual: Array, rows: Array, mode: Mode) -> tuple[float, float, Array]:
    """Lowest and highest of the zone of few points, and the motion."""
    count, k = rows.shape
    ones, zeros = np.ones((count, 1)), np.zeros((count, 1))
    upper = np.hstack([rows, zeros, -ones])    # r + J x <= high
    lower = np.hstack([-rows, ones, zeros])    # low <= r + J x
    bounds: list[tuple[float | None, float | None]] = [(None, None)] * (k + 2)
    cost = np.concatenate([np.zeros(k), [-1.0, 1.0]])
    equal = None
    if mode == "symmetric":
        equal = np.concatenate([np.zeros(k), [1.0, 1.0]])[None, :]
    elif mode == "contact":
        bounds[-1] = (0.0, 0.0)
    scale = max(float(np.abs(residual).max()), _SCALE_FLOOR)
    found = linprog(cost, np.vstack([upper, lower]), np.concatenate([-residual, residual]) / scale, equal,
                    None if equal is None else [0.0], bounds, method="highs")
    if found.status != 0:
        raise RefusedError("No zone holds the points of a feature: its datums leave it no place to be.")
    return float(found.x[-2]) * scale, float(found.x[-1]) * scale, found.x[:k] * scale


def _largest(heights: Array, slopes: Array) -> tuple[Array, float]:
    """The x that makes the largest of heights + slopes x least, and that."""
    k, scale = slopes.shape[1], max(float(np.abs(heights).max()), _SCALE_FLOOR)
    rows = np.hstack([slopes, -np.ones((len(heights), 1))])
    cost = np.concatenate([np.zeros(k), [1.0]])
    bounds: list[tuple[float | None, float | None]] = [(-1e3, 1e3)] * k + [(0.0, None)]  # in units of the residuals
    found = linprog(cost, rows, -heights / scale, bounds=bounds, method="highs")
    if found.status != 0:
        raise RefusedError("No tube holds the points of a feature: its datums leave it no place to be.")
    return found.x[:k] * scale, float(found.x[-1]) * scale
