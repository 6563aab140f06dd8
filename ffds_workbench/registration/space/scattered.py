# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fits a field in space to vectors at scattered points, coarse first: every level takes on what is left of them.

Multilevel B-splines (Lee, Wolberg, Shin, IEEE Transactions on Visualization and Computer Graphics 3, 1997), but each
level by least squares. What one level leaves falls with the fourth power of its cells, so that few levels do; all of
them are one lattice in the end. scipy's ``RBFInterpolator`` either solves for all points at once, or takes the nearest
ones of each place and is then no continuous field, which no surface can be fitted to.
"""
from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import lsmr
from scipy.spatial import cKDTree

from ..arrays import Array
from .space_lattice import SpaceField, lattice_over

_FIRST_CELLS = 4
"""Cells along the longest side of the box on the first level (unit: a bend and a twist are told by so few)."""
_MOST_CELLS = 160
"""Cells along the longest side (unit: finer detail than a hundredth of the part is no deformation of it)."""
_MOST_CONTROLS = 1_500_000
"""Control points of the finest lattice (unit: memory, 36 MB)."""
_CELLS_PER_SPACING = 1.2
"""Cells are no smaller than the spacing of the points over this (unit: between the points they would tell
nothing)."""
_RIDGE = 0.03
"""Over the usual column: what the points do not tell stays near nothing (unit: far less than a point tells)."""
_RIDGE_DIRECT = 1e-4
"""The same where a level is solved directly (unit: what rounding leaves of the squares)."""
_MOST_DIRECT = 2500
"""Control points up to which a level is solved directly (unit: time, a second)."""
_SOLVER_STEPS = 60
"""Steps of the solution of a finer level (unit: time; the next one takes on what is left)."""
_FLAT = 1e-9
"""Singular values of the places, over the largest, that count as none (unit: what rounding leaves)."""
_NOISE_REACHED = 2.366
"""Median of the squares of what is left over the variances at which noise alone is left (theory: chi-square of three
degrees of freedom); a few wild vectors do not shift it."""


def fit(points: Array, vectors: Array, tolerance: float, sigma: Array | None = None) -> SpaceField:
    """The coarsest field that the vectors ask for.

    Parameters
    ----------
    points, vectors : (n, 3) in mm
    tolerance : in mm, what a level may leave of every vector
    sigma : (n,) standard deviations of the vectors in mm, where they have any; what noise explains is no detail
    """
    known = np.zeros(len(points)) if sigma is None else np.asarray(sigma)
    allowed = np.maximum(known, tolerance)
    weight = allowed.min() / allowed
    low, high = points.min(axis=0), points.max(axis=0)
    longest = max(float((high - low).max()), 1e-9)
    least = max(_spacing(points) / _CELLS_PER_SPACING, longest / _MOST_CELLS)
    gradient, value = _linear(points - low, vectors, weight)
    field = lattice_over(low, high, longest / _FIRST_CELLS, gradient, value)
    noisy = bool(known.any())
    while True:
        left = vectors - field(points)
        if _enough(left, allowed, noisy):
            return field
        field = field.plus(_level(field.rows(points), left, weight))
        if 0.5 * field.cell < least or 8 * field.control_points[..., 0].size > _MOST_CONTROLS:
            return field
        field = field.halved()


def _enough(left: Array, allowed: Array, noisy: bool) -> bool:
    """Whether what is ``left`` (n, 3) needs no further level."""
    over = np.linalg.norm(left, axis=1) / allowed
    return bool(np.median(over**2) <= _NOISE_REACHED) if noisy else bool(over.max() <= 1.0)


def _spacing(points: Array) -> float:
    """Usual distance of neighbouring points in mm."""
    distinct = np.unique(points.round(9), axis=0)
    if len(distinct) < 2:
        return 1.0
    return float(np.median(cKDTree(distinct).query(distinct, 2)[0][:, 1]))


def _linear(places: Array, vectors: Array, weight: Array) -> tuple[Array, Array]:
    """Gradient (3, 3) and value at the origin (3,) of the linear field that is nearest to the vectors."""
    middle = np.average(places, axis=0, weights=weight)
    mean = np.average(vectors, axis=0, weights=weight)
    rows, right = weight[:, None] * (places - middle), weight[:, None] * (vectors - mean)
    gradient = np.linalg.lstsq(rows, right, rcond=_FLAT)[0].T
    return gradient, mean - gradient @ middle


def _level(rows: csr_matrix, left: Array, weight: Array) -> Array:
    """Control points (controls, 3) that take on what is left (n, 3) of the vectors."""
    touched = np.unique(rows.indices)
    local = csr_matrix((rows.data, np.searchsorted(touched, rows.indices), rows.indptr), (rows.shape[0], len(touched)))
    local = local.multiply(weight[:, None]).tocsr()
    norms = np.sqrt(np.asarray(local.multiply(local).sum(axis=0)).ravel())
    usual, right = float(np.median(norms)), weight[:, None] * left
    result = np.zeros((rows.shape[1], 3))
    if len(touched) <= _MOST_DIRECT:
        normal = (local.T @ local).toarray()
        normal[np.diag_indices(len(touched))] += (_RIDGE_DIRECT * usual) ** 2
        result[touched] = cho_solve(cho_factor(normal, lower=True, overwrite_a=True), local.T @ right)
        return result
    for k in range(3):
        result[touched, k] = lsmr(local, right[:, k], damp=_RIDGE * usual, maxiter=_SOLVER_STEPS)[0]
    return result
