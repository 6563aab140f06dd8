# SPDX-License-Identifier: LGPL-2.1-or-later
"""The (u, v) raster of all faces, aligned with the spans: k × k cells in every span, and their geometry.

Arrays run over (span, cell in the span). The nominal geometry is kept; the current one is nominal + displacement, a
matrix product with one table for all spans.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Index
from ...face_geometry import FaceGeometry
from ...trims import inside_trims
from .lattices import FaceLattice, Lattices, products

DERIVATIVES = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
"""Orders in u and v of position, first and second derivatives, in the order of the arrays' second axis."""
_BOX_SAMPLES = 4, 64
"""Along a side of a box whose share within the trims is found; on a face that all miss, such as the narrow ring at the
end of a tube, twice as many are tried, up to the second number (unit)."""
_FACE_SEPARATION = 1e6
"""Distance in mm that parts faces in a tree (theory: farther than any part is large)."""
_LOT = 512
"""Spans that are moved together (unit: memory of a processor's cache)."""


@dataclass(frozen=True)
class Jet:
    """Positions and derivatives in (u, v) of the surfaces at fixed places: ``values`` (spans, k, 6, 3).

    The third axis follows `DERIVATIVES`.
    """

    values: Array

    @property
    def position(self) -> Array:
        """Places in mm: (spans, k, 3)."""
        return self.values[:, :, 0]

    @property
    def tangents(self) -> Array:
        """S_u and S_v: (spans, k, 2, 3)."""
        return self.values[:, :, 1:3]

    @property
    def seconds(self) -> Array:
        """S_uu, S_uv and S_vv: (spans, k, 3, 3)."""
        return self.values[:, :, 3:6]


@dataclass(frozen=True)
class SpanGrid:
    """The same local places in every span of every face, with the nominal surface there.

    Attributes
    ----------
    local : (k, 2) places in the unit span
    tables : (6, k, 16) basis functions and their derivatives with respect to the local place
    scale : (spans, 6) turns local derivatives into derivatives in (u, v)
    nominal : the nominal surfaces
    inside : (spans, k) whether the place is within the trims
    outward : (spans,) +1 or −1: whether S_u × S_v points out of the material

    Parameters of the methods
    -------------------------
    control_points : (controls, 3) of the displacement in mm
    lattices : of all faces
    """

    local: Array
    tables: Array
    scale: Array
    nominal: Jet
    inside: NDArray[np.bool_]
    outward: Array

    def displaced(self, lattices: Lattices, control_points: Array, orders: int = 6) -> Jet:
        """Nominal + displacement of control points (controls, 3): the first ``orders`` of `DERIVATIVES`."""
        count, k = self.inside.shape
        table, result = self.tables[:orders].reshape(-1, 16), np.empty((count, k, orders, 3))
        for start in range(0, count, _LOT):
            lot = slice(start, start + _LOT)
            moved = np.matmul(table, control_points[lattices.controls[lot]]).reshape(-1, orders, k, 3)
            moved *= self.scale[lot, :orders, None, None]
            np.add(self.nominal.values[lot, :, :orders], moved.transpose(0, 2, 1, 3), out=result[lot])
        return Jet(result)


def normals(jet: Jet, outward: Array) -> tuple[Array, Array]:
    """Unit normals out of the material (spans, k, 3) and area elements |S_u × S_v| (spans, k).

    Parameters
    ----------
    jet : the current shape at the cells
    outward : (spans,) ±1, which turns S_u × S_v out of the material
    """
    cross = np.cross(jet.tangents[:, :, 0], jet.tangents[:, :, 1])
    area = np.sqrt(np.einsum("skx,skx->sk", cross, cross))
    return cross * (outward[:, None] / np.maximum(area, 1e-12))[:, :, None], area


def by_face(position: Array, face: Index) -> Array:
    """Places (n, 3) in mm with a fourth coordinate that parts their faces (n,), so that a tree finds places of the own
    face first: (n, 4).

    Parameters
    ----------
    position : (n, 3) in mm
    """
    return np.column_stack([position, _FACE_SEPARATION * face])


def make_span_grid(faces: tuple[FaceGeometry, ...], lattices: Lattices, x: Array) -> SpanGrid:
    """Places at x × x in every span, x (m,) local coordinates.

    Parameters
    ----------
    faces : of the part
    lattices : of all faces
    """
    local = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    jets, inside = [], []
    for face, lattice in zip(faces, lattices.faces, strict=True):
        nu, nv = lattice.spans
        u = (lattice.corner[0] + lattice.step[0] * (np.arange(nu)[:, None] + x)).ravel()
        v = (lattice.corner[1] + lattice.step[1] * (np.arange(nv)[:, None] + x)).ravel()
        jets.append(_by_span(face.surface.jet_on_grid(u, v, DERIVATIVES), nu, nv, len(x)))
        inside.append(_by_span(inside_trims(face, u, v), nu, nv, len(x)))
    tables = np.stack([products(local[:, 0], local[:, 1], *order) for order in DERIVATIVES])
    scale = np.stack([lattices.step[:, 0] ** -du * lattices.step[:, 1] ** -dv for du, dv in DERIVATIVES], axis=1)
    outward = np.array([face.outward for face in faces], dtype=float)[lattices.face_of_span]
    return SpanGrid(local, tables, scale, Jet(np.concatenate(jets)), np.concatenate(inside), outward)


def covered_shares(faces: tuple[FaceGeometry, ...], lattices: Lattices, bounds: Array) -> Array:
    """Share within the trims of the boxes between ``bounds`` (m + 1,), local coordinates, in every span: (spans, m²).

    Parameters
    ----------
    faces : of the part
    lattices : of all faces
    """
    shares = []
    for face, lattice in zip(faces, lattices.faces, strict=True):
        finest = _BOX_SAMPLES[0]
        share = _covered(face, lattice, bounds, finest)
        while not share.any() and finest < _BOX_SAMPLES[1]:
            finest *= 2
            share = _covered(face, lattice, bounds, finest)
        shares.append(share)
    return np.concatenate(shares)


def _covered(face: FaceGeometry, lattice: FaceLattice, bounds: Array, samples: int) -> Array:
    """Shares (spans, m²) of the boxes of one face, by so many ``samples`` along each side of a box."""
    boxes, (nu, nv) = len(bounds) - 1, lattice.spans
    x = (bounds[:-1, None] + np.diff(bounds)[:, None] * (np.arange(samples) + 0.5) / samples).ravel()
    u, v = (corner + step * (np.arange(n)[:, None] + x).ravel()
            for corner, step, n in zip(lattice.corner, lattice.step, lattice.spans, strict=True))
    inside = _by_span(inside_trims(face, u, v), nu, nv, len(x)).reshape(-1, boxes, samples, boxes, samples)
    return inside.mean(axis=(2, 4)).reshape(-1, boxes**2)


def _by_span(grid: NDArray[Any], nu: int, nv: int, m: int) -> NDArray[Any]:
    rest = grid.shape[2:]
    blocks = grid.reshape(nu, m, nv, m, *rest).swapaxes(1, 2)
    return blocks.reshape(nu * nv, m * m, *rest)


def cell_sides(lattices: Lattices, cells: SpanGrid) -> Array:
    """Length in mm of the longer sides of the cells of every face, their mean: (faces,).

    Parameters
    ----------
    lattices : of all faces
    cells : places on all faces, span by span
    """
    sides = np.linalg.norm(cells.nominal.tangents, axis=3).mean(axis=1) * lattices.step / np.sqrt(len(cells.local))
    count = np.bincount(lattices.face_of_span)
    return np.asarray(np.bincount(lattices.face_of_span, sides.max(axis=1)) / count)
