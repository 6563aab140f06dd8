# SPDX-License-Identifier: LGPL-2.1-or-later
"""The errors of a scan: noise, gaps, outliers and misaligned shots."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ...registration.arrays import Array

_WAVES = 400
_CHUNK = 50_000


def correlated(where: Array, length: float, rng: np.random.Generator) -> Array:
    """A random field of unit variance at the places (n, k) in mm; (n,).

    White noise under a Gaussian filter of width ``length``: its covariance is exp(−r²/(4 length²)). The field is a sum
    of random waves (Rahimi and Recht, Random Features for Large-Scale Kernel Machines), so that it needs no grid.
    """
    waves = rng.normal(0.0, 1.0 / (np.sqrt(2.0) * length), (_WAVES, where.shape[1]))
    phases = rng.uniform(0.0, 2 * np.pi, _WAVES)
    field = np.empty(len(where))
    for start in range(0, len(where), _CHUNK):
        part = slice(start, start + _CHUNK)
        field[part] = np.cos(where[part] @ waves.T + phases).sum(axis=1)
    return field * np.sqrt(2.0 / _WAVES)


def noise(where: Array, sigma: float, length: float, share: float, rng: np.random.Generator) -> Array:
    """Noise (n,) of standard deviation ``sigma`` at the places (n, k); ``share`` of its variance is correlated."""
    white = rng.normal(0.0, 1.0, len(where))
    if length <= 0 or share <= 0:
        return sigma * white
    return sigma * (np.sqrt(1 - share) * white + np.sqrt(share) * correlated(where, length, rng))


def in_holes(points: Array, count: int, radii: tuple[float, float], rng: np.random.Generator) -> NDArray[np.bool_]:
    """Which of the points (n, 3) lie in one of ``count`` balls around random points among them; (n,)."""
    lost = np.zeros(len(points), dtype=bool)
    if not count or not len(points):
        return lost
    centres = points[rng.integers(0, len(points), count)]
    for ball in cKDTree(points).query_ball_point(centres, rng.uniform(*radii, count)):
        lost[ball] = True
    return lost


def outliers(points: Array, share: float, margin: float, rng: np.random.Generator) -> Array:
    """Gross outliers, ``share`` times as many as points, uniform in their box grown by ``margin`` mm; (m, 3)."""
    count = int(round(share * len(points)))
    if not count:
        return np.empty((0, 3))
    return rng.uniform(points.min(axis=0) - margin, points.max(axis=0) + margin, (count, 3))


def pose_error(middle: Array, shift: float, angle: float, rng: np.random.Generator) -> Array:
    """A small random rigid motion about ``middle``, as a 4×4 matrix."""
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(rng.normal(0.0, 1.0, 3) * angle).as_matrix()
    T[:3, 3] = middle - T[:3, :3] @ middle + rng.normal(0.0, 1.0, 3) * shift
    return T
