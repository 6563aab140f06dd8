# SPDX-License-Identifier: LGPL-2.1-or-later
"""The displacement lattices of all faces, numbered together: uniform cubic B-splines over each face's (u, v).

The knots are uniform and not clamped, so that every span of every face carries the same 16 basis functions and one
table serves them all. A closed direction is periodic by construction: its control points are numbered around.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Index
from ...face_geometry import FaceGeometry
from ...splines import DEGREE, SplineSurface, cubic


def products(x: Array, y: Array, du: int = 0, dv: int = 0) -> Array:
    """The 16 tensor products of `cubic` at local (x, y): (n, 16)."""
    return (cubic(x, du)[:, :, None] * cubic(y, dv)[:, None, :]).reshape(len(x), 16)


@dataclass(frozen=True)
class FaceLattice:
    """The lattice of one face.

    Attributes
    ----------
    corner, step : (2,) lower corner of the parameter box and the size of a span, in (u, v)
    spans : number of spans in u and v
    periodic : whether u, v close on themselves
    first_control, first_span : where the face starts in the common numbering

    Parameters of the methods
    -------------------------
    uv : (n, 2) parameters
    """

    corner: Array
    step: Array
    spans: tuple[int, int]
    periodic: tuple[bool, bool]
    first_control: int
    first_span: int

    @property
    def shape(self) -> tuple[int, int]:
        """Number of free control points in u and v."""
        nu, nv = (n if p else n + DEGREE for n, p in zip(self.spans, self.periodic, strict=True))
        return nu, nv

    def controls(self) -> Index:
        """Numbers of the 16 control points of every span, spans in row-major order: (spans, 16)."""
        (nu, nv), (mu, mv) = self.spans, self.shape
        iu = (np.arange(nu)[:, None] + np.arange(4)) % mu
        iv = (np.arange(nv)[:, None] + np.arange(4)) % mv
        grid = iu[:, None, :, None] * mv + iv[None, :, None, :]
        return self.first_control + grid.reshape(nu * nv, 16)

    def locate(self, uv: Array) -> tuple[Index, Array]:
        """The span (in the common numbering) of each (u, v), wrapped or clipped, and the local place in it."""
        place = (uv - self.corner) / self.step
        spans = np.array(self.spans)
        place = np.where(self.periodic, np.mod(place, spans), place)
        cell = np.clip(np.floor(place), 0, spans - 1).astype(np.intp)
        return self.first_span + cell[:, 0] * self.spans[1] + cell[:, 1], place - cell


@dataclass(frozen=True)
class Lattices:
    """The lattices of all faces in one numbering.

    Attributes
    ----------
    faces : one lattice per face
    controls : (spans, 16) control points of each span
    step : (spans, 2) size of each span in its face's (u, v)
    face_of_span : (spans,)
    face_of_control : (controls,)

    Parameters of the methods
    -------------------------
    control_points : (controls, 3) of the displacement in mm
    loads : (n, 16, 3) on the control points of spans
    spans : (n,) numbers of spans
    du : order of the derivative in u
    dv : order of the derivative in v
    """

    faces: tuple[FaceLattice, ...]
    controls: Index
    step: Array
    face_of_span: Index
    face_of_control: Index

    @property
    def count(self) -> int:
        """Number of control points."""
        return len(self.face_of_control)

    def weights(self, span: Index, local: Array, du: int, dv: int) -> Array:
        """Weights (n, 16) of the control points of spans (n,) that give d or a derivative at local places (n, 2)."""
        scale = self.step[span, 0] ** -du * self.step[span, 1] ** -dv
        return products(local[:, 0], local[:, 1], du, dv) * scale[:, None]

    def sum_of_loads(self, loads: Array, spans: Index | slice = slice(None)) -> Array:
        """Loads (n, 16, 3) on the control points of all spans, or of the given ones (n,), summed up: (controls, 3)."""
        controls, flat = self.controls[spans].ravel(), loads.reshape(-1, 3)
        return np.stack([np.bincount(controls, weights=flat[:, k], minlength=self.count) for k in range(3)], axis=1)

    def spline(self, face: int, control_points: Array) -> SplineSurface:
        """The displacement of one face, (controls, 3) in mm, as a spline of its own."""
        lattice = self.faces[face]
        mu, mv = lattice.shape
        points = control_points[lattice.first_control : lattice.first_control + mu * mv].reshape(mu, mv, -1)
        knots = []
        for axis in range(2):
            n = lattice.spans[axis]
            knots.append(lattice.corner[axis] + lattice.step[axis] * np.arange(-DEGREE, n + DEGREE + 1))
            if lattice.periodic[axis]:
                points = np.concatenate([points, np.take(points, range(DEGREE), axis=axis)], axis=axis)
        return SplineSurface(knots[0], knots[1], points, periodic_u=lattice.periodic[0], periodic_v=lattice.periodic[1])


def build_lattices(faces: tuple[FaceGeometry, ...], counts: Sequence[tuple[int, int]]) -> Lattices:
    """Lattices with that many spans in u and v.

    Parameters
    ----------
    faces : of the part
    counts : spans per direction of every face
    """
    lattices: list[FaceLattice] = []
    first_control = first_span = 0
    for face, spans in zip(faces, counts, strict=True):
        u0, u1, v0, v1 = face.surface.range
        periodic = (face.surface.periodic_u, face.surface.periodic_v)
        step = np.array([(u1 - u0) / spans[0], (v1 - v0) / spans[1]])
        lattice = FaceLattice(np.array([u0, v0]), step, spans, periodic, first_control, first_span)
        lattices.append(lattice)
        first_control += lattice.shape[0] * lattice.shape[1]
        first_span += spans[0] * spans[1]
    sizes = [f.spans[0] * f.spans[1] for f in lattices]
    return Lattices(tuple(lattices), np.concatenate([f.controls() for f in lattices]),
                    np.repeat([f.step for f in lattices], sizes, axis=0), np.repeat(np.arange(len(faces)), sizes),
                    np.repeat(np.arange(len(faces)), [f.shape[0] * f.shape[1] for f in lattices]))
