# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fits a cubic B-spline to a curve given as a function, with as many knots as the tolerance asks for."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...registration.arrays import Array
from ...registration.splines import DEGREE
from ..surface_fit import direction
from .curves import Spline

_LARGEST_KNOT_COUNT = 3000
"""Knots of a curve at the most (unit: time), …"""
_REFINEMENT_ROUNDS = 10
"""… and rounds in which spans are halved (theory: a thousandth of a span is left)."""


def fit_curve(f: Callable[[Array], Array], first: float, last: float, breaks: Array, tolerance: float) -> Spline:
    """Clamped cubic that interpolates ``f`` at Greville points over [first, last].

    Parameters
    ----------
    f : (n,) parameters to (n, dim) points
    breaks : interior knots to start from, repeated for multiplicity where ``f`` is not smooth
    tolerance : largest distance from ``f`` at the same parameter, checked at three points in every span
    """
    side = direction(first, last, breaks, closed=False)
    for _ in range(_REFINEMENT_ROUNDS):
        sites, checks = side.sites, side.checks
        values = f(np.concatenate([sites, checks.ravel()]))
        curve = Spline(DEGREE, side.knots, side.solve(values[: len(sites)]), rational=False, periodic=False)
        off = np.linalg.norm(values[len(sites) :] - curve(checks.ravel()), axis=1)
        errors = off.reshape(checks.shape).max(axis=1)
        finer = side.refined(errors, tolerance, _LARGEST_KNOT_COUNT)
        if errors.max() <= tolerance or finer is side:
            break
        side = finer
    return curve


def crossings(path: Callable[[Array], Array], first: float, last: float, levels: Array, samples: int = 513) -> Array:
    """Parameters in [first, last] at which the function ``path``, (n,) to (n,), passes one of the levels, (k,).

    A path that runs along a level, up to rounding, does not pass it.
    """
    t = np.linspace(first, last, samples)
    values = path(t)
    if not len(levels) or np.ptp(values) < 1e-9 * max(1.0, float(np.abs(values).max())):
        return np.zeros(0)
    above = values[:, None] > levels
    bracket, level = np.nonzero(above[:-1] != above[1:])
    low, high, rising = t[bracket], t[bracket + 1], above[bracket + 1, level]
    for _ in range(40):
        middle = 0.5 * (low + high)
        beyond = (path(middle) > levels[level]) == rising
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return np.sort(high)
