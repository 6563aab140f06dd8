# SPDX-License-Identifier: LGPL-2.1-or-later
"""The covariance of values at scattered places as a function of distance, and the Gaussian that fits it."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..errors import RefusedError
from ..registration.arrays import Array

_PAIRS = 300_000
_BINS_PER_OCTAVE = 3
_LONGEST_LAG = 0.25
"""Of the scan's size."""
_LONGEST_LENGTH = 0.6
"""Of the longest distance: what is shared farther cannot be told from the shape of the datum."""
_FEWEST_PAIRS = 200
_SIGNIFICANT = 5.0
_LENGTHS = 60


@dataclass(frozen=True)
class Covariogram:
    """Covariances by distance.

    Attributes
    ----------
    distance : (n,) mean distance of the pairs in mm
    covariance : (n,) in mm²
    sigma : (n,) standard deviation of the covariance if there were none, in mm²
    """

    distance: Array
    covariance: Array
    sigma: Array


def covariogram(place: Array, normal: Array, value: Array, weight: Array) -> Covariogram:
    """Covariance of values (n,) of mean zero, with weights (n,), at different places (n, 3) in mm.

    Octave by octave of the distance, from as many places as make enough pairs. The values are heights along unit
    normals (n, 3), whose sign does not matter.
    """
    tree = cKDTree(place)
    rng = np.random.default_rng(0)
    far = _LONGEST_LAG * float(np.sort(np.ptp(place, axis=0))[1])
    tables: list[Array] = []
    around = np.inf
    while around > 4:
        probes = place[rng.integers(0, len(place), 100)]
        around = max(1.0, float(np.mean(tree.query_ball_point(probes, far, return_length=True))))
        anchors = rng.permutation(len(place))[: max(100, int(_PAIRS / around))]
        near = tree.query_ball_point(place[anchors], far, workers=-1)
        i = np.repeat(anchors, [len(item) for item in near])
        j = np.concatenate(near).astype(np.intp)
        distance = np.linalg.norm(place[i] - place[j], axis=1)
        bins = np.ceil(_BINS_PER_OCTAVE * np.log2(np.maximum(distance, 1e-9) / far)).astype(int) + _BINS_PER_OCTAVE - 1
        kept = (bins >= 0) & (i != j)
        i, j, distance, bins = i[kept], j[kept], distance[kept], bins[kept]
        cosine = np.einsum("nx,nx->n", normal[i], normal[j])
        both = weight[i] * weight[j] * np.abs(cosine)
        product = both * np.sign(cosine) * value[i] * value[j]
        tables.append(np.stack([np.bincount(bins, column, _BINS_PER_OCTAVE) for column in
                                (np.ones(len(i)), distance, both, product, both**2)], axis=1))
        far /= 2
    count, distance, total, product, square = np.concatenate(tables[::-1]).T
    good = (count > _FEWEST_PAIRS) & (total > 0)
    variance = float(np.average(value**2, weights=weight**2))
    return Covariogram(distance[good] / count[good], product[good] / total[good],
                       variance * np.sqrt(2 * square[good]) / total[good])


def fit(scans: Sequence[Covariogram], size: float, share: float) -> tuple[float, float] | None:
    """Variance in mm² and length in mm of the correlated noise σ_c² exp(−r²/2l²); None where there is none.

    Parameters
    ----------
    size : of the cells, in mm, that the values are means over
    share : of the covariance that is left in the values

    Raises
    ------
    RefusedError : the values are shared over a large part of the scan, as those of a curved datum are
    """
    distance, covariance, sigma = (np.concatenate([getattr(item, key) for item in scans])
                                   for key in ("distance", "covariance", "sigma"))
    if not len(distance):
        return None
    lengths = np.geomspace(0.4 * size, _LONGEST_LENGTH * distance.max(), _LENGTHS)
    blur = size**2 / 6
    shapes = np.exp(-(distance**2) / (2 * (lengths[:, None] ** 2 + blur)))
    norm = ((shapes / sigma) ** 2).sum(axis=1)
    height = (shapes * covariance / sigma**2).sum(axis=1) / norm
    best = int(np.argmax(np.where(height > 0, height**2 * norm, 0.0)))
    if height[best] * np.sqrt(norm[best]) < _SIGNIFICANT:
        return None
    if best == len(lengths) - 1:
        raise RefusedError(f"What neighbouring points share reaches farther than {lengths[-1]:.3g} mm, too far for a "
                           "scan of this size: the datum is not flat, or too small.")
    length = float(lengths[best])
    return float(height[best]) / share * (length**2 + blur) / length**2, length
