# SPDX-License-Identifier: LGPL-2.1-or-later
"""Method ``ffd-hsu``: free-form deformation with a lattice of control points in space, manipulated directly.

Sederberg and Parry: Free-Form Deformation of Solid Geometric Models (1986); Hsu, Hughes and Kaufman: Direct
Manipulation of Free-Form Deformations (1992). The surface-based method is compared with it: Eq. 1 of the paper in place
of Eq. 2, with the same pseudo-inverse (Eq. 4). Lengths in mm.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..face_geometry import FaceGeometry
from ..robust_weights import robust_sigma
from ..splines import SplineSurface, basis_matrix, basis_rows, clamped_knots, greville
from . import ffds
from .control_lattice import displacement_lattice
from .face_result import FaceRegistration
from .neighbours import nearest_neighbours

_FLAT_SPREAD = 1e-9
"""Ratio of extents below which a face is flat, and a grid parallel to the lattice (theory: far above rounding)."""
_THINNEST = 0.1
"""Smallest side of the enclosing box, as a share of the largest: a flat face has no third extent of its own (unit)."""
_ON_SURFACE = 1e-3
"""Largest distance in mm between the deformation of space and the same deformation written over the face's (u, v)
(unit: far below the noise of scanners)."""
_FINEST_LATTICE = 64
"""Control points per direction over (u, v) at the most (unit: time)."""
_FINEST_AT_POLES = 20
"""The same on faces with a pole, whose basis is no Kronecker product (unit: time)."""


@dataclass(frozen=True)
class VolumeLattice:
    """A rectangular lattice of N_i × N_j × N_k control points in space, cubic and clamped in every direction.

    Attributes
    ----------
    corner : (3,) in mm
    axes : (3, 3), rows: orthonormal directions of s, t, u
    size : (3,) sides in mm
    count : (N_i, N_j, N_k)
    """

    corner: Array
    axes: Array
    size: Array
    count: tuple[int, int, int]

    @property
    def knots(self) -> tuple[Array, Array, Array]:
        """Knot vectors over [0, 1] in s, t, u."""
        i, j, k = self.count
        return clamped_knots(0.0, 1.0, i), clamped_knots(0.0, 1.0, j), clamped_knots(0.0, 1.0, k)

    @property
    def control_points(self) -> Array:
        """P of the undeformed lattice, (N_i, N_j, N_k, 3): with them L(p) = p."""
        s, t, u = (greville(knots) for knots in self.knots)
        grid = np.stack(np.meshgrid(s, t, u, indexing="ij"), axis=-1)
        return self.corner + (grid * self.size) @ self.axes

    def parameters(self, points: Array) -> Array:
        """(s, t, u) of points (n, 3), clipped to the lattice; (n, 3)."""
        return np.clip((points - self.corner) @ self.axes.T / self.size, 0.0, 1.0)

    def displacement(self, control_displacements: Array, points: Array) -> Array:
        """L(p) − p at points (n, 3) when the control points move by (N_i, N_j, N_k, 3) (Eq. 1): 64 terms a point."""
        stu = self.parameters(points)
        (i, bi), (j, bj), (k, bk) = (basis_rows(knots, x) for knots, x in zip(self.knots, stu.T, strict=True))
        result = np.zeros((len(points), 3))
        for a in range(4):
            for b in range(4):
                for c in range(4):
                    weight = bi[:, a] * bj[:, b] * bk[:, c]
                    result += weight[:, None] * control_displacements[i + a, j + b, k + c]
        return result


@dataclass(frozen=True)
class FaceSource:
    """S: source points on a face.

    Attributes
    ----------
    points : (len(u), len(v), 3) the grid
    on_face : (len(u), len(v)) which of its nodes are source points
    """

    u: Array
    v: Array
    points: Array
    on_face: NDArray[np.bool_]


def register_ffd(face: FaceGeometry, scan: Array, lattice: tuple[int, int] = (10, 10), source_points: int = 400,
                 reach: float = ffds.REACH) -> FaceRegistration:
    """Deform a face to a scan by a lattice in space around it: the paper's steps 1 to 5 with Eq. 1.

    Parameters
    ----------
    face : the nominal face
    scan : T, (n, 3) in mm, finite, in the frame of the model
    lattice : (N_i, N_j); across the face N_k is the smaller of the two
    source_points, reach : as in `ffds.register_ffds`

    Returns
    -------
    FaceRegistration
        The deformation as a displacement over the face's own (u, v), to 1e-3 mm, as from any other method.

    Raises
    ------
    RefusedError
        The scan does not lie on the face.
    """
    volume = enclose(face, (*lattice, min(lattice)))                          # steps 1 and 2: N, the lattice
    u, v, on_face = ffds.equidistant_grid(face, source_points)
    source = FaceSource(u, v, face.surface.on_grid(u, v), on_face)
    points = source.points[on_face]
    distance, nearest = nearest_neighbours(scan, points)                      # step 3: closest neighbour in T
    coverage = ffds.check_coverage(face, distance, reach)
    moved = solve_volume(volume, source, scan[nearest] - points)                     # step 4: ΔP = B⁺ Δp (Eq. 4)
    displacement = on_surface(volume, moved, face.surface, lattice)           # step 5: L(p) on the face (Eq. 1)
    residual = scan[nearest] - points - displacement.on_grid(u, v)[on_face]
    noise = robust_sigma(ffds.along_normal(face, u, v, on_face, residual))
    return FaceRegistration(face.name, displacement, len(np.unique(nearest)), coverage, noise)


def enclose(face: FaceGeometry, count: tuple[int, int, int]) -> VolumeLattice:
    """The rectangular lattice that encloses a face, along its main directions; a flat face lies in its middle."""
    u0, u1, v0, v1 = face.surface.range
    points = face.surface.on_grid(np.linspace(u0, u1, 33), np.linspace(v0, v1, 33)).reshape(-1, 3)
    middle = points.mean(axis=0)
    _, spread, axes = np.linalg.svd(points - middle, full_matrices=False)
    if spread[2] < _FLAT_SPREAD * spread[0]:      # along u: a grid on the face is then a grid in the lattice
        along = points[-1] - points[32]
        axes[0] = along / np.linalg.norm(along)
    axes[1] -= (axes[1] @ axes[0]) * axes[0]
    if np.linalg.norm(axes[1]) < 0.5:
        axes[1] = np.cross(axes[2], axes[0])
    axes[1] /= np.linalg.norm(axes[1])
    axes[2] = np.cross(axes[0], axes[1])
    local = (points - middle) @ axes.T
    low, high = local.min(axis=0), local.max(axis=0)
    size = np.maximum(high - low, _THINNEST * (high - low).max())
    return VolumeLattice(middle + (0.5 * (low + high - size)) @ axes, axes, size, count)


def volume_basis(lattice: VolumeLattice, points: Array) -> Array:
    """B of Eq. 3 for the lattice in space, dense: (n, N_i·N_j·N_k)."""
    stu = lattice.parameters(points)
    s, t, u = (basis_matrix(knots, x) for knots, x in zip(lattice.knots, stu.T, strict=True))
    return np.einsum("ni,nj,nk->nijk", s, t, u, optimize=True).reshape(len(points), -1)


def solve_volume_dense(lattice: VolumeLattice, points: Array, displacements: Array) -> Array:
    """ΔP = B⁺ Δp by the dense pseudo-inverse, as published; (n, 3) twice to (N_i, N_j, N_k, 3).

    There are more control points than a face determines: of all solutions the pseudo-inverse takes the smallest.
    """
    return (ffds.pseudo_inverse(volume_basis(lattice, points)) @ displacements).reshape(*lattice.count, 3)


def solve_volume(lattice: VolumeLattice, source: FaceSource, displacements: Array) -> Array:
    """The same ΔP = B⁺ Δp, the fast way.

    Parameters
    ----------
    source : the source points
    displacements : Δp of its points on the face, (q, 3), row by row in u

    Returns
    -------
    (N_i, N_j, N_k, 3)

    Notes
    -----
    On a grid that is parallel to the lattice B = B_s ⊗ B_t ⊗ B_u, hence B⁺ = B_s⁺ ⊗ B_t⁺ ⊗ B_u⁺. Elsewhere
    B⁺ = Bᵀ (B Bᵀ)⁺, where B Bᵀ is the product, element by element, of three small Gram matrices.
    """
    factors = _grid_factors(lattice, source)
    if factors is not None:
        s, t, u = (ffds.pseudo_inverse(basis_matrix(knots, x)) for knots, x in zip(lattice.knots, factors, strict=True))
        grid = displacements.reshape(len(factors[0]), len(factors[1]), 3)
        return np.einsum("ia,abx,jb,k->ijkx", s, grid, t, u[:, 0], optimize=True)
    stu = lattice.parameters(source.points[source.on_face])
    s, t, u = (basis_matrix(knots, x) for knots, x in zip(lattice.knots, stu.T, strict=True))
    values, vectors = np.linalg.eigh((s @ s.T) * (t @ t.T) * (u @ u.T))
    kept = values > ffds.SMALLEST_SINGULAR_VALUE**2 * values[-1]
    weights = vectors[:, kept] @ ((vectors[:, kept].T @ displacements) / values[kept, None])
    return np.einsum("ni,nj,nk,nx->ijkx", s, t, u, weights, optimize=True)


def _grid_factors(lattice: VolumeLattice, source: FaceSource) -> tuple[Array, Array, Array] | None:
    """s of the grid's rows, t of its columns and the one u of all, if the whole grid is parallel to the lattice."""
    if not source.on_face.all():
        return None
    stu = lattice.parameters(source.points.reshape(-1, 3)).reshape(source.points.shape)
    s, t, u = stu[:, 0, 0], stu[0, :, 1], stu[0, 0, 2]
    gap = np.abs(stu - np.stack(np.broadcast_arrays(s[:, None], t[None, :], u), axis=-1)).max()
    return (s, t, np.array([u])) if gap < _FLAT_SPREAD else None


def on_surface(lattice: VolumeLattice, control_displacements: Array, surface: SplineSurface,
               size: tuple[int, int]) -> SplineSurface:
    """The deformation along a surface as a displacement over the surface's own (u, v).

    The lattice over (u, v) starts at ``size`` and is made finer until it is within 1e-3 mm, or as fine as it may be.
    A flat face that is parallel to the lattice needs no more than ``size``.
    """
    while True:
        control = displacement_lattice(surface, size)
        u0, u1, v0, v1 = surface.range
        u, v = np.linspace(u0, u1, 3 * size[0] + 2), np.linspace(v0, v1, 3 * size[1] + 2)
        points = surface.on_grid(u, v).reshape(-1, 3)
        values = lattice.displacement(control_displacements, points)
        everywhere = np.ones((len(u), len(v)), dtype=bool)
        displacement = control.field(ffds.solve_lattice(control, u, v, everywhere, values))
        error = np.linalg.norm(displacement.on_grid(u, v).reshape(-1, 3) - values, axis=1).max()
        finest = _FINEST_LATTICE if control.is_tensor else _FINEST_AT_POLES
        if error <= _ON_SURFACE or max(size) >= finest:
            return displacement
        size = (min(finest, round(1.5 * size[0])), min(finest, round(1.5 * size[1])))
