# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closest scan points of a few query points, exact, in time linear in the scan and without a tree over it.

The scan is taken block by block, each small enough to stay in the processor's cache, and binned into cubic cells. For
each query, a cell that cannot hold a point nearer than the one found so far is dropped; the points of the few cells
that remain are compared. Not scipy's k-d tree: of a large scan and few queries, building it takes nearly all the time
(``./ffds benchmark speed``).
"""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array

Index = NDArray[np.intp]

_BLOCK_POINTS = 1 << 17
"""Scan points that are binned together (unit: memory of a processor's cache)."""
_CELLS_PER_ROOT = 8.0
"""Occupied cells over the square root of the number of points: as many cells as points in a cell, but for a factor
(unit: time)."""
_MOST_CELLS = 65535
"""Cells of a block (theory: 16-bit keys are sorted in linear time)."""
_FIRST_LOOK = 12
"""Cells that are looked up for each query at first (unit: time)."""
_MOST_PAIRS = 130_000
"""Pairs of a query and a point that are compared together (unit: memory of a processor's cache)."""
_SAMPLE_SIZE = 128
"""Scan points that give the first upper bounds (unit: time)."""
_CHUNK = 32768
"""Points whose keys are computed together (unit: memory of a processor's cache)."""
_SLACK = 1e-9
"""Relative slack of distance bounds: a cell kept in vain costs time, one dropped costs truth (theory: far above
rounding)."""


@dataclass(frozen=True)
class _Bins:
    """Occupied cells: the boxes of their points, and the points cell by cell.

    Attributes
    ----------
    centre, half : (k, 3), middle and half diagonal of each cell's box
    start, count : the points of cell c are ``columns[:, start[c] : start[c] + count[c]]``
    order : number of each point in the block
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
    squared, index = _nearest_of_sample(scan, queries)
    for first in range(0, len(scan), _BLOCK_POINTS):
        columns, rows = _near_queries(scan[first : first + _BLOCK_POINTS].T.copy(), queries, squared)
        if not len(rows):
            continue
        query, found, row = _search(_bin(columns), queries, squared)
        row = rows[row] + first
        nearer = (found < squared[query]) | ((found == squared[query]) & (row < index[query]))
        squared[query[nearer]], index[query[nearer]] = found[nearer], row[nearer]
    return np.sqrt(squared), index


def _nearest_of_sample(scan: Array, queries: Array) -> tuple[Array, Index]:
    """Squared distance and scan index of the nearest of a few scan points spread over the scan: upper bounds."""
    step = max(1, len(scan) // _SAMPLE_SIZE)
    squared = sum(((queries[:, a, None] - scan[::step, a]) ** 2 for a in range(3)), start=np.zeros((1, 1)))
    index = squared.argmin(axis=1)
    return squared[np.arange(len(queries)), index], index * step


def _near_queries(columns: Array, queries: Array, squared: Array) -> tuple[Array, Index]:
    """Points that may be nearer than those known, (3, k), and their numbers: in the box of the bounds."""
    reach = np.sqrt(squared.max()) * (1 + _SLACK)
    low, high = queries.min(axis=0) - reach, queries.max(axis=0) + reach
    inside = np.ones(columns.shape[1], dtype=bool)
    for x, a, b in zip(columns, low, high, strict=True):
        if x.min() < a or x.max() > b:
            inside &= (x >= a) & (x <= b)
    chosen = np.flatnonzero(inside)
    return columns if len(chosen) == len(inside) else columns.take(chosen, axis=1), chosen


def _bin(columns: Array) -> _Bins:
    """Sort points into cubic cells, in place; about 8 √n cells are occupied where the points lie on a surface."""
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
    for x in columns:
        x[:] = x.take(order)
    lowest, highest = np.minimum.reduceat(columns, start, axis=1), np.maximum.reduceat(columns, start, axis=1)
    return _Bins(0.5 * (lowest + highest).T, 0.5 * (highest - lowest).T, start, count, order, columns)


def _keys(columns: Array, low: Array, edge: float, size: Index) -> NDArray[np.uint16]:
    """Number of the cubic cell of each point; (3, n) to (n,)."""
    key = np.zeros(columns.shape[1], dtype=np.uint16)
    for x, a, steps in zip(columns, low, size, strict=True):
        step = ((x - a) * (1 / edge)).astype(np.uint16)
        key *= np.uint16(steps)
        key += np.minimum(step, np.uint16(steps - 1))
    return key


def _search(cells: _Bins, queries: Array, squared: Array) -> tuple[Index, Array, Index]:
    """Points at most as far as the nearest known: the queries that have one, its squared distance and its number.

    ``squared`` : (q,) squared distances of the nearest points known. A first look into each query's nearest cell lowers
    them.
    """
    tree = cKDTree(cells.centre)
    every = np.arange(len(queries))
    distance, cell = tree.query(queries, np.arange(1, min(_FIRST_LOOK, tree.n) + 1))
    squared = np.minimum(squared, _nearest(cells, queries, every, cell[:, 0])[1])
    bound = squared * (1 + _SLACK) + _SLACK
    reach = np.sqrt(bound) + np.linalg.norm(cells.half, axis=1).max() * (1 + _SLACK)
    found = []
    for query, near in _within(tree, queries, reach, every, distance, cell):
        gap = np.maximum(np.abs(queries[query] - cells.centre[near]) - cells.half[near], 0)
        kept = (gap * gap).sum(axis=1) <= bound[query]
        found.append(_nearest(cells, queries, query[kept], near[kept]))
    query, squared, row = (np.concatenate(x) for x in zip(*found, strict=True))
    return query, squared, row


def _within(tree: cKDTree, queries: Array, reach: Array, query: Index, distance: Array, cell: Index
            ) -> Iterator[tuple[Index, Index]]:
    """All pairs of a query and a cell whose centre is within the query's reach; in each part sorted by query.

    ``query`` : (k,) the queries that are asked for; ``distance`` and ``cell`` : (k, c) their nearest cells. Where these
    do not suffice, more are looked up.
    """
    within = distance <= reach[query, None]
    count = cell.shape[1]
    complete = ~within[:, -1] if count < tree.n else np.ones(len(query), dtype=bool)
    row, column = np.nonzero(within & complete[:, None])
    yield query[row], cell[row, column]
    left, count = query[~complete], min(4 * count, tree.n)
    some = max(1, _MOST_PAIRS // count)
    for first in range(0, len(left), some):
        part = left[first : first + some]
        yield from _within(tree, queries, reach, part, *tree.query(queries[part], np.arange(1, count + 1)))


def _nearest(cells: _Bins, queries: Array, query: Index, cell: Index) -> tuple[Index, Array, Index]:
    """Nearest point of each query among the cells it is paired with: queries, squared distances, numbers of the points.

    ``query`` is sorted; of equally near points the first in the scan is taken.
    """
    if not len(query):
        return query, np.zeros(0), query
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
    return owner[rank], squared[rank], index[rank]


def _chunks(counts: Index, most: int) -> list[slice]:
    """Slices of rows that hold about ``most`` pairs each."""
    total = np.cumsum(counts)
    cuts = np.searchsorted(total, np.arange(most, int(total[-1]), most)) + 1
    edges = np.unique(np.concatenate([[0], np.minimum(cuts, len(counts)), [len(counts)]]))
    return [slice(a, b) for a, b in zip(edges[:-1], edges[1:], strict=True)]
