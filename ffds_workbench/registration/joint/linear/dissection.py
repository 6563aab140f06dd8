# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nested dissection: a tree of separators that cuts the control points' graph into ever smaller independent parts.

Found once per part, from where the control points lie and which of them meet in a row (George, SIAM J. Numer. Anal. 10,
1973). Fill-in and work then grow as n log n and n^1.5 on a surface, far below those of a banded order.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from ...arrays import Array, Index

_LEAF = 100
_CUTS = (0.3, 0.4, 0.5, 0.6, 0.7)
_UNBALANCE = 0.25
"""Nodes of a separator that a difference of one node between its sides is worth."""


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
    _split(graph, position, np.arange(graph.shape[0]), groups)
    return _fronts(graph, groups)


def _split(graph: csr_matrix, position: Array, nodes: Index, groups: list[Index]) -> None:
    """Append the groups of a set of nodes: the parts on both sides of a separator, then the separator."""
    separator, sides = _best_separator(graph, position, nodes) if len(nodes) > _LEAF else (nodes, ())
    for side in sides:
        if len(side):
            _split(graph, position, side, groups)
    if len(separator):
        groups.append(separator)


def _best_separator(graph: csr_matrix, position: Array, nodes: Index) -> tuple[Index, tuple[Index, ...]]:
    """Smallest separator, for its balance, among cuts along the principal axes; all nodes if none of them helps."""
    local = graph[nodes][:, nodes]
    centred = position[nodes] - position[nodes].mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    best, least = nodes, float(len(nodes))
    sides: tuple[Index, ...] = ()
    for coordinate in (centred @ axes.T).T:
        for cut in np.quantile(coordinate, _CUTS):
            low = coordinate <= cut
            for side in (low, ~low):
                touches = side & (local @ (~side).astype(np.int32) > 0)
                inner, outer = side & ~touches, ~side
                cost = touches.sum() + _UNBALANCE * abs(inner.sum() - outer.sum())
                if cost < least and inner.any() and outer.any():
                    best, sides, least = nodes[touches], (nodes[inner], nodes[outer]), cost
    return best, sides


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
