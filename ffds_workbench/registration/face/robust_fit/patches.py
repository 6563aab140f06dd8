# SPDX-License-Identifier: LGPL-2.1-or-later
"""Patches of connected layers: the face itself, and islands that are checked for belonging to it.

Where the face is hidden, a patch of another sheet just below it looks like the face. But no continuous surface joins it
to the visible face, and it lies off the continuation of that surface.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...arrays import Array
from ...uv_raster import Raster
from .layers import Layers
from .robust_settings import LAYERS, MAIN_PATCHES, PROVEN, RobustSettings

Index = NDArray[np.intp]

_LARGEST_SLOPE = 0.2
"""Slope of the residual from layer to layer up to which no step lies between them (calibrated: by hand, on the
synthetic sheets of ``./ffds benchmark accuracy``)."""
_NOISE_FACTOR = 2.0
"""Standard deviations of the noise that are added to it (theory: layers are known better than that)."""
_MAIN_PATCH_SHARE = 0.1
"""Of the heaviest patch's weight, that a main patch carries (calibrated: by hand, on the synthetic sheets of ``./ffds
benchmark accuracy``)."""
_SPARSE_LAYER = 0.25
"""Layers with less than this share of the usual number of points are joined to none: outliers between two sheets would
join these (calibrated: by hand, on the synthetic sheets of ``./ffds benchmark accuracy``)."""
_MOST_LAYERS = 4
"""Layers of a block that are joined to others (unit: two skins, a table and a neighbour)."""


@dataclass(frozen=True)
class TrustedLayers:
    """Which layers of the scan are trusted to be the face.

    Attributes
    ----------
    name : `LAYERS`, `MAIN_PATCHES` or `PROVEN`
    layers : (k,) whether a layer is trusted
    patch : (k,) number of the patch that it belongs to
    """

    name: str
    layers: NDArray[np.bool_]
    patch: Index


def trust_all(layers: Layers) -> TrustedLayers:
    """Trust in all ``layers``."""
    count = len(layers.x)
    return TrustedLayers(LAYERS, np.ones(count, dtype=bool), np.zeros(count, dtype=np.intp))


def trust_main_patches(raster: Raster, layers: Layers, residual: Array, weights: Array) -> TrustedLayers:
    """Trust in the layers of patches that carry at least a tenth of the weight of the heaviest one.

    Parameters
    ----------
    raster, layers : of the face, and the k layers of the scan over it
    residual, weights : (k,) heights over a stiff surface through most of them in mm, and weights
    """
    patch = _patches(raster, layers, residual)
    total = np.bincount(patch, weights)
    return TrustedLayers(MAIN_PATCHES, (total >= _MAIN_PATCH_SHARE * total.max())[patch], patch)


def _patches(raster: Raster, layers: Layers, residual: Array) -> Index:
    """Number of the patch of each layer, (k,): layers of neighbouring blocks are joined where no step lies between.

    Parameters
    ----------
    raster, layers : of the face, and the k layers of the scan over it
    residual : (k,) heights of the layers over a stiff surface through most of them, in mm
    """
    block = np.repeat(np.arange(len(layers.first)), np.diff(np.append(layers.first, len(layers.x))))
    rank = np.arange(len(block)) - layers.first[block]
    i, j = layers.x.astype(np.intp) // layers.block, layers.y.astype(np.intp) // layers.block
    rows, columns = (np.array(raster.shape) - 1) // layers.block + 1
    place = np.full((rows + 2, columns + 2, _MOST_LAYERS), -1, dtype=np.intp)
    kept = rank < _MOST_LAYERS
    place[i[kept] + 1, j[kept] + 1, rank[kept]] = np.flatnonzero(kept)
    if raster.periodic[0]:
        place[0], place[-1] = place[-2], place[1]
    if raster.periodic[1]:
        place[:, 0], place[:, -1] = place[:, -2], place[:, 1]
    pairs = []
    for di, dj in ((1, 0), (0, 1), (1, 1), (1, -1)):
        here = place[1 : rows + 1, 1 : columns + 1]
        there = place[1 + di : rows + 1 + di, 1 + dj : columns + 1 + dj]
        a, b = np.broadcast_arrays(here[..., :, None], there[..., None, :])
        both = (a >= 0) & (b >= 0)
        pairs.append(np.stack([a[both], b[both]]))
    a, b = np.concatenate(pairs, axis=1)
    dx = raster.nearest_turn(layers.x[a] - layers.x[b], 0) * raster.size[0]
    dy = raster.nearest_turn(layers.y[a] - layers.y[b], 1) * raster.size[1]
    step = np.hypot(dx, dy)
    residual = np.nan_to_num(residual, posinf=1e9)
    dense = layers.count >= _SPARSE_LAYER * np.median(layers.count)
    allowed = _LARGEST_SLOPE * step + _NOISE_FACTOR * layers.noise
    joined = dense[a] & dense[b] & (np.abs(residual[a] - residual[b]) <= allowed)
    graph = coo_matrix((np.ones(np.count_nonzero(joined)), (a[joined], b[joined])), shape=(len(block), len(block)))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.intp)


def trust_proven(raster: Raster, layers: Layers, trust: TrustedLayers, residual: Array,
                 settings: RobustSettings) -> TrustedLayers:
    """Trust in the layers trusted so far, and in patches that lie on the surface fitted to those.

    A patch may lie off by the last gate, and by κ₀ s² more over a gap of s mm from what is trusted.

    Parameters
    ----------
    raster, layers : of the face, and the k layers of the scan over it
    trust : in the main patches
    residual : (k,) heights of the layers over that surface in mm
    settings : the last gate, and the curvature κ₀ that is expected
    """
    trusted = trust.layers
    if trusted.all():
        return replace(trust, name=PROVEN)
    places = np.stack([layers.x * raster.size[0], layers.y * raster.size[1]], axis=1)
    gap = cKDTree(places[trusted]).query(places)[0]
    count = np.bincount(trust.patch)
    nearest = np.full(len(count), np.inf)
    np.minimum.at(nearest, trust.patch, gap)
    off = np.bincount(trust.patch, np.minimum(np.abs(residual), 1e6)) / count
    near = off <= settings.schedule[-1].gate + layers.noise + settings.curvature * nearest**2
    return TrustedLayers(PROVEN, near[trust.patch] | trusted, trust.patch)
