# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sparsity pattern of the normal equations, sums over spans on it, and their solution with a reused factor."""
from __future__ import annotations

import numpy as np
from scipy.sparse import bsr_matrix, csr_matrix, spmatrix

from ...arrays import Array, Index
from ..surfaces import Lattices
from .cholesky import FrontCholesky, FrontLayout
from .dissection import dissect

_CG_STEPS = 12
"""Steps after which a new factor is cheaper: it costs as much as some 30 of them, and the next steps need it too."""
_CG_TOLERANCE = 3e-3


class Pattern:
    """Which control points meet in a row, found once per part; values are 3 × 3 blocks in the pattern's order.

    Parameters of the methods
    -------------------------
    blocks : (size, 3, 3) values in the pattern's order
    columns : (n,) control points
    rows : (n,) control points
    """

    def __init__(self, lattices: Lattices, couplings: tuple[spmatrix, ...], position: Array) -> None:
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
        self.count = n
        self.indptr, self.indices = pattern.indptr, pattern.indices
        self.rows = np.repeat(np.arange(n), np.diff(self.indptr))
        self._keys = self.rows * n + self.indices
        controls = lattices.controls
        self.span_position = self.position(np.repeat(controls, 16, axis=1).ravel(), np.tile(controls, 16).ravel())
        self.layout = FrontLayout(dissect(pattern, position), self.rows, self.indices)

    @property
    def size(self) -> int:
        """Number of 3 × 3 blocks."""
        return len(self.indices)

    def position(self, rows: Index, columns: Index) -> Index:
        """Where the blocks (row, column) stand in the pattern."""
        return np.searchsorted(self._keys, rows * self.count + columns)

    def between(self, spans: Index | slice) -> Index:
        """Where the blocks of the control points of spans stand in the pattern: (n, 256)."""
        return self.span_position.reshape(-1, 256)[spans]

    def from_spans(self, blocks: Array, spans: Index | slice = slice(None)) -> Array:
        """Sum up symmetric 16 × 16 blocks of all spans or of the given ones: (spans, 16, 16) to (size,)."""
        position = self.between(spans).ravel()
        return np.bincount(position, weights=blocks.ravel(), minlength=self.size).astype(float, copy=False)

    def from_scalar(self, matrix: spmatrix) -> Array:
        """Values of a scalar (controls, controls) matrix on the pattern: (size,)."""
        coo = matrix.tocoo()
        position = self.position(coo.row.astype(np.intp), coo.col.astype(np.intp))
        return np.bincount(position, weights=coo.data, minlength=self.size).astype(float)

    def from_vector(self, matrix: bsr_matrix) -> Array:
        """Values of a (3 controls, 3 controls) matrix of 3 × 3 blocks on the pattern: (size, 3, 3)."""
        blocks = np.zeros((self.size, 3, 3))
        blocks[self.places(matrix)] = matrix.data
        return blocks

    def places(self, matrix: bsr_matrix) -> Index:
        """Where the blocks of a (3 controls, 3 controls) matrix stand in the pattern."""
        return self.position(np.repeat(np.arange(self.count), np.diff(matrix.indptr)), matrix.indices)

    def matrix(self, blocks: Array) -> bsr_matrix:
        """The pattern's blocks as a scipy matrix of 3 × 3 blocks."""
        return bsr_matrix((blocks, self.indices, self.indptr), shape=(3 * self.count, 3 * self.count))


def solve_normal_equations(pattern: Pattern, blocks: Array, right: Array, factor: FrontCholesky | None,
                           near: bool) -> tuple[Array, FrontCholesky]:
    """Solve the normal equations; with a factor of a near matrix by conjugate gradients, else (or if slow) anew.

    Parameters
    ----------
    blocks : (size, 3, 3) values on the pattern
    right : (controls, 3)
    factor : Cholesky factor of an earlier matrix, or None; its memory is used for a new one
    near : whether that matrix was near to this one

    Returns
    -------
    solution (controls, 3), and the factor to go on with
    """
    if factor is not None and near:
        solution = _conjugate_gradients(pattern.matrix(blocks), right.ravel(), factor)
        if solution is not None:
            return solution.reshape(-1, 3), factor
    factor = FrontCholesky(pattern.layout, blocks, factor)
    return factor.solve(right.ravel()).reshape(-1, 3), factor


def _conjugate_gradients(matrix: bsr_matrix, right: Array, factor: FrontCholesky) -> Array | None:
    """Preconditioned by the factor, stopped early on purpose: the next Gauss-Newton step corrects what is left."""
    x = np.zeros_like(right)
    residual = right.copy()
    z = factor.solve(residual)
    direction, energy = z, residual @ z
    start = energy
    for _ in range(_CG_STEPS):
        product = matrix @ direction
        step = energy / (direction @ product)
        x += step * direction
        residual -= step * product
        z = factor.solve(residual)
        new = residual @ z
        if new <= _CG_TOLERANCE**2 * start:
            return x
        direction = z + (new / energy) * direction
        energy = new
    return None
