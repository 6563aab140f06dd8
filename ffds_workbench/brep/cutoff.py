# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth factor in space that is 0 along given edges and 1 away from them.

Holds edges still (the factor times a displacement) and blends along the rim of a face (one minus the factor).
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ..registration.splines import Array

SPACING = 0.2
"""Largest distance of the samples along an edge, as a fraction of their reach."""
_POWER = 8
_ZERO, _ONE = 0.15, 0.8
"""The factor is exactly 0 below, exactly 1 above this fraction of the reach. Between two samples at ``SPACING`` the
smooth distance is 0.11 of the reach; on a surface at reach 1 from six edges it is 0.8."""
_HORIZON = 2.5
"""A sample counts up to this multiple of its reach; its share in the sum is 5e-4 there and fades out smoothly."""
_PAIRS = 2_000_000


def smoothstep(t: Array) -> Array:
    """0 below 0, 1 above 1, with two continuous derivatives: t³ (6t² − 15t + 10)."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0)


@dataclass(frozen=True)
class Cutoff:
    """The factor, from samples of the edges.

    Each sample k gives (reach_k / distance)^8, weighted with the length it stands for over its reach. The sum to the
    power −1/8 is a distance in units of the reach, smooth everywhere: 1 at the reach from a straight edge.

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
    def _scales(self) -> list[tuple[cKDTree, Array, Array, float]]:
        """Samples of similar reach together: tree, weights, reach and horizon of each lot."""
        lots = []
        octave = np.floor(np.log2(self.reach)) if len(self.reach) else np.empty(0)
        for value in np.unique(octave):
            lot = octave == value
            reach = self.reach[lot]
            lots.append((cKDTree(self.points[lot]), self.lengths[lot] / reach, reach, _HORIZON * float(reach.max())))
        return lots

    def distance(self, points: Array) -> Array:
        """Smooth distance from the edges in units of the reach: (m, 3) to (m,); infinite beyond the horizon."""
        total = np.zeros(len(points))
        for tree, weights, reach, horizon in self._scales:
            step = max(1, _PAIRS // tree.n)
            for start in range(0, len(points), step):
                block = cKDTree(points[start:start + step])
                pairs = block.sparse_distance_matrix(tree, horizon, output_type="ndarray")
                k = pairs["j"]
                with np.errstate(divide="ignore", over="ignore"):
                    ratio = (reach[k] / pairs["v"]) ** 2
                    share = weights[k] * (ratio * ratio) ** 2
                    share *= smoothstep(2.0 - 2.0 / (_HORIZON * np.sqrt(ratio)))
                total[start:start + step] += np.bincount(pairs["i"], share, minlength=block.n)
        with np.errstate(divide="ignore"):
            return total ** (-1.0 / _POWER)

    def __call__(self, points: Array) -> Array:
        """The factor at points: (m, 3) to (m,)."""
        if len(self.points) == 0:
            return np.ones(len(points))
        return smoothstep((self.distance(points) - _ZERO) / (_ONE - _ZERO))
