# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth factor in space that is 0 along given edges and 1 away from them.

Holds edges still (the factor times a displacement) and blends along the rim of a face (one minus the factor).
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from ...registration.arrays import Array

SPACING = 0.1
"""Largest distance of the samples along an edge, as a fraction of their reach (theory: see `_ZERO_BELOW`)."""
_SHARE_POWER = 8
"""Power of the distances in the smooth distance: the larger, the nearer to the least one (theory: see
`_ZERO_BELOW`)."""
_ZERO_BELOW, _ONE_ABOVE = 0.14, 1.05
"""The factor is exactly 0 below, exactly 1 above these smooth distances. Between two samples at ``SPACING`` it is 0.06
at most, without a ripple that counts from 0.14 on; at the reach from two straight edges it is 1.1, from six 0.96
(theory)."""
_HORIZON = 1.6
"""A sample's share fades to nothing at this multiple of its reach (theory: beyond where the factor is 1)."""
_BLOCK_VALUES = 60_000
"""Distances that are computed together (unit: memory of a processor's cache)."""
_DENSE_SAMPLES = 400
"""With at most this many samples, computing all distances is faster than searching for the near ones (unit: time)."""


_STEP_KNOT = 0.5 - np.sqrt(0.125)
"""Inner Chebyshev knot of the perfect spline of degree 4 on [0, 1] (theory)."""


def smooth_step(t: Array) -> Array:
    """From 0 at t ≤ 0 to 1 at t ≥ 1, with three continuous derivatives and the smallest possible fourth.

    The perfect spline of degree 4, its fourth derivative ±384 between Chebyshev knots: of all steps the one that a
    cubic lattice follows with the fewest knots, its interpolation error being (knot spacing / width)⁴.
    """
    t = np.clip(t, 0.0, 1.0)
    lower = np.minimum(t, 1.0 - t)
    value = 16.0 * (lower**4 - 2.0 * np.maximum(lower - _STEP_KNOT, 0.0) ** 4)
    return np.where(t > 0.5, 1.0 - value, value)


def _shares(squared: Array, reach: Array) -> Array:
    """(reach / distance)^8 (1 − (distance / horizon)²)³, 0 beyond the horizon, from squared distances."""
    ratio = squared / (reach * reach)
    np.maximum(ratio, 1e-30, out=ratio)
    fade = np.maximum(1.0 - ratio / _HORIZON**2, 0.0)
    ratio *= ratio
    ratio *= ratio
    return fade * fade * fade / ratio


@dataclass(frozen=True)
class Cutoff:
    """The factor, from samples of the edges.

    Each sample k gives (reach_k / distance)^8, weighted with the length it stands for over its reach and faded out
    towards its horizon. The sum to the power −1/8 is a distance in units of the reach, smooth everywhere.

    Attributes
    ----------
    points : (n, 3) samples of the edges in mm, closer together than ``SPACING`` × reach
    lengths : (n,) length of edge in mm that each sample stands for
    reach : (n,) distance in mm at which the factor has become 1
    """

    points: Array
    lengths: Array
    reach: Array

    @cached_property
    def _scales(self) -> list[Cutoff]:
        """Samples of similar reach together."""
        octave = np.floor(np.log2(self.reach))
        return [Cutoff(self.points[lot], self.lengths[lot], self.reach[lot])
                for lot in (octave == value for value in np.unique(octave))]

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.points)

    def distance(self, points: Array) -> Array:
        """Smooth distance from the edges in units of the reach: (m, 3) to (m,); infinite beyond the horizon."""
        total = np.zeros(len(points))
        for scale in self._scales:
            horizon = _HORIZON * scale.reach.max()
            low, high = scale.points.min(axis=0) - horizon, scale.points.max(axis=0) + horizon
            near = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
            few = len(scale.points) <= _DENSE_SAMPLES
            total[near] += scale._dense_sum(points[near]) if few else scale._sum(points[near])
        with np.errstate(divide="ignore"):
            return total ** (-1.0 / _SHARE_POWER)

    def _dense_sum(self, points: Array) -> Array:
        step = max(1, _BLOCK_VALUES // len(self.points))
        weights = self.lengths / self.reach
        sums = [_shares(cdist(points[start:start + step], self.points, "sqeuclidean"), self.reach) @ weights
                for start in range(0, len(points), step)]
        return np.concatenate(sums) if sums else np.zeros(0)

    def _sum(self, points: Array) -> Array:
        if len(points) == 0:
            return np.zeros(0)
        pairs = cKDTree(points).sparse_distance_matrix(self._tree, _HORIZON * self.reach.max(), output_type="ndarray")
        reach = self.reach[pairs["j"]]
        shares = _shares(pairs["v"] ** 2, reach) * (self.lengths / self.reach)[pairs["j"]]
        return np.asarray(np.bincount(pairs["i"], shares, minlength=len(points)), dtype=float)

    def __call__(self, points: Array) -> Array:
        """The factor at points: (m, 3) to (m,)."""
        if len(self.points) == 0:
            return np.ones(len(points))
        return smooth_step((self.distance(points) - _ZERO_BELOW) / (_ONE_ABOVE - _ZERO_BELOW))
