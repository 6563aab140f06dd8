# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nested dissection: a tree of separators that cuts the graph of the control points into ever smaller independent
parts.

Computed once per part, from where the control points lie and which of them share a row (George, SIAM J. Numer. Anal.
10, 1973). Fill-in and work then grow as n log n and n^1.5 on a surface, far below those of a banded order. Own code
because scipy orders by bands only (reverse Cuthill and McKee), and Debian 12 has no METIS for Python.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra

from ...arrays import Array, Index

_LEAF_NODES = 100
"""Nodes that are not cut any further: a dense matrix of theirs is as fast (unit: time)."""
_UNBALANCE = 0.1
"""Nodes of a separator that a difference of one node between its sides is worth (unit: time)."""


@dataclass(frozen=True)
class Front:
    """Nodes that are eliminated together, and the nodes they still touch then.

    Attributes
    ----------
    own : (k,) nodes eliminated here
    border : (b,) nodes of ancestors that remain coupled
    parent : number of the front that the border starts in, −1 at a root
    in_parent : (b,) places of the border among the parent's own nodes and border
    """

    own: Index
    border: Index
    parent: int
    in_parent: Index


def dissect(graph: csr_matrix, position: Array) -> list[Front]:
    """Fronts in the order of elimination, children before parents.

    Parameters
    ----------
    graph : symmetric pattern of the matrix, (n, n), diagonal included
    position : (n, 3) of the nodes in mm
    """
    groups: list[Index] = []
    graph = graph.astype(float)
    _split(graph, position, np.arange(graph.shape[0]), groups)
    return _fronts(graph, groups)


def _split(graph: csr_matrix, position: Array, nodes: Index, groups: list[Index]) -> None:
    """Append the groups of a set of nodes: the parts on both sides of a separator, the larger one first, so that less
    waits for others (Liu, ACM TOMS 12, 1986), then the separator."""
    separator: Index = np.arange(len(nodes))
    sides: tuple[Index, ...] = ()
    if len(nodes) > _LEAF_NODES:
        separator, sides = _cut(graph[nodes][:, nodes], position[nodes])
    for side in sorted(sides, key=len, reverse=True):
        _split(graph, position, nodes[side], groups)
    if len(separator):
        groups.append(nodes[separator])


def _cut(graph: csr_matrix, position: Array) -> tuple[Index, tuple[Index, ...]]:
    """The separator of a graph and what it parts; an unconnected graph has an empty separator, and where no cut helps
    it holds all nodes.

    Of all cuts across the principal axes, and between the levels of a breadth-first search from one end (George and
    Liu, Computer Solution of Large Sparse Positive Definite Systems, 1981, chapter 8), the cheapest.
    """
    count, component = connected_components(graph, directed=False)
    if count > 1:
        order = np.argsort(component, kind="stable")
        return np.zeros(0, dtype=np.intp), tuple(np.split(order, np.cumsum(np.bincount(component))[:-1]))
    centred = position - position.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    cuts = [_cheapest(graph, sign * coordinate) for coordinate in (*(centred @ axes.T).T, _levels(graph))
            for sign in (1.0, -1.0)]
    cost, separator, sides = min(cuts, key=lambda cut: cut[0])
    return (separator, sides) if cost < len(position) else (np.arange(len(position)), ())


def _levels(graph: csr_matrix) -> Array:
    """Steps from a node that is as far away from others as any."""
    first = dijkstra(graph, indices=0, unweighted=True)
    return np.asarray(dijkstra(graph, indices=int(np.argmax(first)), unweighted=True))


def _cheapest(graph: csr_matrix, coordinate: Array) -> tuple[float, Index, tuple[Index, ...]]:
    """Cost, separator and sides of the best of all cuts of the nodes by a coordinate of theirs, (n,).

    Nodes up to the cut that touch one beyond it are the separator.
    """
    rank = np.unique(coordinate, return_inverse=True)[1]
    farthest = np.maximum.reduceat(rank[graph.indices], graph.indptr[:-1])
    near, inner = (np.cumsum(np.bincount(item, minlength=rank.max() + 1)) for item in (rank, farthest))
    outer = len(rank) - near
    cost = np.where((inner > 0) & (outer > 0), near - inner + _UNBALANCE * np.abs(inner - outer), np.inf)
    cut = int(np.argmin(cost))
    beyond, apart = rank > cut, farthest <= cut
    sides = np.flatnonzero(apart), np.flatnonzero(beyond)
    return float(cost[cut]), np.flatnonzero(~apart & ~beyond), sides


def _fronts(graph: csr_matrix, groups: list[Index]) -> list[Front]:
    rank = np.empty(graph.shape[0], dtype=np.intp)
    group = np.empty(graph.shape[0], dtype=np.intp)
    ordered = np.concatenate(groups)
    rank[ordered] = np.arange(len(ordered))
    group[ordered] = np.repeat(np.arange(len(groups)), [len(g) for g in groups])
    borders: list[list[Index]] = [[] for _ in groups]
    found, parents = [], []
    for number, own in enumerate(groups):
        touched = np.unique(np.concatenate([graph[own].indices, *borders[number]]))
        border = touched[group[touched] > number]
        border = border[np.argsort(rank[border])]
        parent = int(group[border[0]]) if len(border) else -1
        if parent >= 0:
            borders[parent].append(border)
        found.append(border)
        parents.append(parent)
    fronts = []
    for own, border, parent in zip(groups, found, parents, strict=True):
        places = np.zeros(0, dtype=np.intp)
        if parent >= 0:
            place = np.zeros(len(rank), dtype=np.intp)
            members = np.concatenate([groups[parent], found[parent]])
            place[members] = np.arange(len(members))
            places = place[border]
        fronts.append(Front(own, border, parent, places))
    return fronts
