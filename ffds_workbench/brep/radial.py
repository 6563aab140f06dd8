# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth vector field in space through given displacements: compactly supported radial basis functions.

Owns the mathematics of the interpolation alone: points and vectors in mm, nothing of shapes. scipy's ``RBFInterpolator``
has no kernel of compact support; without one a local edit would move the far end of the part.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.spatial.distance import cdist

from ..registration.splines import Array

_FIRST_CENTRES = 40
_RIDGE = 1e-10
_BLOCK = 60_000
"""Kernel values at a time: small enough to stay in the processor's cache."""


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
        step = max(1, _BLOCK // len(self.centres))
        for block in (near[start:start + step] for start in range(0, len(near), step)):
            result[block] = wendland(cdist(points[block], self.centres) / self.support) @ self.coefficients
        return result


def interpolate(points: Array, values: Array, tolerances: Array, support: float, most: int) -> RadialField:
    """Radial field through as few of the points as reach the tolerances at all of them.

    Starts from a few points far apart and doubles them where the field misses, farthest points first, so that a smooth
    displacement costs few centres.

    Parameters
    ----------
    points, values : (n, 3) in mm
    tolerances : (n,) largest distance of the field from each value in mm
    support : support of the basis functions in mm
    most : largest number of centres; the tolerances are given up for it
    """
    chosen = _spread(points, np.ones(len(points), dtype=bool), np.empty(0, dtype=np.intp), min(_FIRST_CENTRES, most))
    kernel = wendland(cdist(points, points[chosen]) / support)
    while True:
        matrix = kernel[chosen]
        matrix[np.diag_indices(len(chosen))] += _RIDGE
        coefficients = cho_solve(cho_factor(matrix, lower=True), values[chosen])
        missed = np.linalg.norm(kernel @ coefficients - values, axis=1) > tolerances
        more = _spread(points, missed, chosen, min(len(chosen), most - len(chosen)))
        if len(more) == 0:
            return RadialField(points[chosen], coefficients, support)
        chosen = np.concatenate([chosen, more])
        kernel = np.concatenate([kernel, wendland(cdist(points, points[more]) / support)], axis=1)


def _spread(points: Array, eligible: NDArray[np.bool_], chosen: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """At most ``count`` eligible points, each as far as possible from all chosen before it; coincident ones once."""
    scale = np.ptp(points, axis=0).max()
    if len(chosen):
        distance = cdist(points, points[chosen], "sqeuclidean").min(axis=1)
    else:
        distance = np.full(len(points), (10.0 * scale) ** 2 + 1.0)
    distance[~eligible] = 0.0
    picked: list[int] = []
    for _ in range(count):
        k = int(distance.argmax())
        if distance[k] <= (1e-4 * scale) ** 2:
            break
        picked.append(k)
        np.minimum(distance, ((points - points[k]) ** 2).sum(axis=1), out=distance)
    return np.array(picked, dtype=np.intp)
