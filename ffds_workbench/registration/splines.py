# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tensor-product B-splines over a face's own (u, v): surfaces, control lattices and displacement fields.

Everything is non-rational. A periodic direction is stored *unrolled*: its knot vector continues periodically on both
sides and its first ``degree`` rows of control points are repeated at the end, so that scipy evaluates it as any other
spline and only the parameter has to be wrapped.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from .arrays import Array

DEGREE = 3
"""Of all control lattices (theory: the paper's cubics)."""
_DENSE_ENTRIES = 40000
"""Entries from which a basis matrix is made by way of a sparse one (unit: time)."""
_CHUNK = 4096
"""Parameters that are evaluated together (unit: memory of a processor's cache)."""


def cubic(x: Array, derivative: int = 0) -> Array:
    """The four uniform cubic B-splines on a span of unit length, at x in [0, 1]: (n,) to (n, 4).

    Derivatives are with respect to x. NURBS Book, section 2.4, on equidistant knots.

    Parameters
    ----------
    derivative : order of the derivative
    """
    y = 1.0 - x
    if derivative == 0:
        return np.stack([y**3, 3 * x**3 - 6 * x**2 + 4, 3 * y**3 - 6 * y**2 + 4, x**3], axis=-1) / 6
    if derivative == 1:
        return np.stack([-(y**2), 3 * x**2 - 4 * x, 4 * y - 3 * y**2, x**2], axis=-1) / 2
    return np.stack([y, 3 * x - 2, 3 * y - 2, x], axis=-1)


def clamped_knots(start: float, end: float, count: int, degree: int = DEGREE) -> Array:
    """Uniform clamped knot vector of ``count`` control points over [start, end]; shape (count + degree + 1,).

    Raises
    ------
    ValueError : too few control points for the degree
    """
    if count <= degree:
        raise ValueError(f"a spline of degree {degree} needs at least {degree + 1} control points, not {count}")
    inner = np.linspace(start, end, count - degree + 1)
    return np.concatenate([np.full(degree, start), inner, np.full(degree, end)])


def greville(knots: Array, degree: int = DEGREE) -> Array:
    """Greville abscissae, the means of ``degree`` successive inner knots (NURBS Book, eq. 9.8 with averages)."""
    count = len(knots) - degree - 1
    return np.asarray(sum(knots[first : first + count] for first in range(1, degree + 1)) / degree)


def basis_matrix(knots: Array, x: Array, degree: int = DEGREE, derivative: int = 0) -> Array:
    """Dense matrix of the basis functions' values, or their ``derivative``: (n, k − degree − 1).

    ``knots`` (k,) and ``x`` (n,) are in one unit.

    Meant for grids, where it is small. Scattered points go through `basis_rows`.
    """
    count = len(knots) - degree - 1
    if derivative == 0 and count * len(x) > _DENSE_ENTRIES:
        return np.asarray(BSpline.design_matrix(x, knots, degree).toarray())
    return np.asarray(BSpline.construct_fast(knots, np.eye(count), degree)(x, nu=derivative))


def basis_rows(knots: Array, x: Array, degree: int = DEGREE) -> tuple[NDArray[np.intp], Array]:
    """The ``degree + 1`` basis functions on ``knots`` (k,) that do not vanish at each of ``x`` (n,).

    Returns
    -------
    first : (n,) index of the first of them
    values : (n, degree + 1)

    Notes
    -----
    The NURBS Book, algorithm A2.2, for all x at once: scipy's sparse matrix of them takes several times as long to make
    where there are few.
    """
    span = np.searchsorted(knots, x, side="right") - 1
    span = np.minimum(np.maximum(span, degree), len(knots) - degree - 2)
    values = np.ones((degree + 1, len(x)))
    left, right = [], []
    for order in range(degree):
        left.append(x - knots[span - order])
        right.append(knots[span + order + 1] - x)
        carried = 0.0
        for k in range(order + 1):
            share = values[k] / (right[k] + left[order - k])
            values[k] = carried + right[k] * share
            carried = left[order - k] * share
        values[order + 1] = carried
    return span - degree, values.T


def tensor_product(basis_u: Array, basis_v: Array, control_points: Array) -> Array:
    """Σ_ij N_i(u) N_j(v) P_ij on a grid, from ``basis_u`` (m, nu), ``basis_v`` (n, nv) and
    ``control_points`` (nu, nv, dim): (m, n, dim)."""
    nu, nv, dim = control_points.shape
    along_u = (basis_u @ control_points.reshape(nu, nv * dim)).reshape(len(basis_u), nv, dim)
    return np.asarray(basis_v @ along_u)


@dataclass(frozen=True)
class SplineSurface:
    """A tensor-product B-spline over (u, v): a surface in mm, or a displacement field on it.

    Attributes
    ----------
    knots_u, knots_v : flat knot vectors, (nu + degree_u + 1,) and (nv + degree_v + 1,)
    control_points : (nu, nv, dim), in mm
    periodic_u, periodic_v : the direction is unrolled (see the module text) and the parameter is wrapped
    """

    knots_u: Array
    knots_v: Array
    control_points: Array
    degree_u: int = DEGREE
    degree_v: int = DEGREE
    periodic_u: bool = False
    periodic_v: bool = False

    @property
    def range(self) -> tuple[float, float, float, float]:
        """(u0, u1, v0, v1), the parameter box."""
        ku, kv, pu, pv = self.knots_u, self.knots_v, self.degree_u, self.degree_v
        return float(ku[pu]), float(ku[-pu - 1]), float(kv[pv]), float(kv[-pv - 1])

    def inside(self, uv: Array) -> Array:
        """Parameters ``uv`` (n, 2) brought into the range: wrapped where periodic, clipped elsewhere."""
        u0, u1, v0, v1 = self.range
        result = np.empty((len(uv), 2))
        for axis, low, high, periodic in ((0, u0, u1, self.periodic_u), (1, v0, v1, self.periodic_v)):
            x = uv[:, axis]
            result[:, axis] = (low + np.mod(x - low, high - low) if periodic
                               else np.minimum(np.maximum(x, low), high))  # np.clip takes several times as long
        return result

    def __call__(self, uv: Array) -> Array:
        """Values at scattered parameters ``uv`` (n, 2): (n, dim). Parameters outside are wrapped or clipped."""
        uv = self.inside(np.asarray(uv, dtype=float))
        first_u, bu = basis_rows(self.knots_u, uv[:, 0], self.degree_u)
        first_v, bv = basis_rows(self.knots_v, uv[:, 1], self.degree_v)
        _, nv, dim = self.control_points.shape
        place = ((first_u[:, None] + np.arange(self.degree_u + 1)) * nv + first_v[:, None])[:, :, None]
        place = place + np.arange(self.degree_v + 1)
        points, weight = self.control_points.reshape(-1, dim), bu[:, :, None] * bv[:, None, :]
        result = np.empty((len(uv), dim))
        for start in range(0, len(uv), _CHUNK):
            part = slice(start, start + _CHUNK)
            result[part] = np.einsum("nab,nabd->nd", weight[part], points[place[part]])
        return result

    def on_grid(self, u: Array, v: Array) -> Array:
        """Values on the grid u × v (inside the range): (len(u), len(v), dim)."""
        bu = basis_matrix(self.knots_u, u, self.degree_u)
        bv = basis_matrix(self.knots_v, v, self.degree_v)
        return tensor_product(bu, bv, self.control_points)

    def jet_on_grid(self, u: Array, v: Array, orders: Sequence[tuple[int, int]]) -> Array:
        """Partial derivatives of ``orders`` in u and v on the grid u × v: (len(u), len(v), len(orders), dim)."""
        most_u, most_v = np.max(orders, axis=0)
        bu = [basis_matrix(self.knots_u, u, self.degree_u, order) for order in range(most_u + 1)]
        bv = [basis_matrix(self.knots_v, v, self.degree_v, order) for order in range(most_v + 1)]
        return np.stack([tensor_product(bu[du], bv[dv], self.control_points) for du, dv in orders], axis=2)

    def derivative(self, du: int, dv: int) -> SplineSurface:
        """The partial derivative, ``du`` times by u and ``dv`` times by v, itself a B-spline of lower degree (NURBS
        Book, eq. 3.24)."""
        surface = self
        for _ in range(du):
            points, knots = _differentiate(surface.control_points, surface.knots_u, surface.degree_u)
            surface = SplineSurface(knots, surface.knots_v, points, surface.degree_u - 1, surface.degree_v,
                                    surface.periodic_u, surface.periodic_v)
        for _ in range(dv):
            points, knots = _differentiate(surface.control_points.swapaxes(0, 1), surface.knots_v, surface.degree_v)
            surface = SplineSurface(surface.knots_u, knots, points.swapaxes(0, 1), surface.degree_u,
                                    surface.degree_v - 1, surface.periodic_u, surface.periodic_v)
        return surface


def _differentiate(points: Array, knots: Array, degree: int) -> tuple[Array, Array]:
    span = knots[degree + 1 : -1] - knots[1 : -degree - 1]
    scale = np.divide(degree, span, out=np.zeros_like(span), where=span > 0)
    return np.diff(points, axis=0) * scale.reshape((-1,) + (1,) * (points.ndim - 1)), knots[1:-1]
