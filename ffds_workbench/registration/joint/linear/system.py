# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sparsity pattern of the normal equations, sums over spans on it, and their solution with a reused factor."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.sparse import bsr_matrix, csr_matrix, spmatrix, triu

from ...arrays import Array, Index
from ..surfaces import Lattices
from .cholesky import FrontCholesky, FrontLayout
from .elimination_order import dissect

_CG_STEPS = 12
"""Steps after which a new factor is cheaper: it costs as much as some 30 of them, and the next steps need it too
(unit: time)."""
_CG_TOLERANCE = 3e-3
"""Of the energy norm of the error, where conjugate gradients stop (unit: the next step corrects the rest)."""
_LOT = 512
"""Spans whose matrices are made together (unit: memory)."""
_PAIR_ROW, _PAIR_COLUMN = np.triu_indices(16)
"""Pairs of the control points of a span, (136,) each (theory: 16 of them)."""


@dataclass(frozen=True)
class SomeBlocks:
    """Values at some places of a pattern, each once.

    Attributes
    ----------
    place : (n,) numbers of the blocks
    values : (3, 3, n)
    """

    place: Index
    values: Array

    def add_to(self, blocks: Array, weight: float) -> None:
        """Add them, times ``weight``, to the ``blocks`` (3, 3, size) of the whole pattern, in place."""
        for a, b in product(range(3), repeat=2):
            blocks[a, b, self.place] += weight * self.values[a, b]


class Pattern:
    """Which control points share a row, computed once per part.

    The normal matrix is symmetric. Of every block and its transpose the pattern holds the one whose row has the smaller
    number, and what stands on it are blocks (3, 3, size): components first, as sums over all blocks are then sums of
    rows in memory.

    Parameters of the methods
    -------------------------
    blocks : (3, 3, size) values in the pattern's order
    spans : (n,) or all
    """

    def __init__(self, lattices: Lattices, couplings: Sequence[spmatrix], position: Array) -> None:
        """``couplings`` are scalar (controls, controls) matrices whose non-zeros belong to the pattern, ``position``
        (controls, 3) is where the control points lie, for their order."""
        n, spans = lattices.count, len(lattices.controls)
        start = np.arange(spans + 1) * 16
        meets = csr_matrix((np.ones(spans * 16, dtype=np.int32), lattices.controls.ravel(), start), shape=(spans, n))
        pattern = (meets.T @ meets).tocsr()
        for matrix in couplings:
            other = matrix.tocsr()
            ones = np.ones(other.nnz, dtype=np.int32)
            pattern = pattern + csr_matrix((ones, other.indices, other.indptr), other.shape)
        pattern.sort_indices()
        upper = triu(pattern, format="csr")
        self.count = n
        self.indptr, self.indices = upper.indptr, upper.indices
        self.rows = np.repeat(np.arange(n), np.diff(self.indptr))
        self._keys = self.rows * n + self.indices
        pairs = lattices.controls[:, _PAIR_ROW], lattices.controls[:, _PAIR_COLUMN]
        self._turned = pairs[0] > pairs[1]
        self._span_position = self._position(np.minimum(*pairs), np.maximum(*pairs))
        self.layout = FrontLayout(dissect(pattern, position), self.rows, self.indices)

    @property
    def size(self) -> int:
        """Number of 3 × 3 blocks."""
        return len(self.indices)

    def _position(self, rows: Index, columns: Index) -> Index:
        """Where the blocks (row, column), no row beyond its column, stand in the pattern."""
        return np.searchsorted(self._keys, rows * self.count + columns)

    def from_spans(self, values: Array, spans: Index | slice = slice(None)) -> Array:
        """Sum up symmetric ``values`` of all spans or of the given ones: (spans, 16, 16) to (size,)."""
        return self._summed(values.reshape(-1, 256)[:, 16 * _PAIR_ROW + _PAIR_COLUMN], spans)

    def from_span_blocks(self, matrices: Callable[[slice], Array]) -> Array:
        """Sum up symmetric ``matrices`` (n, 3, 16, 3, 16) of all spans, made for one lot of spans after the other:
        (3, 3, size)."""
        values = np.empty((3, 3, *self._turned.shape))
        for start in range(0, len(self._turned), _LOT):
            lot = slice(start, start + _LOT)
            own = matrices(lot)[:, :, _PAIR_ROW, :, _PAIR_COLUMN].transpose(2, 3, 1, 0)
            values[:, :, lot] = np.where(self._turned[lot], own.swapaxes(0, 1), own)
        result = np.empty((3, 3, self.size))
        for a, b in product(range(3), repeat=2):
            result[a, b] = self._summed(values[a, b])
        return result

    def _summed(self, values: Array, spans: Index | slice = slice(None)) -> Array:
        """Sums of values of the pairs of control points of spans, (spans, 136): (size,)."""
        position = self._span_position[spans].ravel()
        return np.bincount(position, values.ravel(), self.size).astype(float, copy=False)

    def of_spans(self, blocks: Array, spans: Index) -> Array:
        """The blocks between the control points of spans: (n, 16, 16, 3, 3)."""
        own = blocks[:, :, self._span_position[spans]]
        own = np.where(self._turned[spans], own.swapaxes(0, 1), own)
        result = np.empty((own.shape[2], 16, 16, 3, 3))
        result[:, _PAIR_ROW, _PAIR_COLUMN] = own.transpose(2, 3, 0, 1)
        result[:, _PAIR_COLUMN, _PAIR_ROW] = own.transpose(2, 3, 1, 0)
        return result

    def from_scalar(self, matrix: spmatrix) -> Array:
        """Values of a symmetric scalar (controls, controls) matrix on the pattern: (size,)."""
        upper = triu(matrix)
        position = self._position(upper.row.astype(np.intp), upper.col.astype(np.intp))
        return np.bincount(position, upper.data, self.size).astype(float, copy=False)

    def from_vector(self, matrix: bsr_matrix) -> SomeBlocks:
        """The blocks of a symmetric (3 controls, 3 controls) matrix of 3 × 3 blocks."""
        rows = np.repeat(np.arange(self.count), np.diff(matrix.indptr))
        kept = np.flatnonzero(rows <= matrix.indices)
        return SomeBlocks(self._position(rows[kept], matrix.indices[kept]),
                          np.ascontiguousarray(matrix.data[kept].transpose(1, 2, 0)))

    def product(self, blocks: Array) -> Callable[[Array], Array]:
        """The function that gives the matrix times vectors, (3 controls,) or (3 controls, m)."""
        shape = self.count, self.count
        first = self.indptr[:-1]  # of every row: its diagonal
        components = [(a, b, csr_matrix((blocks[a, b], self.indices, self.indptr), shape), blocks[a, b, first])
                      for a, b in product(range(3), repeat=2)]

        def times(vectors: Array) -> Array:
            given = np.ascontiguousarray(vectors.reshape(self.count, 3, -1).transpose(1, 0, 2))
            result = np.zeros_like(given)
            for a, b, upper, diagonal in components:
                result[a] += upper @ given[b]
                result[b] += upper.T @ given[a] - diagonal[:, None] * given[a]
            return result.transpose(1, 0, 2).reshape(vectors.shape)

        return times


def solve_normal_equations(pattern: Pattern, blocks: Array, right: Array, factor: FrontCholesky | None,
                           near: bool) -> tuple[Array, FrontCholesky]:
    """Solve the normal equations; with a factor of a near matrix by conjugate gradients, else (or if slow) anew.

    Parameters
    ----------
    blocks : (3, 3, size) values on the pattern
    right : (controls, 3)
    factor : Cholesky factor of an earlier matrix, or None; its memory is used for a new one
    near : whether that matrix was similar to this one

    Returns
    -------
    solution (controls, 3), and the factor to go on with
    """
    if factor is not None and near:
        solution = _conjugate_gradients(pattern.product(blocks), right.ravel(), factor)
        if solution is not None:
            return solution.reshape(-1, 3), factor
    factor = FrontCholesky(pattern.layout, blocks, factor)
    return factor.solve(right.ravel()).reshape(-1, 3), factor


def _conjugate_gradients(times: Callable[[Array], Array], right: Array, factor: FrontCholesky) -> Array | None:
    """Of the matrix that ``times`` multiplies by, preconditioned by the factor; stopped early on purpose: the next
    Gauss-Newton step corrects what is left."""
    x = np.zeros_like(right)
    residual = right.copy()
    z = factor.solve(residual)
    direction, energy = z, residual @ z
    start = energy
    for _ in range(_CG_STEPS):
        image = times(direction)
        step = energy / (direction @ image)
        x += step * direction
        residual -= step * image
        z = factor.solve(residual)
        new = residual @ z
        if new <= _CG_TOLERANCE**2 * start:
            return x
        direction = z + (new / energy) * direction
        energy = new
    return None
