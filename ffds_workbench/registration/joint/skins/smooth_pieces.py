# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth connected pieces of a scan, each with one side: they cross neither a sheet's edge nor to its far side."""
from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...arrays import Array, Index

_NEIGHBOURS, _SMOOTH_COSINE, _SMOOTH_RISE = 9, 0.9, 0.35
"""Number of neighbours; two of them lie on one smooth surface if the cosine of their normals is above the second number
and the sine of the step out of their planes is below the third (unit: 26°, and a step of 20° that no sheet's edge
keeps)."""


def smooth_pieces(points: Array, directions: Array) -> tuple[Index, Array]:
    """Number of the smooth piece of every point, and ±1 that turns its normal (n, 3) to the piece's one side.

    Every point is two nodes of a graph, one for each sign; a piece is two components of it, or a single one (and then
    0 instead of ±1) where the surface has but one side.
    """
    count = len(points)
    index = cKDTree(points).query(points, k=min(_NEIGHBOURS, count), workers=-1)[1]
    start, end = np.repeat(np.arange(count), index.shape[1] - 1), index[:, 1:].ravel()
    step = points[end] - points[start]
    step /= np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-12)
    cosine = np.einsum("nx,nx->n", directions[start], directions[end])
    rise = np.maximum(*(np.abs(np.einsum("nx,nx->n", step, directions[k])) for k in (start, end)))
    smooth = (np.abs(cosine) > _SMOOTH_COSINE) & (rise < _SMOOTH_RISE)
    start, end, crossed = start[smooth], end[smooth], (cosine[smooth] < 0) * count
    rows = np.concatenate([start, start + count])
    columns = np.concatenate([end + crossed, (end + count + crossed) % (2 * count)])
    graph = csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(2 * count, 2 * count))
    plus, minus = connected_components(graph, directed=False)[1].reshape(2, count)
    return np.unique(np.minimum(plus, minus), return_inverse=True)[1], np.sign(minus - plus).astype(float)
