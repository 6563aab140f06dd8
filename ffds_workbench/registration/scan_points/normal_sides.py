# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which side of its surface each point of a scan shows, up to one sign for each connected piece of it."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.spatial import cKDTree

from ..arrays import Array
from .parallel import workers

_LEAST_AGREEMENT = 0.6
"""Cosine below which two neighbours say nothing about each other's side (unit: 53°, what noise does to normals)."""
_FAR_NEIGHBOUR = 4.0
"""Neighbours farther than the usual ones by this factor are of another surface (unit)."""


def orient_normals(points: Array, normals: Array, neighbours: int = 9) -> tuple[Array, NDArray[np.intp]]:
    """Flip normals so that neighbours agree: clusters of points merge, each with the one it shares most votes with.

    A single link may be wrong, above all around the rim of a thin sheet, and a spanning tree of such links then turns
    half of a scan inside out. Here all links between two clusters are summed up before they merge, so that those beside
    it outvote a wrong one; the clusters grow as in O. Borůvka's spanning tree (1926).

    Parameters
    ----------
    points, normals : (n, 3) in mm and unit vectors of either sign
    neighbours : of each point, itself counted

    Returns
    -------
    normals : (n, 3), of one sign within a piece
    piece : (n,) number of the connected piece, 0 the largest
    """
    start, end, agrees = _links(points, normals, neighbours)
    vote = agrees * np.abs(agrees) ** 3
    start, end, vote = np.concatenate([start, end]), np.concatenate([end, start]), np.concatenate([vote, vote])
    sign, cluster, count = np.ones(len(points)), np.arange(len(points)), len(points)
    while True:
        start, end, vote = _summed(start, end, vote, count)
        if not len(start):
            break
        head, turned = _merged(start, end, vote, count)
        heads, head = np.unique(head, return_inverse=True)
        vote = vote * turned[start] * turned[end]
        start, end = head[start], head[end]
        sign *= turned[cluster]
        cluster, count = head[cluster], len(heads)
    rank = np.empty(count, dtype=np.intp)
    rank[np.argsort(-np.bincount(cluster, minlength=count))] = np.arange(count)
    return normals * sign[:, None], rank[cluster]


def _links(points: Array, normals: Array, neighbours: int) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Pairs of neighbours, and how surely they show the same side (1) or opposite ones (−1).

    Hoppe et al. (Surface reconstruction from unorganized points, 1992) compare n·n', which says nothing across a right
    angle; here n is first reflected along the step e, n·n' − 2 (n·e)(n'·e), as a surface does that turns by an arc
    (König and Gumhold, Consistent propagation of normal orientations in point clouds, 2009).
    """
    distance, index = cKDTree(points).query(points, k=min(neighbours, len(points)), workers=workers(points))
    length, index = distance[:, 1:], index[:, 1:]
    theirs, step = normals.take(index, axis=0), points.take(index, axis=0) - points[:, None]
    dot, rise = ((values @ normals[:, :, None])[:, :, 0] for values in (theirs, step))
    agrees = dot - 2.0 * rise * np.einsum("nki,nki->nk", theirs, step) / np.maximum(length, 1e-12) ** 2
    linked = (length < _FAR_NEIGHBOUR * np.median(length)) & (np.abs(agrees) > _LEAST_AGREEMENT)
    return np.nonzero(linked)[0], index[linked], agrees[linked]


def _summed(start: NDArray[np.intp], end: NDArray[np.intp], vote: Array, count: int,
            ) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """The votes between each two of ``count`` clusters added up, in the order of ``start``; where any are left."""
    apart = start != end
    votes = coo_matrix((vote[apart], (start[apart], end[apart])), shape=(count, count)).tocsr()
    votes.sort_indices()
    told = votes.data != 0.0
    start = np.repeat(np.arange(count), np.diff(votes.indptr))
    return start[told], votes.indices[told].astype(np.intp), votes.data[told]


def _merged(start: NDArray[np.intp], end: NDArray[np.intp], vote: Array, count: int) -> tuple[NDArray[np.intp], Array]:
    """The head of the group that each cluster joins by its strongest vote, and ±1 that turns it to the head's side.

    Two that chose each other are the root of a tree of choices, headed by the lower number; ties go to the lower
    number as well, so that there is no longer cycle.
    """
    strength = np.abs(vote)
    row = np.flatnonzero(np.diff(start, prepend=-1))
    most = np.repeat(np.maximum.reduceat(strength, row), np.diff(row, append=len(start)))
    strongest = np.flatnonzero(strength == most)
    strongest = strongest[np.diff(start[strongest], prepend=-1) > 0]
    head, turned = np.arange(count), np.ones(count)
    head[start[strongest]], turned[start[strongest]] = end[strongest], np.sign(vote[strongest])
    first = (head[head] == np.arange(count)) & (head > np.arange(count))
    head[first], turned[first] = np.flatnonzero(first), 1.0
    while (head[head] != head).any():
        turned, head = turned * turned[head], head[head]
    return head, turned
