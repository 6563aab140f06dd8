# SPDX-License-Identifier: LGPL-2.1-or-later
"""Method ``ffds``: surface-based free-form deformation by the published algorithm.

Kuss, Ksensow, Verl: Deformable Shape Registration Using Surface-Based Free-Form Deformations in Robotic Welding.
S is the source shape (the nominal face), T the target (the scan); all lengths in mm.
"""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...errors import RefusedError
from ..arrays import Array
from ..face_geometry import FaceGeometry
from ..robust_weights import robust_sigma
from ..splines import DEGREE, tensor_product
from ..trims import inside_trims
from .control_lattice import ControlLattice, displacement_lattice
from .face_result import FaceRegistration
from .neighbours import nearest_neighbours

REACH = 10.0
"""Points of the scan farther from the nominal face than this, in mm, are not the face's own (unit: parts of some
decimetres warp by less)."""

SMALLEST_SINGULAR_VALUE = 1e-6
"""Of the pseudo-inverses, over the largest one (theory: what is smaller multiplies the noise by a million)."""
_LEAST_COVERAGE = 0.1
"""Share of the source points that need a neighbour within reach (unit: with fewer the scan shows something else)."""
_FINEST_LATTICE = 10
"""Control points per direction with which the automatic choice begins (theory: the paper's lattice)."""
_LARGEST_OVERSHOOT, _FIRM_OVERSHOOT = 4.0, 2.5
"""Displacement of control points over that of source points, above which a lattice counts as undetermined, and up to
which the automatic choice takes one. Without holes it stays below 2 for a cubic, or a little above where most of it is
noise (calibrated: by hand, on faces with holes of the families of ``./ffds benchmark accuracy``)."""


class UndeterminedError(RefusedError):
    """The source points do not determine the control points."""


def register_ffds(face: FaceGeometry, scan: Array, lattice: tuple[int, int] | None = (10, 10),
                  source_points: int = 400, reach: float = REACH,
                  overshoot: float = _LARGEST_OVERSHOOT) -> FaceRegistration:
    """Deform a face to a scan: the paper's steps 1 to 5.

    Parameters
    ----------
    face : the nominal face
    scan : T, (n, 3) in mm, finite, in the frame of the model
    lattice : (N_i, N_j), control points in u and v; None for the finest of 10 × 10 … 4 × 4 that the source points
        determine
    source_points : number of points of the equidistant grid on the face, rounded to a square; those in holes drop out
    reach : mm; the share of source points with a neighbour nearer than this is the coverage
    overshoot : largest displacement of control points over that of source points; infinity accepts whatever the
        paper's algorithm gives

    Raises
    ------
    RefusedError
        The source points do not determine the control points of the lattice, or the scan does not lie on the face.
    """
    if lattice is None:
        return _register_finest(face, scan, source_points, reach)
    return _register(face, scan, lattice, source_points, reach, overshoot)


def _register_finest(face: FaceGeometry, scan: Array, source_points: int, reach: float) -> FaceRegistration:
    """The registration with the finest lattice that the source points determine firmly."""
    for count in range(_FINEST_LATTICE, DEGREE + 1, -1):
        try:
            return _register(face, scan, (count, count), source_points, reach, _FIRM_OVERSHOOT)
        except UndeterminedError:
            continue
    return _register(face, scan, (DEGREE + 1, DEGREE + 1), source_points, reach, _LARGEST_OVERSHOOT)


def _register(face: FaceGeometry, scan: Array, lattice: tuple[int, int], source_points: int, reach: float,
              overshoot: float) -> FaceRegistration:
    """The paper's algorithm with a given lattice."""
    control = displacement_lattice(face.surface, lattice)                     # steps 1 and 2: N_i, N_j, the lattice
    u, v, on_face = equidistant_grid(face, source_points)
    source = face.surface.on_grid(u, v)[on_face]
    _check_source(face, control, len(source))
    distance, nearest = nearest_neighbours(scan, source)                      # step 3: closest neighbour in T
    coverage = check_coverage(face, distance, reach)
    displacement_points = scan[nearest] - source                              # Δp
    control_points = solve_lattice(control, u, v, on_face, displacement_points)       # step 4: ΔP̃ = B⁺ Δp (Eq. 4)
    _check_determined(face, control, control_points, displacement_points, overshoot)
    displacement = control.field(control_points)                              # step 5: L̃(p) = Σ N N (P̃ + ΔP̃) (Eq. 2)
    residual = scan[nearest] - source - displacement.on_grid(u, v)[on_face]
    noise = robust_sigma(along_normal(face, u, v, on_face, residual))
    return FaceRegistration(face.name, displacement, len(np.unique(nearest)), coverage, noise)


def solve_lattice(control: ControlLattice, u: Array, v: Array, on_face: NDArray[np.bool_], values: Array) -> Array:
    """Free control points ΔP̃ = B⁺ Δp that move the source points by Δp in the least-squares sense (Eq. 3 and 4).

    Parameters
    ----------
    u, v : the source grid
    on_face : (len(u), len(v)), which of its nodes are source points
    values : Δp, (q, 3), row by row in u

    Returns
    -------
    (control.free, 3)

    Notes
    -----
    On a full grid B = B_u ⊗ B_v, hence B⁺ = B_u⁺ ⊗ B_v⁺: two small pseudo-inverses instead of a large one.
    """
    if on_face.all() and control.is_tensor:
        grid = values.reshape(len(u), len(v), -1)
        points = tensor_product(pseudo_inverse(control.basis_u(u)), pseudo_inverse(control.basis_v(v)), grid)
        return points.reshape(control.free, -1)
    return pseudo_inverse(lattice_basis(control, u, v)[on_face.ravel()]) @ values


def lattice_basis(control: ControlLattice, u: Array, v: Array) -> Array:
    """B of Eq. 3 on the grid u × v: (len(u)·len(v), control.free)."""
    full = np.kron(control.basis_u(u), control.basis_v(v))
    if control.is_tensor:
        return full
    merged = np.zeros((len(full), control.free))
    np.add.at(merged.T, control.unknown.ravel(), full.T)
    return merged


def pseudo_inverse(matrix: Array) -> Array:
    """Moore–Penrose inverse; directions that the source points hardly determine are left at rest."""
    return np.asarray(np.linalg.pinv(matrix, rcond=SMALLEST_SINGULAR_VALUE))


def equidistant_grid(face: FaceGeometry, count: int) -> tuple[Array, Array, NDArray[np.bool_]]:
    """About ``count`` points on the face, equidistant along u and along v.

    Returns
    -------
    u, v : (m,) each, m = √count rounded, from side to side of the parameter range; a closed direction has m spacings
    on_face : (m, m), which nodes lie inside the trims
    """
    per_direction = max(2, round(np.sqrt(count)))
    surface = face.surface
    u0, u1, v0, v1 = surface.range
    u, v = np.linspace(u0, u1, 65), np.linspace(v0, v1, 65)
    points = surface.on_grid(u, v)
    u = _equidistant(u, np.linalg.norm(np.diff(points, axis=0), axis=2).mean(axis=1), per_direction, surface.periodic_u)
    v = _equidistant(v, np.linalg.norm(np.diff(points, axis=1), axis=2).mean(axis=0), per_direction, surface.periodic_v)
    return u, v, inside_trims(face, u, v)


def _equidistant(x: Array, steps: Array, count: int, closed: bool) -> Array:
    """Parameters at equal distances of the mean arc length; a closed direction does not repeat its first point."""
    length = np.concatenate([[0.0], np.cumsum(steps)])
    return np.interp(np.linspace(0, length[-1], count, endpoint=not closed), length, x)


def along_normal(face: FaceGeometry, u: Array, v: Array, on_face: NDArray[np.bool_], vectors: Array) -> Array:
    """Components of vectors at the source points along the nominal normal, (q,)."""
    derivatives = [face.surface.derivative(*d) for d in ((1, 0), (0, 1))]
    tangent_u, tangent_v = (d.on_grid(u, v)[on_face] for d in derivatives)
    normal = np.cross(tangent_u, tangent_v)
    length = np.linalg.norm(normal, axis=1)
    return np.divide((normal * vectors).sum(axis=1), length, out=np.zeros(len(vectors)), where=length > 0)


def _check_determined(face: FaceGeometry, control: ControlLattice, control_points: Array, moves: Array,
                      overshoot: float) -> None:
    """Refuse a lattice some of whose control points move much farther than any source point: over holes, hardly
    anything determines them."""
    farthest, asked = (float(np.linalg.norm(points, axis=1).max()) for points in (control_points, moves))
    if farthest > overshoot * asked:
        rows, columns = control.unknown.shape
        raise UndeterminedError(
            f"The lattice {rows}x{columns} is too fine for {face.name}: around holes its control points would move "
            f"{farthest:.3g} mm where the scan asks for {asked:.3g} mm; choose a smaller lattice or method robust.")


def _check_source(face: FaceGeometry, control: ControlLattice, source_points: int) -> None:
    if source_points < control.free:
        rows, columns = control.unknown.shape
        raise UndeterminedError(
            f"The lattice {rows}x{columns} is too fine for {face.name}: its {control.free} control points are not "
            f"determined by {source_points} source points; choose a smaller lattice or more source points.")


def check_coverage(face: FaceGeometry, distance: Array, reach: float) -> float:
    coverage = float(np.mean(distance <= reach))
    if coverage < _LEAST_COVERAGE:
        raise RefusedError(
            f"The scan does not lie on {face.name}: only {coverage:.0%} of its source points have a scan point within "
            f"{reach:g} mm (median distance {np.median(distance):.4g} mm); check the scan's unit and alignment.")
    return coverage
