# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lattices' own errors: residual heights of the scan that have the same sign among neighbours and exceed the noise.

Where priors hold a face off the scan, or its lattice cannot follow, the covariance knows nothing of it.
"""
from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ..data import CellHeights, patch_sums
from ..problem import Problem
from ..surfaces import by_face

_POOLING_RADIUS = 0.115
"""Over the size of their solid: spans this near to each other are judged together, as one alone holds too few points to
tell (unit: a little more than a span)."""


def misfit(problem: Problem, values: CellHeights) -> Array:
    """Variance of the misfit around every span, (spans,) in mm²: of its mean, and of what varies from patch to patch.

    Both are what is left when the expectation from noise is taken off (the moment estimator of DerSimonian and Laird,
    Controlled Clinical Trials 7, 1986).

    Parameters
    ----------
    problem : what stays the same while the solve runs
    values : heights of the scan, cell by cell
    """
    height, weight = values.height.reshape(problem.distance.shape), values.weight.reshape(problem.distance.shape)
    pull, total = patch_sums(height * weight), patch_sums(weight)
    seen = total > 0
    excess = np.where(seen, pull**2 / np.where(seen, total, 1.0) - 1.0, 0.0).sum(axis=(1, 2))
    place = _span_middles(problem)
    near = cKDTree(place).query_ball_point(place, _POOLING_RADIUS * problem.body_size, workers=-1)
    row, column = np.repeat(np.arange(len(place)), [len(item) for item in near]), np.concatenate(near).astype(np.intp)
    around = [np.bincount(row, item[column], len(place))
              for item in (total.sum(axis=(1, 2)), pull.sum(axis=(1, 2)), excess)]
    information = np.maximum(around[0], 1e-12)
    mean = np.maximum((around[1] / information) ** 2 - 1.0 / information, 0.0)
    varying = np.maximum(around[2] / information, 0.0)
    return np.where(around[0] > 0, mean + varying, 0.0)


def nearest_spans(problem: Problem, face: Index, position: Array) -> Index:
    """The span of faces (n,) whose middle is nearest to nominal places (n, 3): (n,)."""
    return cKDTree(_span_middles(problem)).query(by_face(position, face), workers=-1)[1]


def _span_middles(problem: Problem) -> Array:
    """Middles of the spans `by_face`: (spans, 4)."""
    return by_face(problem.cells.nominal.position.mean(axis=1), problem.lattices.face_of_span)
