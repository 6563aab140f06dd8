# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cholesky factor of a sparse symmetric matrix, ordered by level sets so that it is block tridiagonal.

A breadth-first search from the rim of the graph cuts the unknowns into levels that only touch their neighbours; every
step is then a dense BLAS call on one level. The same form gives the entries of the inverse that lie on the pattern
(selected inversion), which is where variances come from.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import blas, lapack
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components, dijkstra

from ..splines import Array
from .lattice import Index


@dataclass(frozen=True)
class Levels:
    """Order of the nodes, level by level.

    Attributes
    ----------
    order : (n,) nodes in their new order
    place : (n,) new place of every node
    start : (levels + 1,) first place of every level
    of_node : (n,) level of every node
    """

    order: Index
    place: Index
    start: Index
    of_node: Index


def level_sets(graph: csr_matrix) -> Levels:
    """Levels of every connected component, from a node at its rim, one component after the other."""
    count, component = connected_components(graph, directed=False)
    level = np.zeros(graph.shape[0], dtype=np.intp)
    offset = 0
    for k in range(count):
        nodes = np.flatnonzero(component == k)
        part = graph[nodes][:, nodes]
        root = 0
        for _ in range(2):
            root = breadth_first_order(part, root, directed=False, return_predecessors=False)[-1]
        distance = dijkstra(part, directed=False, indices=root, unweighted=True).astype(np.intp)
        level[nodes] = offset + distance
        offset += distance.max() + 1
    order = np.argsort(level, kind="stable")
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    start = np.searchsorted(level[order], np.arange(offset + 1))
    return Levels(order, place, start, level)


class LevelLayout:
    """Where the 3 × 3 blocks of a pattern go in the dense blocks of the levels."""

    def __init__(self, rows: Index, columns: Index, graph: csr_matrix) -> None:
        """``rows`` and ``columns`` (blocks,) are the nodes of every stored block, ``graph`` the pattern."""
        self.levels = levels = level_sets(graph)
        self.start = 3 * levels.start
        row, column = levels.place[rows], levels.place[columns]
        row_level, column_level = levels.of_node[rows], levels.of_node[columns]
        size = np.diff(levels.start)
        below = np.append(size[1:], 0)
        area = 9 * np.stack([size * size, below * size], axis=1)
        self.offset = np.concatenate([[0], np.cumsum(area.ravel())])
        self.kept = np.flatnonzero((row_level == column_level) | (row_level == column_level + 1))
        row, column = row[self.kept], column[self.kept]
        row_level, column_level = row_level[self.kept], column_level[self.kept]
        lower = row_level - column_level
        i, j = 3 * (row - levels.start[row_level]), 3 * (column - levels.start[column_level])
        width = 3 * size[column_level]
        first = self.offset[2 * column_level + lower] + i * width + j
        inner = np.arange(3)[:, None, None] * width + np.arange(3)[None, :, None]
        self.target = (first + inner).transpose(2, 0, 1).ravel()

    def dense(self, blocks: Array) -> tuple[list[Array], list[Array]]:
        """Diagonal and sub-diagonal level blocks from the pattern's 3 × 3 blocks."""
        flat = np.zeros(self.offset[-1])
        flat[self.target] = blocks[self.kept].ravel()
        size = np.diff(self.start)
        diagonal, lower = [], []
        for k, n in enumerate(size):
            a, b, c = self.offset[2 * k : 2 * k + 3]
            diagonal.append(flat[a:b].reshape(n, n))
            lower.append(flat[b:c].reshape(-1, n))
        return diagonal, lower[:-1]


class LevelCholesky:
    """A = L Lᵀ over the levels of a layout."""

    def __init__(self, layout: LevelLayout, blocks: Array) -> None:
        """Factor the matrix with the pattern's ``blocks`` (n, 3, 3).

        Raises
        ------
        numpy.linalg.LinAlgError : the matrix is not positive definite
        """
        self.layout = layout
        diagonal, lower = layout.dense(blocks)
        self.diagonal: list[Array] = []
        self.lower: list[Array] = []
        for k, block in enumerate(diagonal):
            if k:
                # F = E L⁻ᵀ, as the transposed triangular solve of Fortran-ordered arrays.
                f = blas.dtrsm(1.0, self.diagonal[-1], lower[k - 1].T, lower=1, overwrite_b=1).T
                self.lower.append(f)
                block = block - f @ f.T
            factor, info = lapack.dpotrf(block.T, lower=1, clean=1, overwrite_a=1)
            if info:
                raise np.linalg.LinAlgError(f"the normal matrix is not positive definite (level {k})")
            self.diagonal.append(factor)

    def solve(self, right: Array) -> Array:
        """x with A x = right, (3 nodes,) ordered node by node."""
        order, start = self.layout.levels.order, self.layout.start
        b = right.reshape(-1, 3)[order].ravel()
        parts = []
        for k, factor in enumerate(self.diagonal):
            part = b[start[k] : start[k + 1]]
            if k:
                part = part - self.lower[k - 1] @ parts[-1]
            parts.append(blas.dtrsv(factor, part, lower=1))
        for k in range(len(parts) - 1, -1, -1):
            part = parts[k]
            if k + 1 < len(parts):
                part = part - self.lower[k].T @ parts[k + 1]
            parts[k] = blas.dtrsv(self.diagonal[k], part, lower=1, trans=1)
        x = np.empty((len(order), 3))
        x[order] = np.concatenate(parts).reshape(-1, 3)
        return x.ravel()

    def inverse_blocks(self) -> Array:
        """The 3 × 3 blocks of A⁻¹ on the kept part of the pattern: (kept, 3, 3), by Takahashi's recursion."""
        last = len(self.diagonal) - 1
        flat = np.zeros(self.layout.offset[-1])
        below = np.zeros((0, 0))
        for k in range(last, -1, -1):
            n = len(self.diagonal[k])
            inverse = blas.dtrsm(1.0, self.diagonal[k], np.eye(n, order="F"), lower=1)
            z = inverse.T @ inverse
            a, b, c = self.layout.offset[2 * k : 2 * k + 3]
            if k < last:
                g = self.lower[k] @ inverse
                zg = below @ g
                flat[b:c] = -zg.ravel()
                z += g.T @ zg
            flat[a:b] = z.ravel()
            below = z
        return flat[self.layout.target].reshape(-1, 3, 3)
