# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cholesky factor of the normal matrix over a tree of fronts, and the part of its inverse that variances need.

Every front is a dense matrix, so that all work is in BLAS (the multifrontal method of Duff and Reid, ACM TOMS 9, 1983).
They lie in memory the way BLAS wants them, so that it factors them in place.
The inverse is computed on the fronts alone, from the roots down (selected inversion; Takahashi, Fagan, Chin, 1973).

Own code because scipy has no sparse Cholesky, and the bands need blocks of the inverse: scikit-sparse, which is not in
Debian 12, gives the factor alone.
"""
from __future__ import annotations

from itertools import product

import numpy as np
from scipy.linalg import blas, lapack

from ...arrays import Array, Index
from .elimination_order import Front

_Runs = list[tuple[slice, slice]]


class FrontLayout:
    """Where the 3 × 3 blocks of a pattern go in the rows of the fronts' own nodes, (k, k + b) each, that lie one after
    the other, column by column. Nothing below the diagonal is ever looked at."""

    def __init__(self, fronts: list[Front], rows: Index, columns: Index) -> None:
        """``rows`` and ``columns`` (blocks,) are the nodes of every block of the pattern; of a block and its transpose
        it has one."""
        self.fronts = fronts
        self.own = np.array([3 * len(f.own) for f in fronts])
        self.sizes = self.own + np.array([3 * len(f.border) for f in fronts])
        self.offset = np.concatenate([[0], np.cumsum(self.own * self.sizes)])
        self.own_rows = [_triple(f.own) for f in fronts]
        self.border_rows = [_triple(f.border) for f in fronts]
        self.parents = {f.parent for f in fronts}
        self.parent_runs = [_runs(f.in_parent, len(fronts[f.parent].own)) for f in fronts]
        front_of, turn, place = np.empty((3, rows.max() + 1), dtype=np.intp)
        for number, front in enumerate(fronts):
            front_of[front.own] = number
        turn[np.concatenate([f.own for f in fronts])] = np.arange(len(turn))
        turned = turn[rows] > turn[columns]
        rows, columns = np.where(turned, columns, rows), np.where(turned, rows, columns)
        home = front_of[rows]
        order = np.argsort(home, kind="stable")
        bounds = np.searchsorted(home[order], np.arange(len(fronts) + 1))
        self.first = np.empty(len(rows), dtype=np.intp)
        for number, front in enumerate(fronts):
            place[front.own] = np.arange(len(front.own))
            place[front.border] = len(front.own) + np.arange(len(front.border))
            here = order[bounds[number] : bounds[number + 1]]
            self.first[here] = self.offset[number] + 3 * (place[rows[here]] + place[columns[here]] * self.own[number])
        self.down, self.right = np.where(turned, self.own[home], 1), np.where(turned, 1, self.own[home])

    def places(self, a: int, b: int) -> Index:
        """Where the component ``a``, ``b`` of every block lies in the rows of all fronts: (blocks,)."""
        return self.first + a * self.down + b * self.right

    def rows(self, flat: Array, number: int) -> Array:
        """The rows of one front's own nodes as a view, (k, k + b) in Fortran's order."""
        return flat[self.offset[number] : self.offset[number + 1]].reshape(self.own[number], -1, order="F")


class FrontCholesky:
    """A = Uᵀ U, front by front; ``flat`` (size,) holds the rows of U of all fronts, as `FrontLayout` has them."""

    flat: Array

    def __init__(self, layout: FrontLayout, blocks: Array, earlier: FrontCholesky | None = None) -> None:
        """Factor the matrix with the pattern's ``blocks`` (3, 3, n).

        The memory of an ``earlier`` factor of the same layout is reused, and holds the factor of this matrix from then
        on.

        Raises
        ------
        numpy.linalg.LinAlgError : the matrix is not positive definite
        """
        self.layout = layout
        self.flat = flat = np.empty(layout.offset[-1]) if earlier is None else earlier.flat
        flat[:] = 0.0
        for a, b in product(range(3), repeat=2):
            flat[layout.places(a, b)] = blocks[a, b]
        self.own: list[Array] = []
        self.border: list[Array] = []
        rest: dict[int, Array] = {}
        memory: list[Array] = []
        for number, front in enumerate(layout.fronts):
            rows, k = layout.rows(flat, number), layout.own[number]
            factor, info = lapack.dpotrf(rows[:, :k], clean=0, overwrite_a=1)
            if info:
                raise np.linalg.LinAlgError("the normal matrix is not positive definite")
            border = blas.dtrsm(1.0, factor, rows[:, k:], trans_a=1, overwrite_b=1)
            if front.parent >= 0:
                left = rest.pop(number) if number in rest else _square(border.shape[1], memory)
                blas.dsyrk(-1.0, border, float(number in layout.parents), left, trans=1, overwrite_c=1)
                above, k = layout.rows(flat, front.parent), layout.own[front.parent]
                if front.parent not in rest:
                    rest[front.parent] = _square(above.shape[1] - k, memory)
                    rest[front.parent][:] = 0.0
                own, beyond = layout.parent_runs[number]
                with np.errstate(over="ignore", invalid="ignore"):  # fresh memory lies below the diagonals
                    _add(above[:, :k], left, own, own)
                    _add(above[:, k:], left, own, beyond)
                    _add(rest[front.parent], left, beyond, beyond)
                memory.append(np.asarray(left.base))
            self.own.append(factor)
            self.border.append(border)

    def solve(self, right: Array) -> Array:
        """x with A x = right, (3 nodes,) ordered node by node."""
        layout, x = self.layout, right.copy()
        for factor, border, own, rows in zip(self.own, self.border, layout.own_rows, layout.border_rows, strict=True):
            part = blas.dtrsv(factor, x[own], trans=1)
            x[own] = part
            x[rows] -= part @ border
        for number in range(len(self.own) - 1, -1, -1):
            own = layout.own_rows[number]
            part = x[own] - self.border[number] @ x[layout.border_rows[number]]
            x[own] = blas.dtrsv(self.own[number], part)
        return x

    def solve_many(self, right: Array) -> Array:
        """x with A x = right for several right-hand sides, (3 nodes, m)."""
        layout, x = self.layout, right.copy()
        for factor, border, own, rows in zip(self.own, self.border, layout.own_rows, layout.border_rows, strict=True):
            x[own] = blas.dtrsm(1.0, factor, x[own], trans_a=1)
            x[rows] -= border.T @ x[own]
        for number in range(len(self.own) - 1, -1, -1):
            own = layout.own_rows[number]
            part = x[own] - self.border[number] @ x[layout.border_rows[number]]
            x[own] = blas.dtrsm(1.0, self.own[number], part)
        return x

    def inverse_blocks(self) -> Array:
        """The blocks of A⁻¹ on the pattern, (3, 3, n). They overwrite the factor, which cannot be used any more."""
        layout, flat = self.layout, self.flat
        last_child = {front.parent: number for number, front in reversed(list(enumerate(layout.fronts)))}
        beyond: dict[int, Array] = {}
        for number in range(len(layout.fronts) - 1, -1, -1):
            parent, k = layout.fronts[number].parent, layout.own[number]
            rows, upper = layout.rows(flat, number), np.triu(lapack.dpotri(self.own[number])[0])
            reach = blas.dtrsm(1.0, self.own[number], self.border[number]) if parent >= 0 else self.border[number]
            rows[:, :k] = upper + upper.T
            np.fill_diagonal(rows[:, :k], upper.diagonal())
            if parent >= 0:
                border = self._inverse_beyond(flat, number, beyond.get(parent))
                rows[:, k:] = blas.dsymm(-1.0, border, reach, side=1)
                rows[:, :k] -= rows[:, k:] @ reach.T
                if number in last_child:
                    beyond[number] = border
                if last_child[parent] == number:
                    beyond.pop(parent, None)
        result = np.empty((3, 3, len(layout.first)))
        for a, b in product(range(3), repeat=2):
            result[a, b] = flat[layout.places(a, b)]
        return result

    def _inverse_beyond(self, flat: Array, number: int, beyond_parent: Array | None) -> Array:
        """The inverse among the border of a front, (b, b), on and above the diagonal, from that of its parent."""
        layout = self.layout
        parent, size = layout.fronts[number].parent, layout.sizes[number] - layout.own[number]
        result = np.empty((size, size), order="F")
        rows, k = layout.rows(flat, parent), layout.own[parent]
        own, beyond = layout.parent_runs[number]
        _take(result, rows[:, :k], own, own)
        _take(result, rows[:, k:], own, beyond)
        if beyond_parent is not None:
            _take(result, beyond_parent, beyond, beyond)
        return result


def _square(size: int, memory: list[Array]) -> Array:
    """A matrix in the smallest piece of used memory that holds it, or in new memory: allocating fresh pages takes
    longer than filling them."""
    fits = [number for number, piece in enumerate(memory) if len(piece) >= size * size]
    piece = memory.pop(min(fits, key=lambda number: len(memory[number]))) if fits else np.empty(size * size)
    return np.ndarray((size, size), buffer=piece, order="F")


def _add(target: Array, left: Array, rows: _Runs, columns: _Runs) -> None:
    """Add a matrix to another piece by piece; what ends up below the diagonal is never used."""
    for number, (here, there) in enumerate(rows):
        for other_here, other_there in columns[number if columns is rows else 0 :]:
            target[there, other_there] += left[here, other_here]


def _take(target: Array, source: Array, rows: _Runs, columns: _Runs) -> None:
    """The inverse of `_add`: take the entries that it would add to."""
    for number, (here, there) in enumerate(rows):
        for other_here, other_there in columns[number if columns is rows else 0 :]:
            target[here, other_here] = source[there, other_there]


def _runs(places: Index, own: int) -> tuple[_Runs, _Runs]:
    """Rising places as pieces without a gap: where each lies among them, and where in the parent, three rows a node.

    Those before ``own`` come first, those from there on second and counted from there.
    """
    starts = np.flatnonzero((np.diff(places, prepend=-2) != 1) | (places == own))
    ends = np.append(starts[1:], len(places))[: len(starts)]
    runs: tuple[_Runs, _Runs] = [], []
    for a, b, place in zip(starts.tolist(), ends.tolist(), places[starts].tolist(), strict=True):
        beyond = place >= own
        there = place - own * beyond
        runs[beyond].append((slice(3 * a, 3 * b), slice(3 * there, 3 * (there + b - a))))
    return runs


def _triple(nodes: Index) -> Index:
    return (3 * nodes[:, None] + np.arange(3)).ravel()
