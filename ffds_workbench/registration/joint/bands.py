# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the result may be off: 95 % bands from the inverse of the last normal matrix.

In chi-square units the normal matrix is the inverse of the posterior covariance of the control points: data, couplings
and the priors on bending, stretching and pose. What the model cannot follow is added where it was seen to fail.
"""
from __future__ import annotations

import numpy as np
from scipy.stats import chi2

from ..splines import Array
from .lattice import Index
from .problem import Problem
from .samples import Samples

_TWO_SIDED = 1.96
_UNSEEN_CURVATURE = 2e-4
"""Half of a change of curvature in 1/mm that a gap may hide beyond what the bending prior expects."""
_LONGEST_GAP = 30.0
_BORDER_MISFIT, _BORDER_ZONE = 0.02, 4.0
"""Half width in mm that the lattices may be off by beside a border, where no data lie, and how far in it fades."""
_EDGE_MISFIT = 0.05
"""The same for the place of an edge, which data along the normals do not tell."""


def span_covariance(problem: Problem, inverse: Array, spans: Index) -> Array:
    """Covariance of the control points of spans from the blocks of the inverse: (n, 16, 16, 3, 3)."""
    position = problem.pattern.span_position.reshape(-1, 16, 16)[spans]
    return inverse[position]


def normal_bands(problem: Problem, inverse: Array, table: Array, normal: Array, gap: Array,
                 border: Array) -> Array:
    """Bands along the normals (spans, k, 3) at places with basis functions ``table`` (k, 16): (spans, k) in mm.

    ``gap`` (spans, k) is the distance from what was observed, ``border`` that from the border of the face, in mm.
    """
    bands = np.zeros(normal.shape[:2])
    for start in range(0, len(normal), 256):
        spans = np.arange(start, min(start + 256, len(normal)))
        covariance = span_covariance(problem, inverse, spans)
        at = np.einsum("ki,kj,sijxy->skxy", table, table, covariance, optimize=True)
        variance = np.einsum("skx,skxy,sky->sk", normal[spans], at, normal[spans])
        bands[spans] = _TWO_SIDED * np.sqrt(np.maximum(variance, 0))
    misfit = _BORDER_MISFIT * np.clip(1 - border / _BORDER_ZONE, 0, 1)
    return np.sqrt(bands**2 + misfit**2 + unseen(gap) ** 2)


def edge_bands(problem: Problem, inverse: Array, samples: Samples, direction: Array, gap: Array) -> Array:
    """Bands across edges with unit directions (n, 3): (n,) in mm.

    The distance of two curves is two-dimensional; its 95 % quantile follows from the two variances across the edge by
    Satterthwaite's approximation.
    """
    bands = np.zeros(len(samples))
    for start in range(0, len(samples), 512):
        part = samples.take(np.arange(start, min(start + 512, len(samples))))
        rows, columns = np.repeat(part.controls, 16, axis=1).ravel(), np.tile(part.controls, 16).ravel()
        position = problem.pattern.position(rows, columns)
        blocks = inverse[position].reshape(len(part), 16, 16, 3, 3)
        at = np.einsum("ni,nj,nijxy->nxy", part.weights[0], part.weights[0], blocks, optimize=True)
        along = direction[start : start + len(part)]
        project = np.eye(3) - along[:, :, None] * along[:, None, :]
        variance = np.linalg.eigvalsh(project @ at @ project)[:, 1:]
        total = np.maximum(variance.sum(axis=1), 1e-18)
        freedom = np.clip(total**2 / np.maximum((variance**2).sum(axis=1), 1e-36), 1.0, 2.0)
        bands[start : start + len(part)] = np.sqrt(total / freedom * chi2.ppf(0.95, freedom))
    return np.sqrt(bands**2 + _EDGE_MISFIT**2 + unseen(gap) ** 2)


def unseen(gap: Array) -> Array:
    """What a gap may hide: grows with its square, in mm."""
    return _UNSEEN_CURVATURE * np.minimum(gap, _LONGEST_GAP) ** 2
