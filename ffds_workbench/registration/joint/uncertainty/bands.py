# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the result may be off: 95 % bands from the covariance, the misfit, and known errors at borders."""
from __future__ import annotations

import numpy as np
from scipy.special import chdtri

from ...arrays import Array, Index
from ..problem import Problem
from ..surfaces import FacePlaces

TWO_SIDED = 1.96
"""Standard deviations within which 95 % of a normal distribution lie (theory)."""
_UNSEEN_QUANTILE, _UNSEEN_DISTANCE = 4.30, 6.0
"""The 95 % quantile where the shape rests on priors alone, and from how many spacings of points beside the observed
area. Bends gather in places, so that errors are distributed as Student's t with two degrees of freedom (theory; the
distance calibrated: by hand, on the families of ``./ffds benchmark accuracy``)."""
_NEIGHBOUR_LEAK, _LEAK_ZONE = 0.08, 3.0
"""Standard deviation, over the noise's, of the error that points of the neighbouring face cause at a border; and how
far it reaches into the face, over the margin that points keep from it (calibrated: by hand, on the families of ``./ffds
benchmark accuracy``)."""
_EDGE_MISFIT = 0.3, 0.1
"""Standard deviation of the place of an edge, beyond what the covariance of its faces explains: a share of the noise
and a share of the spacing of the points (calibrated: by hand, on the families of ``./ffds benchmark accuracy``)."""


def span_covariance(problem: Problem, covariance: Array, spans: Index) -> Array:
    """Covariance of the control points of spans from its blocks on the pattern: (n, 16, 16, 3, 3)."""
    return problem.pattern.of_spans(covariance, spans)


def normal_bands(problem: Problem, covariance: Array, errors: Array, table: Array, normal: Array, gap: Array,
                 border: Array, misfit: Array) -> Array:
    """Bands along the normals (spans, k, 3) at places with basis functions ``table`` (k, 16): (spans, k) in mm.

    ``gap`` (spans, k) is the distance from what was observed, ``border`` that from the border of the face, in mm,
    ``misfit`` (spans,) a variance in mm²; ``errors`` (n, controls, 3) are changes that shared noise may cause.
    """
    variance = np.zeros(normal.shape[:2])
    for error in errors:
        moved = np.matmul(table, error[problem.lattices.controls])
        variance += np.einsum("skx,skx->sk", moved, normal) ** 2 / len(errors)
    for start in range(0, len(normal), 256):
        spans = np.arange(start, min(start + 256, len(normal)))
        at = np.einsum("ki,kj,sijxy->skxy", table, table, span_covariance(problem, covariance, spans), optimize=True)
        variance[spans] += np.einsum("skx,skxy,sky->sk", normal[spans], at, normal[spans])
    leak = _NEIGHBOUR_LEAK * problem.lengths.noise * np.clip(1 - border / (_LEAK_ZONE * problem.margin[:, None]), 0, 1)
    return _quantile(problem, gap) * np.sqrt(np.maximum(variance, 0) + misfit[:, None] + leak**2)


def edge_bands(problem: Problem, covariance: Array, errors: Array, samples: FacePlaces, direction: Array, gap: Array,
               misfit: Array) -> Array:
    """Bands across edges with unit directions (n, 3): (n,) in mm; the others as for `normal_bands`, edge by edge.

    The distance of two curves is two-dimensional; its 95 % quantile follows from the two variances across the edge by
    Satterthwaite's approximation.
    """
    bands = np.zeros(len(samples))
    own = np.hypot(_EDGE_MISFIT[0] * problem.lengths.noise, _EDGE_MISFIT[1] * problem.lengths.spacing)
    for start in range(0, len(samples), 512):
        part = samples.take(np.arange(start, min(start + 512, len(samples))))
        blocks = span_covariance(problem, covariance, part.span)
        at = np.einsum("ni,nj,nijxy->nxy", part.weights[0], part.weights[0], blocks, optimize=True)
        for error in errors:
            moved = part.displacement(error)
            at += moved[:, :, None] * moved[:, None, :] / len(errors)
        along = direction[start : start + len(part)]
        project = np.eye(3) - along[:, :, None] * along[:, None, :]
        variance = np.linalg.eigvalsh(project @ at @ project)[:, 1:]
        variance = np.maximum(variance, 0) + (own**2 + misfit[start : start + len(part), None])
        total = variance.sum(axis=1)
        freedom = np.clip(total**2 / (variance**2).sum(axis=1), 1.0, 2.0)
        bands[start : start + len(part)] = np.sqrt(total / freedom * chdtri(freedom, 0.05))
    return _quantile(problem, gap) / TWO_SIDED * bands


def _quantile(problem: Problem, gap: Array) -> Array:
    """Half width of a 95 % band in standard deviations."""
    share = np.clip(gap / (_UNSEEN_DISTANCE * problem.lengths.spacing), 0, 1)
    return TWO_SIDED + (_UNSEEN_QUANTILE - TWO_SIDED) * share
