# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth vector field in space through given displacements: compactly supported radial basis functions.

Owns the mathematics of the interpolation alone: points and vectors in mm, nothing of shapes. scipy's
``RBFInterpolator`` has no kernel of compact support; without one a local edit would move the far end of the part.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.spatial.distance import cdist

from ...registration.arrays import Array

_FIRST_CENTRES = 40
"""Centres that are chosen at first (unit: time)."""
_RIDGE = 1e-13
"""Added to the kernel's diagonal, which is 1 (theory: far above rounding, far below what shows)."""
_TARGET_MISFIT = 0.5
"""Root mean square of the misfit that is looked for, over the tolerances (theory: hardly any then exceeds its own)."""
_LOG_RIDGES = -6.0, 6.0
"""Decimal logarithms between which a smoothing weight is looked for, over the square of the tolerances (theory: from
interpolation to a mean)."""
_BISECTIONS = 6
"""Bisections between them (theory: to a fifth of a decade)."""
_BLOCK_VALUES = 60_000
"""Kernel values that are computed together (unit: memory of a processor's cache)."""


def wendland(r: Array) -> Array:
    """Wendland's C4 function of r ≥ 0, in place: (1 − r)⁶ (35 r² + 18 r + 3) / 3, and 0 from r = 1 on.

    Wendland, Scattered Data Approximation, table 9.1 (φ₃,₂).
    """
    np.minimum(r, 1.0, out=r)
    polynomial = (35.0 / 3.0) * r
    polynomial += 6.0
    polynomial *= r
    polynomial += 1.0
    np.subtract(1.0, r, out=r)
    r *= r
    polynomial *= r
    polynomial *= r
    polynomial *= r
    return polynomial


@dataclass(frozen=True)
class RadialField:
    """Φ(x) = Σ cₖ φ(|x − xₖ| / support).

    Attributes
    ----------
    centres : (n, 3) in mm
    coefficients : (n, 3) in mm
    support : distance in mm from which on a centre has no influence
    """

    centres: Array
    coefficients: Array
    support: float

    def __call__(self, points: Array) -> Array:
        """Values at points: (m, 3) to (m, 3), exactly 0 out of reach of all centres."""
        result = np.zeros((len(points), 3))
        if len(self.centres) == 0:
            return result
        low, high = self.centres.min(axis=0) - self.support, self.centres.max(axis=0) + self.support
        near = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
        step = max(1, _BLOCK_VALUES // len(self.centres))
        for block in (near[start:start + step] for start in range(0, len(near), step)):
            result[block] = wendland(cdist(points[block], self.centres) / self.support) @ self.coefficients
        return result


def interpolate(points: Array, values: Array, tolerances: Array, support: float, most: int,
                smooth: bool = False) -> RadialField:
    """Radial field through as few of the points as reach the tolerances at all of them.

    Starts from a few points far apart and doubles them where the field misses, farthest points first, so that a smooth
    displacement costs few centres.

    Parameters
    ----------
    points, values : (n, 3) in mm
    tolerances : (n,) largest distance of the field from each value in mm
    support : support of the basis functions in mm
    most : largest number of centres; the tolerances are given up for it
    smooth : values are noisy and the tolerances say how much: do not go through them, but past them by half that much
    """
    kernel = np.empty((min(most, len(points)), len(points)))
    spread = _Spread(points)
    chosen = spread.pick(np.ones(len(points), dtype=bool), min(_FIRST_CENTRES, most))
    kernel[:len(chosen)] = wendland(cdist(points[chosen], points) / support)
    while True:
        known = kernel[:len(chosen)]
        matrix = known[:, chosen]
        matrix[np.diag_indices(len(chosen))] += _RIDGE
        coefficients = cho_solve(cho_factor(matrix, lower=True), values[chosen])
        missed = np.linalg.norm(known.T @ coefficients - values, axis=1) > tolerances
        more = spread.pick(missed, min(len(chosen), most - len(chosen)))
        if len(more) == 0:
            break
        kernel[len(chosen):len(chosen) + len(more)] = wendland(cdist(points[more], points) / support)
        chosen = np.concatenate([chosen, more])
    if smooth:
        coefficients = _smoothest(kernel[:len(chosen)], chosen, values, tolerances)
    return RadialField(points[chosen], coefficients, support)


def _smoothest(kernel: Array, chosen: NDArray[np.intp], values: Array, tolerances: Array) -> Array:
    """Coefficients of the smoothing field whose misfit, over the tolerances, has a mean square of about
    `_TARGET_MISFIT`².

    Ridge λ · tolerance² on the diagonal, λ by bisection of its logarithm (Morozov's discrepancy principle).
    """
    low, high = _LOG_RIDGES
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        matrix = kernel[:, chosen] + np.diag(10.0**middle * tolerances[chosen] ** 2 + _RIDGE)
        coefficients = cho_solve(cho_factor(matrix, lower=True), values[chosen])
        misfit = np.linalg.norm(kernel.T @ coefficients - values, axis=1) / tolerances
        low, high = (low, middle) if np.mean(misfit**2) > _TARGET_MISFIT**2 else (middle, high)
    return coefficients


class _Spread:
    """Picks points one after the other, each as far as possible from all picked before; coincident ones once."""

    def __init__(self, points: Array) -> None:
        self._points = points - points.mean(axis=0)
        self._squares = (self._points**2).sum(axis=1)
        self._distance = np.full(len(points), np.inf)
        self._least = 1e-8 * max(float(self._squares.max()), 1e-12)

    def pick(self, eligible: NDArray[np.bool_], count: int) -> NDArray[np.intp]:
        """At most ``count`` of the eligible points."""
        distance = np.where(eligible, self._distance, 0.0)
        picked: list[int] = []
        for _ in range(count):
            k = int(distance.argmax())
            if distance[k] <= self._least:
                break
            picked.append(k)
            squared = self._squares + (self._squares[k] - 2.0 * (self._points @ self._points[k]))
            np.minimum(self._distance, squared, out=self._distance)
            np.minimum(distance, squared, out=distance)
        return np.array(picked, dtype=np.intp)
