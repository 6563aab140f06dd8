# SPDX-License-Identifier: LGPL-2.1-or-later
"""Knots that allow a kink where a function has none: OCCT's check for Boolean operations objects to them."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..registration.arrays import Array
from ..registration.splines import DEGREE

_PROBE_STEP = 1e-5
"""Of a curve's length, between the places whose differences tell its derivatives (theory: rounding and curvature then
err alike)."""
_SAME_KNOT = 1e-6
"""Knots nearer to each other than this share of the range may be one and the same but for rounding (theory:
rounding)."""


def without_false_kinks(f: Callable[[Array], Array], breaks: Array, length: float, kink: float) -> Array:
    """Breaks of multiplicity three reduced to two where ``f`` has no kink to speak of.

    Parameters
    ----------
    f : (n,) parameters to (n, …) points
    breaks : interior knots with their repetitions
    length : of the parameter's range
    kink : relative change of the derivative from which on ``f`` counts as kinked
    """
    breaks = np.sort(breaks)
    start = np.flatnonzero(np.diff(breaks, prepend=-np.inf) > _SAME_KNOT * length)
    distinct, count = breaks[start], np.diff(start, append=len(breaks))
    several = np.flatnonzero(count >= DEGREE)
    if not len(several):
        return np.repeat(distinct, count)
    at = distinct[several, None] + _PROBE_STEP * length * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    points = f(at.ravel()).reshape(len(several), 5, -1)
    before = np.einsum("k,nkd->nd", [1.0, -4.0, 3.0], points[:, :3])
    after = np.einsum("k,nkd->nd", [-3.0, 4.0, -1.0], points[:, 2:])
    turned = np.linalg.norm(after - before, axis=1) > kink * np.maximum(np.linalg.norm(before, axis=1),
                                                                        np.linalg.norm(after, axis=1))
    count[several] = np.where(turned, DEGREE, DEGREE - 1)
    return np.repeat(distinct, count)
