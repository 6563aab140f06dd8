# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closest scan points of a few query points, exact, in time linear in the scan and without a tree over it.

The scan is binned once into cubic cells. For each query, a cell that cannot hold a point nearer than one already found
is dropped; the points of the few cells that remain are compared.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .splines import Array

Index = NDArray[np.intp]

_CELLS_PER_ROOT = 4.0
_MOST_CELLS = 65535
_MOST_PAIRS = 130_000
_SAMPLE = 128
_CHUNK = 32768
_SLACK = 1e-9
"""Relative slack of distance bounds, far above rounding: a cell kept in vain costs time, one dropped costs truth."""


@dataclass(frozen=True)
class _Cells:
    """Occupied cells: the boxes of their points, and the points cell by cell.

    Attributes
    ----------
    centre, half : (k, 3), middle and half diagonal of each cell's box
    start, count : the points of cell c are ``columns[:, start[c] : start[c] + count[c]]``
    order : scan index of each point
    columns : (3, n) coordinates
    """

    centre: Array
    half: Array
    start: Index
    count: Index
    order: Index
    columns: Array


def nearest_neighbours(scan: Array, queries: Array) -> tuple[Array, Index]:
    """The closest scan point of each query: what ``scipy.spatial.cKDTree(scan).query(queries)`` returns.

    Parameters
    ----------
    scan : (n, 3) in mm, finite, n ≥ 1
    queries : (q, 3) in mm

    Returns
    -------
    distances : (q,) in mm
    indices : (q,) into the scan; among equally near points the first one
    """
    columns, subset = _near_queries(np.ascontiguousarray(scan.T), queries)
    cells = _bin(columns)
    distances, indices = np.empty(len(queries)), np.empty(len(queries), dtype=np.intp)
    block = max(1, _MOST_PAIRS // len(cells.start))
    for first in range(0, len(queries), block):
        part = slice(first, first + block)
        distances[part], indices[part] = _search(cells, queries[part])
    return distances, indices if subset is None else subset[indices]


def _search(cells: _Cells, queries: Array) -> tuple[Array, Index]:
    """Bound each query's distance by the nearest cell's points, then compare those of all cells within the bound."""
    squared_norm = (queries * queries).sum(axis=1)
    partial = np.c_[-2 * queries, np.ones(len(queries))] @ np.c_[cells.centre, (cells.centre**2).sum(axis=1)].T
    best = partial.argmin(axis=1)
    query = np.arange(len(queries))
    squared, _ = _nearest(cells, queries, query, best)
    reach = (np.sqrt(squared) + np.linalg.norm(cells.half, axis=1).max()) ** 2
    within = partial <= (reach - squared_norm + _SLACK * (reach + squared_norm))[:, None]
    query, cell = np.divmod(np.flatnonzero(within), len(cells.start))
    gap = np.maximum(np.abs(queries[query] - cells.centre[cell]) - cells.half[cell], 0)
    near = (gap * gap).sum(axis=1) <= squared[query] * (1 + _SLACK) + _SLACK
    squared, found = _nearest(cells, queries, query[near], cell[near])
    return np.sqrt(squared), found


def _near_queries(columns: Array, queries: Array) -> tuple[Array, Index | None]:
    """The part of the scan that can hold an answer: the queries' box, grown by an upper bound of all distances."""
    sample = columns[:, :: max(1, columns.shape[1] // _SAMPLE)]
    squared = sum(((queries[:, a, None] - sample[a]) ** 2 for a in range(3)), start=np.zeros((1, 1)))
    reach = np.sqrt(squared.min(axis=1).max()) * (1 + _SLACK)
    low, high = queries.min(axis=0) - reach, queries.max(axis=0) + reach
    inside = np.ones(columns.shape[1], dtype=bool)
    for x, a, b in zip(columns, low, high, strict=True):
        if x.min() < a or x.max() > b:
            inside &= (x >= a) & (x <= b)
    if inside.all():
        return columns, None
    subset = np.flatnonzero(inside)
    return columns.take(subset, axis=1), subset


def _bin(columns: Array) -> _Cells:
    """Cubic cells over the points' box; about 4 √n of them are occupied where the points lie on a surface."""
    low = columns.min(axis=1)
    extent = columns.max(axis=1) - low
    n = columns.shape[1]
    area = extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0]
    edge = max(np.sqrt(area / (_CELLS_PER_ROOT * np.sqrt(n))), extent.max() / 1000, np.finfo(float).tiny)
    while np.prod(np.floor(extent / edge) + 1) > _MOST_CELLS:
        edge *= 1.1
    size = np.floor(extent / edge).astype(np.intp) + 1
    key = np.empty(n, dtype=np.uint16)
    for first in range(0, n, _CHUNK):
        part = slice(first, first + _CHUNK)
        key[part] = _keys(columns[:, part], low, edge, size)
    order = np.argsort(key, kind="stable")  # 16-bit keys: a radix sort, linear in n
    count = np.bincount(key)
    count = count[count > 0]
    start = np.cumsum(count) - count
    ordered = columns.take(order, axis=1)
    lowest, highest = np.minimum.reduceat(ordered, start, axis=1), np.maximum.reduceat(ordered, start, axis=1)
    return _Cells(0.5 * (lowest + highest).T, 0.5 * (highest - lowest).T, start, count, order, ordered)


def _keys(columns: Array, low: Array, edge: float, size: Index) -> NDArray[np.uint16]:
    """Number of the cubic cell of each point; (3, n) to (n,)."""
    key = np.zeros(columns.shape[1], dtype=np.uint16)
    for x, a, steps in zip(columns, low, size, strict=True):
        step = ((x - a) * (1 / edge)).astype(np.uint16)
        key *= np.uint16(steps)
        key += np.minimum(step, np.uint16(steps - 1))
    return key


def _nearest(cells: _Cells, queries: Array, query: Index, cell: Index) -> tuple[Array, Index]:
    """Nearest point of each query among the given cells: squared distances and scan indices.

    ``query`` is sorted and names every query at least once; of equally near points the first in the scan is taken.
    """
    nearest = []
    for part in _chunks(cells.count[cell], _MOST_PAIRS):
        count = cells.count[cell[part]]
        first = np.cumsum(count) - count
        row = np.arange(int(count.sum())) + np.repeat(cells.start[cell[part]] - first, count)
        squared = np.zeros(len(row))
        for x, q in zip(cells.columns, queries[query[part]].T, strict=True):
            gap = x.take(row)
            gap -= np.repeat(q, count)
            gap *= gap
            squared += gap
        change = np.flatnonzero(np.diff(query[part], prepend=-1))
        group = first[change]
        least = np.minimum.reduceat(squared, group)
        hit = np.flatnonzero(squared == np.repeat(least, np.diff(np.append(group, len(row)))))
        owner = query[part][change[np.searchsorted(group, hit, side="right") - 1]]
        nearest.append((owner, squared[hit], cells.order[row[hit]]))
    owner, squared, index = (np.concatenate(x) for x in zip(*nearest, strict=True))
    rank = np.lexsort((index, squared, owner))
    rank = rank[np.flatnonzero(np.diff(owner[rank], prepend=-1))]
    return squared[rank], index[rank]


def _chunks(counts: Index, most: int) -> list[slice]:
    """Slices of rows that hold about ``most`` pairs each."""
    total = np.cumsum(counts)
    cuts = np.searchsorted(total, np.arange(most, int(total[-1]), most)) + 1
    edges = np.unique(np.concatenate([[0], np.minimum(cuts, len(counts)), [len(counts)]]))
    return [slice(a, b) for a, b in zip(edges[:-1], edges[1:], strict=True)]
