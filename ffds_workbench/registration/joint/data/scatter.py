# SPDX-License-Identifier: LGPL-2.1-or-later
"""How heights scatter: the sensor's noise, and what the lattices cannot follow, as two variances.

Both come from differences between neighbours, which do not depend on whether the shape lies off the scan: the sensor's
from points and the others of their cell, the model's from neighbouring patches of cells within one span, between which
a lattice cannot bend. A shape that leaves the points is therefore pulled back as strongly as before.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from ...arrays import Array, Index
from ...robust_weights import quantile

PATCHES_PER_SPAN = 2
"""Patches per direction of a span (theory: two between neighbouring knots see what a cubic spline cannot follow)."""
_PRIOR_COUNT = 50.0
"""Differences that the whole part counts for beside those of a face (unit: some spans)."""
_LEAST_DIFFERENCES = 20
"""Fewer do not tell a variance to a third, √(2/20) (theory)."""
_LEAST_WEIGHT = 0.5
"""Of a point, that a patch has to have (unit)."""
_LARGEST_EXCESS = 20.0
"""Excess over its upper quartile from which a squared difference is cut: that of normal ones is below it once in ten
thousand (theory)."""


@dataclass(frozen=True)
class Scatter:
    """Standard deviations in mm.

    Attributes
    ----------
    sensor : (faces,) of a point along the normal
    model : (faces,) of what the points of a patch share: what lattice and matching leave
    loss : (faces,) scale of the robust loss: how far the points lie from the surface, as long as it moves
    """

    sensor: Array
    model: Array
    loss: Array

    @property
    def of_face(self) -> Array:
        """Standard deviation of the points about every face: (faces,) in mm."""
        return np.hypot(self.sensor, self.model)


def patch_sums(cells: Array) -> Array:
    """Sums over patches of the cells (spans, k): (spans, PATCHES_PER_SPAN, PATCHES_PER_SPAN)."""
    per_span = int(np.sqrt(cells.shape[1]))
    member = np.zeros((PATCHES_PER_SPAN, per_span))
    member[(np.arange(per_span) * PATCHES_PER_SPAN) // per_span, np.arange(per_span)] = 1.0
    return np.einsum("pi,sij,qj->spq", member, cells.reshape(-1, per_span, per_span), member, optimize=True)


def of_cells(patches: Array, per_span: int) -> Array:
    """The value of its patch (spans, PATCHES_PER_SPAN, PATCHES_PER_SPAN) for every cell: (spans, k)."""
    of = (np.arange(per_span) * PATCHES_PER_SPAN) // per_span
    return patches[:, of[:, None], of].reshape(len(patches), -1)


def sensor_noise(height: Array, cell: Index, mean: Array, count: Array, face: Index, known: Array,
                 least: float) -> Array:
    """Standard deviation along the normals of the points on every face, (faces,) in mm, free of outliers.

    Of each ``height`` (n,) on its ``face`` (n,) about the ``mean`` (cells,) of their cells; ``known`` (faces,) is kept
    where no points share a cell.
    """
    own = count[cell]
    several = np.flatnonzero(own > 1)
    if len(several) < _LEAST_DIFFERENCES:
        return known
    own = own[several]
    off = np.abs(height[several] - mean[cell[several]]) * np.sqrt(own / (own - 1))
    return np.maximum(spread(off, face[several], len(known), 0.5), least)


def spread(off: Array, face: Index, faces: int, share: float) -> Array:
    """Standard deviation on every face, (faces,), of normal noise of which the ``share`` of all has these sizes (n,) or
    less. A face's own variance is shrunk towards the whole part's by its count (James and Stein)."""
    normal = float(ndtri(0.5 + 0.5 * share))
    order = np.argsort(face, kind="stable")
    bounds = np.searchsorted(face[order], np.arange(faces + 1))
    whole = quantile(off, share) / normal
    result = np.full(faces, whole)
    for k in np.flatnonzero(np.diff(bounds)):
        part = off[order[bounds[k] : bounds[k + 1]]]
        own = quantile(part, share) / normal
        result[k] = np.sqrt((len(part) * own**2 + _PRIOR_COUNT * whole**2) / (len(part) + _PRIOR_COUNT))
    return result


def model_noise(height: Array, total: Array, face_of_span: Index, sensor: Array) -> Array:
    """Standard deviation of what the patches of a span do not share, beyond the sensor's noise: (faces,) in mm.

    Moment estimator: ``height`` and ``total`` (spans, k) are means and sums of weights of the cells. A face's own is
    shrunk towards the whole part's by its count (James and Stein).
    """
    faces, weight = len(sensor), patch_sums(total)
    mean = patch_sums(total * height) / np.maximum(weight, 1e-12)
    noise = sensor[face_of_span, None, None] ** 2 / np.maximum(weight, 1e-12)
    owner = np.broadcast_to(face_of_span[:, None, None], weight.shape)
    seen = weight > _LEAST_WEIGHT
    both = _first(seen) & _second(seen)
    excess = 0.5 * ((_first(mean) - _second(mean)) ** 2 - _first(noise) - _second(noise))[both]
    face = _first(owner)[both]
    usual = max(float(np.quantile(excess, 0.75)), 0.0) if len(excess) else 0.0
    excess = np.minimum(excess, _LARGEST_EXCESS * usual)
    count, own = np.bincount(face, minlength=faces), np.bincount(face, excess, faces)
    whole = max(float(excess.mean()), 0.0) if len(excess) else 0.0
    return np.sqrt(np.maximum((own + _PRIOR_COUNT * whole) / (count + _PRIOR_COUNT), 0.0))


def _first(patches: NDArray[Any]) -> NDArray[Any]:
    """The first ones of neighbouring patches (spans, 2, 2), along both directions: (2 spans, 2)."""
    return np.concatenate([patches[:, :, 0], patches[:, 0]])


def _second(patches: NDArray[Any]) -> NDArray[Any]:
    """Their neighbours: (2 spans, 2)."""
    return np.concatenate([patches[:, :, 1], patches[:, 1]])
