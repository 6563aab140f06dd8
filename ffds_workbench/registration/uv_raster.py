# SPDX-License-Identifier: LGPL-2.1-or-later
"""A face cut into cells over its (u, v): the frame of the surface in each, and which of them carry material.

Parameters are counted in cells here: cell (i, j) spans [i, i + 1] × [j, j + 1], its centre is (i + ½, j + ½).
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .arrays import Array
from .face_geometry import FaceGeometry
from .splines import SplineSurface, basis_matrix, tensor_product
from .trims import boundary_points, inside_trims

Index = NDArray[np.intp]

_LEAST_CELLS, _LARGEST_CELLS = 16, 256
"""Cells per direction of a face, at least and at the most (unit: time)."""
_LARGEST_TURN = 0.12
"""Largest turn of the normal along a cell in rad (theory: the surface is then quadratic within one, to 4e-5 of its
radius)."""
_AFFINE_TOLERANCE = 1e-6
"""In mm: a surface this near to an affine one is affine (theory: far below any tolerance, above rounding)."""
LARGEST_DEPTH = 3.0
"""Distances from the trims are known up to this, in mm (theory: no margin is larger)."""


@dataclass(frozen=True)
class Raster:
    """Cells of a face. All arrays run over the cells, row by row in u.

    Attributes
    ----------
    shape : (m, n), cells in u and in v
    corner, step : (2,) parameter of the first cell's corner, and size of a cell
    periodic : closed in u, closed in v
    flat : the surface is an affine image of (u, v)
    position, tangent_u, tangent_v, normal : (m·n, 3), at the cell's centre; tangents per cell; the normal points out of
        the material
    principal_1, principal_2 : (m·n, 3) unit tangents along which the surface curves most and least
    curvature : (m·n, 2) along them, in 1/mm, negative where the surface bulges outwards
    area : (m·n,) in mm²
    inside : (m·n,) the cell's centre lies on the trimmed face
    depth : (m·n,) distance of the centre from the nearest trim in mm, at most `LARGEST_DEPTH`, negative off the
        material
    """

    shape: tuple[int, int]
    corner: Array
    step: Array
    periodic: tuple[bool, bool]
    flat: bool
    position: Array
    tangent_u: Array
    tangent_v: Array
    normal: Array
    principal_1: Array
    principal_2: Array
    curvature: Array
    area: Array
    inside: NDArray[np.bool_]
    depth: Array

    @cached_property
    def table(self) -> Array:
        """What the foot points of a cell need, one column per cell, (20, m·n): position, principal directions, normal,
        curvatures, steps in cells per mm along the principal directions (x by 1, x by 2, y by 1, y by 2), the centre's
        x and y."""
        gram = np.stack([dot(self.tangent_u, self.tangent_u), dot(self.tangent_u, self.tangent_v),
                         dot(self.tangent_v, self.tangent_v)])
        determinant = gram[0] * gram[2] - gram[1] ** 2
        dual_x = (gram[2][:, None] * self.tangent_u - gram[1][:, None] * self.tangent_v) / determinant[:, None]
        dual_y = (gram[0][:, None] * self.tangent_v - gram[1][:, None] * self.tangent_u) / determinant[:, None]
        steps = [dot(dual, e) for dual in (dual_x, dual_y) for e in (self.principal_1, self.principal_2)]
        return np.concatenate([self.position.T, self.principal_1.T, self.principal_2.T, self.normal.T,
                               self.curvature.T, np.stack(steps), np.indices(self.shape).reshape(2, -1) + 0.5])

    @cached_property
    def depth_slopes(self) -> tuple[Array, Array]:
        """Derivatives of ``depth`` in u and in v, in mm per cell."""
        return self.gradient(self.depth)

    @cached_property
    def turn(self) -> tuple[float, float]:
        """How far the normal turns from side to side of the face, in u and in v, in rad; at most a full turn."""
        grid = self.normal.reshape(*self.shape, 3)
        steps = [2 * np.arcsin(np.minimum(0.5 * np.linalg.norm(np.diff(grid, axis=k), axis=2), 1)) for k in (0, 1)]
        u, v = (float(np.median(steps[k].sum(axis=k))) for k in (0, 1))
        return min(u, 2 * np.pi), min(v, 2 * np.pi)

    @property
    def u(self) -> Array:
        """Parameters of the cells' centres in u, (m,)."""
        return self.corner[0] + self.step[0] * (np.arange(self.shape[0]) + 0.5)

    @property
    def v(self) -> Array:
        """Parameters of the cells' centres in v, (n,)."""
        return self.corner[1] + self.step[1] * (np.arange(self.shape[1]) + 0.5)

    @property
    def size(self) -> Array:
        """Mean edge length of a cell in u and in v, in mm; (2,)."""
        return np.sqrt([dot(t, t).mean() for t in (self.tangent_u, self.tangent_v)])

    def wrapped(self, x: Array, axis: int) -> Array:
        """Cell coordinates ``x`` (n,) along one axis, brought into [0, m) where the direction is closed."""
        if not self.periodic[axis]:
            return x
        count = self.shape[axis]
        return x - count * np.floor(x * (1 / count))

    def nearest_turn(self, difference: Array, axis: int) -> Array:
        """Each ``difference`` (n,) of cell coordinates along one axis, the short way round where the direction is
        closed."""
        if not self.periodic[axis]:
            return difference
        count = self.shape[axis]
        return difference - count * np.rint(difference * (1 / count))

    def cell(self, x: Array, y: Array) -> Index:
        """The cell of cell coordinates ``x`` and ``y``, (n,) each, −1 outside the parameter range."""
        i, j = (np.floor(self.wrapped(a, k)).astype(np.intp) for k, a in enumerate((x, y)))
        m, n = self.shape
        for a, count, closed in zip((i, j), self.shape, self.periodic, strict=True):
            if closed:
                np.minimum(a, count - 1, out=a)
        outside = (i < 0) | (i >= m) | (j < 0) | (j >= n)
        i *= n
        i += j
        i[outside] = -1
        return i

    def gradient(self, f: Array) -> tuple[Array, Array]:
        """Central differences of ``f``, (m·n,) values per cell; closed directions wrap."""
        grid, result = f.reshape(self.shape), []
        for axis, closed in enumerate(self.periodic):
            if closed:
                result.append(0.5 * (np.roll(grid, -1, axis) - np.roll(grid, 1, axis)).ravel())
            else:
                result.append(np.gradient(grid, axis=axis).ravel())
        return result[0], result[1]


def make_raster(face: FaceGeometry, cells: int = 4096) -> Raster:
    """Cut a face into about ``cells`` cells, nearly square in mm, and more where the surface turns strongly."""
    surface = face.surface
    shape = _shape(surface, cells)
    u0, u1, v0, v1 = surface.range
    corner = np.array([u0, v0])
    step = np.array([(u1 - u0) / shape[0], (v1 - v0) / shape[1]])
    u, v = (corner[k] + step[k] * (np.arange(shape[k]) + 0.5) for k in (0, 1))
    flat = is_affine(surface)
    position, s_u, s_v, s_uu, s_uv, s_vv = frames(surface, u, v)
    normal = np.cross(s_u, s_v)
    area = np.linalg.norm(normal, axis=1)
    normal *= (face.outward / np.maximum(area, np.finfo(float).tiny))[:, None]
    second = (dot(normal, s_uu), dot(normal, s_uv), dot(normal, s_vv))
    principal_1, principal_2, curvature = _principal(s_u, s_v, normal, second)
    if flat:
        curvature = np.zeros_like(curvature)
    inside = inside_trims(face, u, v).ravel()
    tangent_u, tangent_v = s_u * step[0], s_v * step[1]
    edge = np.sqrt(0.5 * (dot(tangent_u, tangent_u) + dot(tangent_v, tangent_v)).mean())
    trims = boundary_points(face, 0.5 * float(edge))
    depth = np.full(len(position), LARGEST_DEPTH)
    if len(trims):
        depth = np.minimum(cKDTree(trims).query(position, distance_upper_bound=LARGEST_DEPTH)[0], LARGEST_DEPTH)
    depth = np.where(inside, depth, -depth)
    return Raster(shape, corner, step, (surface.periodic_u, surface.periodic_v), flat, position, tangent_u, tangent_v,
                  normal, principal_1, principal_2, curvature, area * step[0] * step[1], inside, depth)


def _principal(s_u: Array, s_v: Array, normal: Array, second: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
    """Principal directions and curvatures from S_u, S_v, n and (L, M, N)."""
    length = np.sqrt(dot(s_u, s_u))
    e1 = s_u / length[:, None]
    e2 = np.cross(normal, e1)
    p, q = dot(s_v, e1), dot(s_v, e2)
    el, em, en = second
    b11 = el / length**2
    b12 = (em / length - b11 * p) / q
    b22 = (en - 2 * p * q * b12 - p * p * b11) / (q * q)
    angle = 0.5 * np.arctan2(2 * b12, b11 - b22)
    c, s = np.cos(angle), np.sin(angle)
    mixed = 2 * c * s * b12
    curvature = np.stack([c * c * b11 + mixed + s * s * b22, s * s * b11 - mixed + c * c * b22], axis=1)
    return c[:, None] * e1 + s[:, None] * e2, c[:, None] * e2 - s[:, None] * e1, curvature


_ORDERS = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))


def frames(surface: SplineSurface, u: Array, v: Array, order: int = 2) -> list[Array]:
    """S, S_u, S_v of a ``surface``, and for ``order`` 2 also S_uu, S_uv, S_vv, on the grid u × v, each
    (len(u)·len(v), 3)."""
    bases_u = [basis_matrix(surface.knots_u, u, surface.degree_u, k) for k in range(order + 1)]
    bases_v = [basis_matrix(surface.knots_v, v, surface.degree_v, k) for k in range(order + 1)]
    orders = [(a, b) for a, b in _ORDERS if a + b <= order]
    return [tensor_product(bases_u[a], bases_v[b], surface.control_points).reshape(-1, 3) for a, b in orders]


def is_affine(surface: SplineSurface) -> bool:
    """True if S(u, v) of the ``surface`` is an affine function of (u, v) to 1e-6 mm: a plane in its natural
    parameters."""
    u0, u1, v0, v1 = surface.range
    grid = surface.on_grid(np.linspace(u0, u1, 9), np.linspace(v0, v1, 9))
    a, b = np.linspace(0, 1, 9)[:, None, None], np.linspace(0, 1, 9)[None, :, None]
    affine = grid[0, 0] + a * (grid[-1, 0] - grid[0, 0]) + b * (grid[0, -1] - grid[0, 0])
    return bool(np.abs(grid - affine).max() < _AFFINE_TOLERANCE)


def dot(a: Array, b: Array) -> Array:
    """Row-wise scalar products of ``a`` (n, 3) and ``b`` (n, 3): (n,)."""
    return np.einsum("ij,ij->i", a, b)


def _shape(surface: SplineSurface, cells: int) -> tuple[int, int]:
    u0, u1, v0, v1 = surface.range
    u, v = np.linspace(u0, u1, 34), np.linspace(v0, v1, 34)
    points, s_u, s_v = (f.reshape(34, 34, 3) for f in frames(surface, u, v, 1))
    normal = np.cross(s_u, s_v)[1:-1, 1:-1]
    normal /= np.maximum(np.linalg.norm(normal, axis=2, keepdims=True), np.finfo(float).tiny)
    lengths = [np.linalg.norm(np.diff(points, axis=k), axis=2).sum(axis=k).mean() for k in (0, 1)]
    shape = []
    for axis in (0, 1):
        turn = np.linalg.norm(np.diff(normal, axis=axis), axis=2).sum(axis=axis).max() * 33 / 31
        count = np.sqrt(cells * lengths[axis] / max(lengths[1 - axis], 1e-3 * lengths[axis]))
        shape.append(int(np.clip(max(round(count), turn / _LARGEST_TURN), _LEAST_CELLS, _LARGEST_CELLS)))
    return shape[0], shape[1]
