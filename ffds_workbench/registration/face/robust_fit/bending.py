# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bending energy of a displacement field on a surface: the penalty of a deformation where the scan says nothing.

On a plane it is ∫ d_uu² + 2 d_uv² + d_vv² over the physical area. On a curved surface the second derivatives are
covariant, and the rotation of the normal is removed, so that moving the face as a rigid body costs nothing.
"""
from __future__ import annotations

import numpy as np

from ...arrays import Array
from ...splines import DEGREE, SplineSurface, basis_matrix
from ...uv_raster import dot, frames
from ..control_lattice import ControlLattice
from .normal_equations import NormalMatrix, grid_products, offset_products

_ORDERS = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
_LEAST_NODES = 16
"""Gauss points per direction of a face at least (theory: two per span integrate a cubic's bending; more where spans are
few and the surface is curved)."""


def bending_and_gauge(surface: SplineSurface, lattice: ControlLattice, layout: NormalMatrix) -> tuple[Array, Array]:
    """Banded matrices of the bending energy and of ∫ |tangential part of d|² + 1e-6 |d|².

    Parameters
    ----------
    surface : the nominal surface
    lattice, layout : the control lattice, with one component (displacement along the constant normal of a plane) or
        three (x, y, z)

    Notes
    -----
    M_ij = d_,ij − Γ^k_ij d_,k + b_ij S^k (n · d_,k), with S^k the dual tangents: for an infinitesimal rigid motion the
    covariant second derivative is b_ij δn, and δn = −S^k (n · d_,k). The energy is ∫ g^ik g^jl M_ij · M_kl dA.
    """
    u, weight_u = _nodes(lattice.knots_u)
    v, weight_v = _nodes(lattice.knots_v)
    components = layout.unknown.shape[2]
    shape = (len(u), len(v))
    _, s_u, s_v, s_uu, s_uv, s_vv = frames(surface, u, v)
    normal = np.cross(s_u, s_v)
    area = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(area, np.finfo(float).tiny)[:, None]
    cell = area * np.outer(weight_u, weight_v).ravel()
    form, curl, dual, inverse = _tensors(s_u, s_v, s_uu, s_uv, s_vv, normal)
    bases_u = [basis_matrix(lattice.knots_u, u, derivative=k) for k in range(3)]
    bases_v = [basis_matrix(lattice.knots_v, v, derivative=k) for k in range(3)]
    energy = np.zeros((layout.band + 1, layout.size))
    for p, (pu, pv) in enumerate(_ORDERS):
        for q, (qu, qv) in enumerate(_ORDERS[: p + 1]):
            grids = _density(p, q, components, form, curl, dual, inverse, normal) * cell
            products = grid_products(grids.reshape(-1, *shape), offset_products(bases_u[pu], bases_u[qu]),
                                     offset_products(bases_v[pv], bases_v[qv]))
            if len(products) < components**2:
                products = np.eye(components).reshape(-1, 1, 1) * products
            energy = energy + (layout.symmetric(products) if p == q else layout.symmetrised(products))
    gauge = np.eye(components)[:, :, None] * (cell * (1 + 1e-6))
    if components == 3:
        gauge = gauge - normal.T[:, None] * normal.T[None] * cell
    products = grid_products(gauge.reshape(-1, *shape), offset_products(bases_u[0], bases_u[0]),
                             offset_products(bases_v[0], bases_v[0]))
    return energy, layout.symmetric(products)


def curvature_variation(surface: SplineSurface, lattice: ControlLattice, layout: NormalMatrix) -> Array:
    """Banded matrix of ∫ |∇³d|² over an affine surface, for a displacement d along its normal.

    What bends evenly costs nothing (Moreton and Séquin, Functional optimization for fair surface design, 1992).

    Parameters
    ----------
    surface : affine in (u, v)
    lattice, layout : the control lattice, with one component
    """
    u, weight_u = _nodes(lattice.knots_u)
    v, weight_v = _nodes(lattice.knots_v)
    _, s_u, s_v, *_ = frames(surface, u[:1], v[:1])
    along, across = np.linalg.inv(np.linalg.qr(np.concatenate([s_u, s_v]).T)[1]).T  # unit steps, in u and v
    # The four coefficients of each product stay four: a polynomial's leading zeros would be dropped.
    cubics = [np.convolve(np.convolve(a, b), c) for a, b, c in
              ((along, along, along), (along, along, across), (along, across, across), (across, across, across))]
    form = np.array(cubics) * np.sqrt([1, 3, 3, 1])[:, None]
    product = form.T @ form * np.linalg.norm(np.cross(s_u, s_v))
    cell = np.outer(weight_u, weight_v)[None]
    bases_u = [basis_matrix(lattice.knots_u, u, derivative=3 - k) for k in range(4)]
    bases_v = [basis_matrix(lattice.knots_v, v, derivative=k) for k in range(4)]
    energy = np.zeros((layout.band + 1, layout.size))
    for p in range(4):
        for q in range(p + 1):
            products = grid_products(product[p, q] * cell, offset_products(bases_u[p], bases_u[q]),
                                     offset_products(bases_v[p], bases_v[q]))
            energy += layout.symmetric(products) if p == q else layout.symmetrised(products)
    return energy


def _density(p: int, q: int, components: int, form: Array, curl: Array, dual: Array, inverse: Array,
             normal: Array) -> Array:
    """Coefficient of (d_p)_a (d_q)_b in the energy density; p, q number the orders.

    (components, components, nodes), or (1, nodes) if it is the same for a = b = x, y, z and none else.
    """
    isotropic = (form[p] * form[q]).sum(axis=0)[None]
    if components == 1 or (p >= 2 and q >= 2):
        return np.asarray(isotropic)
    density = np.eye(components)[:, :, None] * isotropic
    if q < 2:
        density = density + curl[p] * dual[q].T[:, None] * normal.T[None]
    if p < 2:
        density = density + curl[q] * normal.T[:, None] * dual[p].T[None]
    if p < 2 and q < 2:
        density = density + inverse[p][q] * normal.T[:, None] * normal.T[None]
    return density


def _tensors(s_u: Array, s_v: Array, s_uu: Array, s_uv: Array, s_vv: Array, normal: Array
             ) -> tuple[Array, Array, Array, Array]:
    """Pieces of the energy density in an orthonormal tangent frame.

    Returns
    -------
    form : (5, 3, nodes), M₁₁, √2·M₁₂, M₂₂ as linear forms in d_u, d_v, d_uu, d_uv, d_vv (without the normal's turning)
    curl : (5, nodes), their contraction with b
    dual : (2, nodes, 3), S^u and S^v
    inverse : (2, 2, nodes), |b|² g^ij
    """
    e, f, g = dot(s_u, s_u), dot(s_u, s_v), dot(s_v, s_v)
    determinant = np.maximum(e * g - f * f, np.finfo(float).tiny)
    dual = np.stack([g[:, None] * s_u - f[:, None] * s_v, e[:, None] * s_v - f[:, None] * s_u]) / determinant[:, None]
    length = np.sqrt(e)
    height = np.sqrt(determinant) / length
    t1 = np.stack([1 / length, np.zeros_like(length)])
    t2 = np.stack([-f / (e * height), 1 / height])
    pairs = ((t1, t1, 1.0), (t1, t2, np.sqrt(2)), (t2, t2, 1.0))
    form, b = np.zeros((5, 3, len(e))), np.zeros((3, len(e)))
    for k, (a, c, scale) in enumerate(pairs):
        uu, uv, vv = scale * a[0] * c[0], scale * (a[0] * c[1] + a[1] * c[0]), scale * a[1] * c[1]
        second = uu[:, None] * s_uu + uv[:, None] * s_uv + vv[:, None] * s_vv
        form[:, k] = -dot(second, dual[0]), -dot(second, dual[1]), uu, uv, vv
        b[k] = dot(second, normal)
    curl = np.einsum("kn,pkn->pn", b, form)
    metric = np.array([[g, -f], [-f, e]]) / determinant
    return form, curl, dual, (b * b).sum(axis=0) * metric


def _nodes(knots: Array) -> tuple[Array, Array]:
    """Gauss points and weights, two per span; spans are split where there are few."""
    breaks = np.unique(knots[DEGREE : len(knots) - DEGREE])
    pieces = int(np.ceil(0.5 * _LEAST_NODES / (len(breaks) - 1)))
    breaks = np.interp(np.arange((len(breaks) - 1) * pieces + 1) / pieces, np.arange(len(breaks)), breaks)
    half = 0.5 * np.diff(breaks)
    middle = 0.5 * (breaks[:-1] + breaks[1:])
    offset = half / np.sqrt(3)
    return np.stack([middle - offset, middle + offset], axis=1).ravel(), np.repeat(half, 2)
