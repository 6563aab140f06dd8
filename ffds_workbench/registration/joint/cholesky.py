# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cholesky factor of the normal matrix over a tree of fronts, and the part of its inverse that variances need.

Every front is a dense matrix, so that all work is in BLAS (the multifrontal method of Duff and Reid, ACM TOMS 9, 1983).
The inverse is computed on the fronts alone, from the roots down (selected inversion; Takahashi, Fagan, Chin, 1973).
"""
from __future__ import annotations

import numpy as np
from scipy.linalg import blas, lapack

from ..splines import Array
from .dissection import Front
from .lattice import Index


class FrontLayout:
    """Where the 3 × 3 blocks of a pattern go in the dense matrices of the fronts."""

    def __init__(self, fronts: list[Front], rows: Index, columns: Index) -> None:
        """``rows`` and ``columns`` (blocks,) are the nodes of every block of the pattern."""
        self.fronts = fronts
        self.sizes = np.array([3 * (len(f.own) + len(f.border)) for f in fronts])
        self.offset = np.concatenate([[0], np.cumsum(self.sizes**2)])
        self.own_rows = [_triple(f.own) for f in fronts]
        self.border_rows = [_triple(f.border) for f in fronts]
        self.parent_runs = [_runs(f.in_parent) for f in fronts]
        front_of = np.empty(rows.max() + 1, dtype=np.intp)
        for number, front in enumerate(fronts):
            front_of[front.own] = number
        home = np.minimum(front_of[rows], front_of[columns])
        order = np.argsort(home, kind="stable")
        bounds = np.searchsorted(home[order], np.arange(len(fronts) + 1))
        place = np.empty(len(front_of), dtype=np.intp)
        target = np.empty(len(rows), dtype=np.intp)
        for number, front in enumerate(fronts):
            place[front.own] = np.arange(len(front.own))
            place[front.border] = len(front.own) + np.arange(len(front.border))
            here = order[bounds[number] : bounds[number + 1]]
            target[here] = self.offset[number] + 3 * (place[rows[here]] * self.sizes[number] + place[columns[here]])
        inner = np.arange(3)[:, None] * self.sizes[home][:, None, None] + np.arange(3)
        targets = target[:, None, None] + inner
        order = np.empty(len(front_of), dtype=np.intp)
        order[np.concatenate([f.own for f in fronts])] = np.arange(len(order))
        self.upper = np.flatnonzero(order[rows] <= order[columns])
        self.upper_target = targets[self.upper].ravel()
        self.target = targets.ravel()

    def matrix(self, flat: Array, number: int) -> Array:
        """The dense matrix of one front as a view, rows of its own nodes first."""
        n = self.sizes[number]
        return flat[self.offset[number] : self.offset[number + 1]].reshape(n, n)


class FrontCholesky:
    """A = L Lᵀ, front by front."""

    def __init__(self, layout: FrontLayout, blocks: Array) -> None:
        """Factor the matrix with the pattern's ``blocks`` (n, 3, 3).

        Raises
        ------
        numpy.linalg.LinAlgError : the matrix is not positive definite
        """
        self.layout = layout
        flat = np.zeros(layout.offset[-1])
        flat[layout.upper_target] = blocks[layout.upper].ravel()      # nothing below the diagonals is ever looked at
        self.own: list[Array] = []
        self.border: list[Array] = []
        for number, front in enumerate(layout.fronts):
            matrix, k = layout.matrix(flat, number), 3 * len(front.own)
            factor, info = lapack.dpotrf(matrix[:k, :k].T, lower=1, clean=1)
            if info:
                raise np.linalg.LinAlgError("the normal matrix is not positive definite")
            border = blas.dtrsm(1.0, factor, matrix[:k, k:], lower=1)
            if front.parent >= 0:
                left = blas.dsyrk(-1.0, border, 1.0, matrix[k:, k:].T, trans=1, lower=1).T
                above, runs = layout.matrix(flat, front.parent), layout.parent_runs[number]
                for first, (here, there) in enumerate(runs):
                    for other_here, other_there in runs[first:]:
                        above[there, other_there] += left[here, other_here]
            self.own.append(factor)
            self.border.append(border)

    def solve(self, right: Array) -> Array:
        """x with A x = right, (3 nodes,) ordered node by node."""
        layout, x = self.layout, right.copy()
        for factor, border, own, rows in zip(self.own, self.border, layout.own_rows, layout.border_rows, strict=True):
            part = blas.dtrsv(factor, x[own], lower=1)
            x[own] = part
            x[rows] -= part @ border
        for number in range(len(self.own) - 1, -1, -1):
            own = layout.own_rows[number]
            part = x[own] - self.border[number] @ x[layout.border_rows[number]]
            x[own] = blas.dtrsv(self.own[number], part, lower=1, trans=1)
        return x

    def solve_many(self, right: Array) -> Array:
        """x with A x = right for several right-hand sides, (3 nodes, m)."""
        layout, x = self.layout, right.copy()
        for factor, border, own, rows in zip(self.own, self.border, layout.own_rows, layout.border_rows, strict=True):
            x[own] = blas.dtrsm(1.0, factor, x[own], lower=1)
            x[rows] -= border.T @ x[own]
        for number in range(len(self.own) - 1, -1, -1):
            own = layout.own_rows[number]
            part = x[own] - self.border[number] @ x[layout.border_rows[number]]
            x[own] = blas.dtrsm(1.0, self.own[number], part, lower=1, trans_a=1)
        return x

    def inverse_blocks(self) -> Array:
        """The blocks of A⁻¹ on the pattern, (n, 3, 3)."""
        layout = self.layout
        flat = np.empty(layout.offset[-1])
        for number in range(len(layout.fronts) - 1, -1, -1):
            front, z = layout.fronts[number], layout.matrix(flat, number)
            k = 3 * len(front.own)
            lower = lapack.dpotri(self.own[number], lower=1)[0]       # zero above its diagonal, as the factor is
            z[:k, :k] = lower + lower.T
            np.fill_diagonal(z[:k, :k], lower.diagonal())
            if front.parent >= 0:
                above, runs, below = layout.matrix(flat, front.parent), layout.parent_runs[number], z[k:, k:]
                for here, there in runs:
                    for other_here, other_there in runs:
                        below[here, other_here] = above[there, other_there]
                reach = blas.dtrsm(1.0, self.own[number], self.border[number], lower=1, trans_a=1)
                z[:k, k:] = -reach @ z[k:, k:]
                z[k:, :k] = z[:k, k:].T
                z[:k, :k] -= reach @ z[k:, :k]
        return flat[layout.target].reshape(-1, 3, 3)


def _runs(places: Index) -> list[tuple[slice, slice]]:
    """Rising places as pieces without a gap: where each lies among them, and where in the parent; three rows a node."""
    starts = np.flatnonzero(np.diff(places, prepend=-2) != 1)
    ends = np.append(starts[1:], len(places))[: len(starts)]
    return [(slice(3 * a, 3 * b), slice(3 * places[a], 3 * places[a] + 3 * (b - a)))
            for a, b in zip(starts.tolist(), ends.tolist(), strict=True)]


def _triple(nodes: Index) -> Index:
    return (3 * nodes[:, None] + np.arange(3)).ravel()
