# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts unlike the others, and where they differ most."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from ...registration.arrays import Array
from ...registration.robust_weights import MAD_TO_SIGMA

_ERROR = 0.01
"""Share of sound series in which a part is named."""
_LEAST_PARTS = 8
_STEPS = 20
_DRAWS, _MOST_DRAWN = 400, 200
"""Series that are drawn for the limit, and parts of the longest: of more parts, chi square is near enough."""
_CORE = 0.975


@dataclass(frozen=True)
class Outlier:
    """A part unlike the others.

    Attributes
    ----------
    part : its index
    distance : Mahalanobis's, from the middle of the series
    limit : what one of a hundred sound series would show
    where : name of the face or edge that is farthest off, in standard deviations of the other parts
    off : how far that is, in mm, along the normal
    """

    part: int
    distance: float
    limit: float
    where: str
    off: float


def find_outliers(scores: Array, means: Array, names: NDArray[np.str_]) -> list[Outlier]:
    """Parts unlike the others, the farthest first.

    Parameters
    ----------
    scores : (parts, k) along the modes, and what they leave
    means : (parts, m) mean displacement of every face along its normal in mm
    names : (m,) of the faces

    Notes
    -----
    Centre and covariance are those of the half of the parts that lies closest together (concentration steps of
    Rousseeuw and Van Driessen, *A fast algorithm for the minimum covariance determinant estimator*, Technometrics 41,
    1999), widened so that the median distance is that of normal figures, and then those of all parts within the 97.5 %
    quantile. How large the largest distance of a sound series gets is drawn for series as long, with fixed seeds.
    """
    parts, count = scores.shape
    if parts < max(_LEAST_PARTS, 2 * count + 2) or count == 0:
        return []
    squared = _robust_distances(scores)
    limit = float(chi2.ppf(1.0 - _ERROR / parts, count)) * _widening(min(parts, _MOST_DRAWN), count)
    middle = np.median(means, axis=0)
    spread = MAD_TO_SIGMA * np.median(np.abs(means - middle), axis=0)
    spread = np.maximum(spread, 1e-3 * np.abs(means - middle).max(initial=1e-12))
    found = []
    for part in np.flatnonzero(squared > limit):
        face = int(np.argmax(np.abs(means[part] - middle) / spread))
        found.append(Outlier(int(part), float(np.sqrt(squared[part])), float(np.sqrt(limit)), str(names[face]),
                             float(means[part, face] - middle[face])))
    return sorted(found, key=lambda outlier: -outlier.distance)


@cache
def _widening(parts: int, count: int) -> float:
    """The limit of sound series of so many parts and figures, over what chi square says (Bonferroni)."""
    random = np.random.default_rng(0)
    largest = [_robust_distances(random.standard_normal((parts, count))).max() for _ in range(_DRAWS)]
    return float(np.quantile(largest, 1.0 - _ERROR) / chi2.ppf(1.0 - _ERROR / parts, count))


def _robust_distances(scores: Array) -> Array:
    """Squared Mahalanobis distances (parts,) from the bulk of the parts."""
    parts, count = scores.shape
    middle = np.median(scores, axis=0)
    spread = MAD_TO_SIGMA * np.median(np.abs(scores - middle), axis=0)
    scaled = (scores - middle) / np.where(spread > 0, spread, 1.0)
    half = (parts + count + 1) // 2
    squared, inner = (scaled**2).sum(axis=1), np.zeros(0, dtype=int)
    for _ in range(_STEPS):
        closest = np.sort(np.argsort(squared, kind="stable")[:half])
        if np.array_equal(closest, inner):
            break
        inner = closest
        squared = _distances(scaled, inner)
    squared = squared * chi2.ppf(0.5, count) / max(float(np.median(squared)), 1e-300)
    core = np.flatnonzero(squared <= chi2.ppf(_CORE, count))
    return _distances(scaled, core if len(core) > count else inner)


def _distances(scaled: Array, core: NDArray[np.intp]) -> Array:
    """Squared distances of all rows from those of the core, by the core's mean and covariance."""
    off = scaled - scaled[core].mean(axis=0)
    covariance = np.atleast_2d(np.cov(scaled[core], rowvar=False))
    covariance += 1e-12 * max(float(np.trace(covariance)), 1e-300) * np.eye(scaled.shape[1])
    return np.asarray(np.einsum("pi,pi->p", off, np.linalg.solve(covariance, off.T).T))
