# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bending, and stretching of the mid surface, integrated at the Gauss points of every span.

Indices i, j run over the orthonormal frame e₁, e₂ of the nominal surface and a comma-free ``;`` is its covariant
derivative. The rows of a symmetric tensor are 11, √2·12, 22, so that sums of squares are its norm.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...face_geometry import FaceGeometry
from ..surfaces import Lattices, SpanGrid, covered_shares, make_span_grid, normals

_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(3)
"""Nodes on [−1, 1] and their weights (theory: three integrate the fifth degree exactly)."""
_GAUSS_PLACES = (_GAUSS_NODES + 1) / 2
"""The same nodes on [0, 1] (theory)."""
_GAUSS_BOUNDS = np.concatenate([[0.0], np.cumsum(0.5 * _GAUSS_WEIGHTS)])
"""Bounds of the boxes of a span that the Gauss places stand for (theory: as wide as their weights)."""
_TENSOR_PAIRS = ((0, 0), (0, 1), (1, 1))
COMPONENTS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
"""Components of a symmetric matrix of x, y and z."""
_TENSOR_NORM = np.array([1.0, np.sqrt(2.0), 1.0])
"""Factors of the components 11, 12, 22 of a symmetric tensor in its norm (theory)."""
SLIDING = 0.3
"""Weight of bending within the surface, which is none of the shape, over that of bending across it (calibrated: by
hand, on the families of ``./ffds benchmark accuracy``)."""
_OUTSIDE_WEIGHT = 1e-3
"""Weight of the integral outside the trims, where it only has to keep the lattice smooth (unit: so little that no shape
feels it)."""


@dataclass(frozen=True)
class Stiffness:
    """Constant parts of bending and strain at the Gauss places.

    Attributes
    ----------
    places : the Gauss places
    area : (spans, k) integration weights in mm²: what the trims leave of the boxes that the places stand for
    weight : (spans, k) the same with a little outside them
    stretched : (spans, k) ``weight`` over the square of the solid's size
    slope : (spans, k, 2, 16) rows that give d_;i
    hessian : (spans, k, 3, 16) rows that give d_;ij
    curvature : (spans, k, 3) second fundamental form of the nominal surface, for the outward normal
    normal : (spans, k, 3) nominal normal
    tangent : (spans, k, 2, 3) e₁, e₂

    Parameters of the methods
    -------------------------
    control_points : (controls, 3) of the displacement in mm
    lattices : of all faces
    thickness : (spans,) of the sheet in mm, 0 where there is none
    """

    places: SpanGrid
    area: Array
    weight: Array
    stretched: Array
    slope: Array
    hessian: Array
    curvature: Array
    normal: Array
    tangent: Array

    def bending_blocks(self) -> tuple[Array, Array]:
        """∫ d_;ij d_;ij as one block per span: of all components (spans, 16, 16), the same for x, y and z, and of those
        along the nominal normals (spans, 6, 16, 16), for each of `COMPONENTS`."""
        rows = self.hessian.reshape(len(self.hessian), -1, 16)
        weight = np.repeat(self.weight, 3, axis=1)[:, :, None]
        normal = np.repeat(self.normal, 3, axis=1)
        along = [np.matmul(rows.swapaxes(1, 2), weight * (normal[:, :, a] * normal[:, :, b])[:, :, None] * rows)
                 for a, b in COMPONENTS]
        return np.matmul(rows.swapaxes(1, 2), weight * rows), np.stack(along, axis=1)

    def bending_load(self, control_points: Array, lattices: Lattices, normal: Array, bent: Array, sliding: float
                     ) -> Array:
        """Gradient of bending towards the rotated nominal curvature b_ij (n − n₀) + c_ij n: (spans, 16, 3).

        ``normal`` is the current n, (spans, k, 3); ``bent`` the change of curvature c that costs nothing, (spans, 3). A
        rigid rotation has d_;ij = b_ij (n − n₀) and costs nothing either. ``sliding`` is the trust in `SLIDING`.
        """
        target = self.curvature[..., None] * (normal - self.normal)[:, :, None, :]
        target += bent[:, None, :, None] * normal[:, :, None, :]
        target -= np.matmul(self.hessian, control_points[lattices.controls][:, None])
        across = np.einsum("skpx,skx->skp", target, self.normal)
        within = SLIDING * sliding
        target = within * target + (1 - within) * across[..., None] * self.normal[:, :, None, :]
        target *= self.weight[:, :, None, None]
        rows = self.hessian.reshape(len(self.hessian), -1, 16)
        return np.matmul(rows.swapaxes(1, 2), target.reshape(len(rows), -1, 3))

    def sliding(self, lattices: Lattices, control_points: Array, normal: Array) -> float:
        """∫ |d_;ij − b_ij (n − n₀)|² within the nominal surface times `SLIDING`, in 1/mm² · mm²."""
        change = np.matmul(self.hessian, control_points[lattices.controls][:, None])
        change -= self.curvature[..., None] * (normal - self.normal)[:, :, None, :]
        across = np.einsum("skpx,skx->skp", change, self.normal)
        return SLIDING * float(self.weight.ravel() @ ((change**2).sum(axis=(2, 3)) - (across**2).sum(axis=2)).ravel())

    def curvature_change(self, lattices: Lattices, control_points: Array, normal: Array) -> Array:
        """Change of the second fundamental form at the Gauss places, 11, √2·12, 22: (spans, k, 3)."""
        change = np.matmul(self.hessian, control_points[lattices.controls][:, None])
        change -= self.curvature[..., None] * (normal - self.normal)[:, :, None, :]
        return np.einsum("skpx,skx->skp", change, normal)

    def strain(self, lattices: Lattices, control_points: Array, normal: Array, thickness: Array) -> Array:
        """Green strain of the mid surface: (spans, k, 3).

        The mid surface lies half a thickness inside a skin: its metric is g + t b + t²/4 c with the three fundamental
        forms of the skin (do Carmo, Differential Geometry, 3-5, parallel surfaces). ``normal`` (spans, k, 3) is the
        current one, ``thickness`` (spans,) is zero where there is no sheet.
        """
        gathered = control_points[lattices.controls][:, None]
        tangent = self.tangent + np.matmul(self.slope, gathered)
        second = self.curvature[..., None] * self.normal[:, :, None, :] + np.matmul(self.hessian, gathered)
        t = thickness[:, None, None]
        metric = np.stack([np.einsum("skx,skx->sk", tangent[:, :, i], tangent[:, :, j]) for i, j in _TENSOR_PAIRS],
                          axis=2)
        first = (metric - np.array([1.0, 0.0, 1.0])) * _TENSOR_NORM
        form = np.einsum("skpx,skx->skp", second, normal)
        change = _third_form(form, metric) - _third_form(self.curvature, np.broadcast_to([1.0, 0.0, 1.0], metric.shape))
        return np.asarray(0.5 * (first + t * (form - self.curvature) + 0.25 * t**2 * change))

    def strain_load(self, lattices: Lattices, control_points: Array, normal: Array, thickness: Array,
                    stress: Array) -> Array:
        """`strain_rows` times a stress (spans, k, 3), without them: (spans, 16, 3)."""
        tangent = self.tangent + np.matmul(self.slope, control_points[lattices.controls][:, None])
        shear = stress[..., 1:2] / np.sqrt(2.0)
        pull = np.stack([stress[..., :1] * tangent[:, :, 0] + shear * tangent[:, :, 1],
                         shear * tangent[:, :, 0] + stress[..., 2:] * tangent[:, :, 1]], axis=2)
        moment = (0.5 * thickness[:, None, None] * stress)[..., None] * normal[:, :, None, :]
        spans = len(pull)
        slope, hessian = (rows.reshape(spans, -1, 16).swapaxes(1, 2) for rows in (self.slope, self.hessian))
        return np.matmul(slope, pull.reshape(spans, -1, 3)) + np.matmul(hessian, moment.reshape(spans, -1, 3))

    def strain_rows(self, lattices: Lattices, control_points: Array, normal: Array, thickness: Array,
                    spans: slice = slice(None)) -> Array:
        """Derivative of `strain` by x, y and z of the control points, on all ``spans`` or some: (n, k, 3, 3, 16)."""
        slope, inward = self.slope[spans], 0.5 * thickness[spans, None, None] * normal[spans]
        tangent = self.tangent[spans] + np.matmul(slope, control_points[lattices.controls[spans]][:, None])
        rows = inward[:, :, None, :, None] * self.hessian[spans][:, :, :, None, :]
        for p, (i, j) in enumerate(_TENSOR_PAIRS):
            rows[:, :, p] += 0.5 * _TENSOR_NORM[p] * tangent[:, :, i, :, None] * slope[:, :, j, None, :]
            rows[:, :, p] += 0.5 * _TENSOR_NORM[p] * tangent[:, :, j, :, None] * slope[:, :, i, None, :]
        return rows


def _third_form(form: Array, metric: Array) -> Array:
    """c = b g⁻¹ b for symmetric tensors as rows 11, √2·12, 22 (the metric without the √2)."""
    a, b, c = form[..., 0], form[..., 1] / np.sqrt(2), form[..., 2]
    e, f, g = metric[..., 0], metric[..., 1], metric[..., 2]
    det = np.maximum(e * g - f * f, 1e-12)
    ie, jf, ig = g / det, -f / det, e / det
    return np.stack([a * (ie * a + jf * b) + b * (jf * a + ig * b),
                     np.sqrt(2) * (a * (ie * b + jf * c) + b * (jf * b + ig * c)),
                     b * (ie * b + jf * c) + c * (jf * b + ig * c)], axis=-1)


def make_stiffness(faces: tuple[FaceGeometry, ...], lattices: Lattices, body_size: Array) -> Stiffness:
    """Rows and weights at the Gauss places of the nominal faces.

    Parameters
    ----------
    faces : of the part
    lattices : of all faces
    body_size : (spans,) size in mm of the solid that a span belongs to
    """
    places = make_span_grid(faces, lattices, _GAUSS_PLACES)
    covered = covered_shares(faces, lattices, _GAUSS_BOUNDS)
    tangents, seconds = places.nominal.tangents, places.nominal.seconds
    normal, area_element = normals(places.nominal, places.outward)
    to_frame = _frame(tangents)
    # The frame's own metric inverse is E Eᵀ, and stays finite next to a pole.
    inverse = np.matmul(to_frame.swapaxes(2, 3), to_frame)
    christoffel = np.einsum("skpx,skax,skab->skpb", seconds, tangents, inverse)
    derivatives = places.tables.transpose(1, 0, 2)[None] * places.scale[:, None, :, None]
    slope = np.matmul(to_frame, derivatives[:, :, 1:3])
    covariant = derivatives[:, :, 3:6] - np.matmul(christoffel, derivatives[:, :, 1:3])
    tensor = _tensor_rotation(to_frame)
    hessian = np.matmul(tensor, covariant)
    form = np.einsum("skpx,skx->skp", seconds, normal)
    curvature = np.einsum("skpq,skq->skp", tensor, form)
    span_weights = 0.25 * np.outer(_GAUSS_WEIGHTS, _GAUSS_WEIGHTS).ravel()
    weight = span_weights * area_element * lattices.step.prod(axis=1)[:, None]
    everywhere = np.maximum(covered, _OUTSIDE_WEIGHT) * weight
    return Stiffness(places, covered * weight, everywhere, everywhere / body_size[:, None] ** 2,
                     slope, hessian, curvature, normal, np.matmul(to_frame, tangents))


def _frame(tangents: Array) -> Array:
    """E with e_i = E_ia S_a, orthonormal (Gram–Schmidt): (spans, k, 2, 2)."""
    e = np.einsum("skx,skx->sk", tangents[:, :, 0], tangents[:, :, 0])
    f = np.einsum("skx,skx->sk", tangents[:, :, 0], tangents[:, :, 1])
    g = np.einsum("skx,skx->sk", tangents[:, :, 1], tangents[:, :, 1])
    size = np.sqrt(np.maximum(e, 1e-18))
    height = np.sqrt(np.maximum(g - f * f / np.maximum(e, 1e-18), 1e-18))
    frame = np.zeros(e.shape + (2, 2))
    frame[..., 0, 0] = 1 / size
    frame[..., 1, 0] = -f / np.maximum(e, 1e-18) / height
    frame[..., 1, 1] = 1 / height
    return frame


def _tensor_rotation(frame: Array) -> Array:
    """Turns rows uu, uv, vv of a symmetric tensor into rows 11, √2·12, 22: (spans, k, 3, 3)."""
    rows = []
    for p, (i, j) in enumerate(_TENSOR_PAIRS):
        a, b = frame[..., i, :], frame[..., j, :]
        rows.append(_TENSOR_NORM[p] * np.stack([a[..., 0] * b[..., 0], a[..., 0] * b[..., 1] + a[..., 1] * b[..., 0],
                                                a[..., 1] * b[..., 1]], axis=-1))
    return np.stack(rows, axis=-2)
