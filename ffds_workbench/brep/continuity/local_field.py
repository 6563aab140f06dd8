# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local edits: the faces around an edited face follow one continuous field in space, so that every edge stays closed.

``D(x) = χ(x) Φ(x)``. Φ is smooth and takes the displacement of the edited faces along their edges and, more loosely,
inside; χ is 0 along the edges of the faces that stay, 1 on the edited faces. Faces around the edited ones move by D;
an edited face moves by exactly its own registered displacement, which D equals along its edges to 1e-5 mm. Where a
displacement is too rough for that, or disagrees with itself at a seam or a pole, it passes into D in a rim. So faces
that share an edge, a seam or a pole have the same displacement there. This module puts the pieces together; the rebuild
makes surfaces of them.
"""
from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ...errors import InputError, RefusedError
from ...registration.arrays import Array
from ...registration.splines import SplineSurface
from ..face_displacement import FaceDisplacement
from ..workpiece import Workpiece, WorkpieceFace
from .agreement import AT_VERTICES, Rim, agree, spread
from .cutoff import SPACING, Cutoff
from .edge_samples import FaceSamples, on_face, side_lengths
from .held_edges import held_edges
from .radial_basis import RadialField, interpolate

_SAMPLE_SPACING = 0.004
"""Distance of samples on the edges of an edited face, over the face's size (unit: no displacement changes over
less)."""
_FIDELITY = 1e-5
"""Largest distance in mm of the field from the registered displacement along the edges (unit: far below any tolerance,
above what a fit leaves), …"""
_DISPUTED_SHARE = 0.3
"""… or this share of what edited faces differ by there, so that the field runs smoothly through what they dispute
(unit)."""
_FIDELITY_INSIDE = 0.02
"""The same inside an edited face, over the largest displacement: there it only serves what lies behind the face
(unit)."""
_INSIDE_CORRECTION_SHARE = 0.2
"""Inside, corrections need only be met to within this share of the largest one (unit)."""
_SAME_AS_FIELD = 2e-5
"""What counts as equal to the field, in mm (theory: twice the fidelity along edges). An edited face gets a correction
where it is not, …"""
_RIM_WIDTHS = 0.08, 5.0
"""… and where that fails, it passes into the field within a rim. The rim is as wide as the first number times the
face's size (unit), and at least the second number times the distance (theory: the slope of what fades is then below a
half)."""
_SUPPORT_SIZES = 0.6, 5.0
"""Support of the radial functions: the first number times the size of the largest edited face (unit), plus the second
number times the largest displacement (theory: as above)."""
_LINES_PER_SUPPORT = 4.0
"""Lines of the lattice that follows the field, over its support (unit: time)."""


@dataclass(frozen=True)
class LocalField:
    """D(x) = χ(x) Φ(x), in mm.

    Attributes
    ----------
    smooth : Φ
    cutoff : χ
    """

    smooth: RadialField
    cutoff: Cutoff

    def __call__(self, points: Array) -> Array:
        """Displacement at points: (n, 3) to (n, 3)."""
        displacement = self.smooth(points)
        moving = np.flatnonzero(displacement.any(axis=1))
        displacement[moving] *= self.cutoff(points[moving])[:, None]
        return displacement


@dataclass(frozen=True)
class EditedFace:
    """The displacement of an edited face: its own, corrected, and held where χ holds it.

    Attributes
    ----------
    own : d, registered displacement over the face's (u, v)
    correction : c, what makes it equal the field along its edges where edited neighbours dispute them, or None
    rim : ρ, 0 along the edges where d + c is not close to the field, 1 away from them; None where it always is
    field : D
    """

    own: SplineSurface
    correction: RadialField | None
    rim: Cutoff | None
    field: LocalField

    def __call__(self, uv: Array, points: Array) -> Array:
        """χ (d + c + (1 − ρ) (Φ − d − c)), (n, 3) in mm"""
        displacement = self.own(uv)
        if self.correction is not None:
            displacement += self.correction(points)
        if self.rim is not None:
            towards = 1.0 - self.rim(points)
            near = np.flatnonzero(towards)
            displacement[near] += towards[near, None] * (self.field.smooth(points[near]) - displacement[near])
        return displacement * self.field.cutoff(points)[:, None]


def local_displacements(workpiece: Workpiece, face_displacements: Mapping[int, SplineSurface],
                        freeze: Collection[int] = ()) -> dict[int, FaceDisplacement]:
    """Displacements of the edited faces and of the faces around them that adapt, continuous across every edge.

    Parameters
    ----------
    workpiece : the shape
    face_displacements : registered displacement of each edited face, in mm over the face's own (u, v), by face index
    freeze : indices of faces that must not move; an edited face fades to 0 towards an edge it shares with one

    Returns
    -------
    dict of face index to displacement; faces that are not named stay exactly as they are

    Raises
    ------
    InputError
        A face is both edited and frozen.
    RefusedError
        Every face is frozen.
    """
    frozen = frozenset(freeze)
    _refuse_contradictions(workpiece, face_displacements, frozen)
    bodies = _bodies(workpiece)
    result: dict[int, FaceDisplacement] = {}
    for body in sorted({bodies[face] for face in face_displacements}):
        mine = {face: displacement for face, displacement in face_displacements.items() if bodies[face] == body}
        result |= _in_one_body(workpiece, mine, frozen)
    return dict(sorted(result.items()))


def _bodies(workpiece: Workpiece) -> NDArray[np.intp]:
    """For each face, the number of its body: faces that share a vertex. Bodies that only touch move independently."""
    incidence = [(vertex, face) for vertex, faces in enumerate(workpiece.topology.vertex_faces) for face in faces]
    vertex, face = np.array(incidence).T
    shape = len(workpiece.topology.vertex_faces), len(workpiece.faces)
    at = csr_matrix((np.ones(len(face)), (vertex, face)), shape)
    return connected_components(at.T @ at, directed=False)[1]


def _in_one_body(workpiece: Workpiece, face_displacements: Mapping[int, SplineSurface],
                 frozen: frozenset[int]) -> dict[int, FaceDisplacement]:
    """One field for edited faces of the same body."""
    samples = {face: on_face(workpiece.faces[face], _spans(d)) for face, d in face_displacements.items()}
    sizes = {face: float(np.linalg.norm(side_lengths(workpiece.faces[face]))) for face in face_displacements}
    rim = agree(workpiece, face_displacements, {face: _SAMPLE_SPACING * size for face, size in sizes.items()})
    largest = max(_largest(displacement) for displacement in face_displacements.values())
    support = _SUPPORT_SIZES[0] * max(sizes.values()) + _SUPPORT_SIZES[1] * largest
    smooth = _smooth_field(face_displacements, samples, sizes, rim, largest, support)
    rim = replace(rim, displacement=smooth(rim.samples.points))
    edited_points = np.concatenate([rim.samples.points, *(s.points for s in samples.values())])
    held = held_edges(workpiece, frozenset(face_displacements), frozen, smooth, cKDTree(edited_points),
                      max(sizes.values()))
    field = LocalField(smooth, held.cutoff)
    result = {}
    for face, displacement in face_displacements.items():
        correction = spread(rim, face, sizes[face], _SAME_AS_FIELD)
        edited = EditedFace(displacement, correction, _blend(rim, face, correction, sizes[face]), field)
        result[face] = FaceDisplacement(edited, *_lines_of_edit(workpiece.faces[face], displacement))
    for face in held.adapting:
        lines = _lines_of_field(workpiece.faces[face], field)
        result[face] = FaceDisplacement(lambda uv, points: field(points), *lines)
    return result


def _refuse_contradictions(workpiece: Workpiece, edited: Collection[int], frozen: frozenset[int]) -> None:
    both = sorted(frozen.intersection(edited))
    if both:
        names = ", ".join(workpiece.faces[face].name for face in both)
        raise InputError(f"{names} cannot be deformed and frozen at once: take it out of one of the two lists.")
    if len(frozen) == len(workpiece.faces):
        raise RefusedError("Every face is frozen: leave at least one face free to move.")


def _spans(displacement: SplineSurface) -> tuple[int, int]:
    return len(np.unique(displacement.knots_u)) - 1, len(np.unique(displacement.knots_v)) - 1


def _largest(displacement: SplineSurface) -> float:
    """Largest displacement in mm at the middles and ends of the spans."""
    u0, u1, v0, v1 = displacement.range
    count_u, count_v = (2 * n + 1 for n in _spans(displacement))
    return float(np.linalg.norm(displacement.on_grid(np.linspace(u0, u1, count_u), np.linspace(v0, v1, count_v)),
                                axis=2).max())


def _smooth_field(displacements: Mapping[int, SplineSurface], samples: Mapping[int, FaceSamples],
                  sizes: Mapping[int, float], rim: Rim, largest: float, support: float) -> RadialField:
    """Φ, through the agreed displacement of the edges and, loosely, the displacement inside."""
    points, values = [rim.samples.points], [rim.displacement]
    for face, displacement in displacements.items():
        coarse = samples[face].coarse
        inner, value = samples[face].points[coarse], displacement(samples[face].uv[coarse])
        roughly = spread(rim, face, sizes[face], _FIDELITY_INSIDE * largest, _INSIDE_CORRECTION_SHARE)
        points.append(inner)
        values.append(value if roughly is None else value + roughly(inner))
    tolerances = np.full(sum(map(len, points)), _FIDELITY_INSIDE * largest)
    edges = tolerances[:len(rim.dispute)]
    edges[:] = np.maximum(_FIDELITY, _DISPUTED_SHARE * rim.dispute)
    disputed = bool(rim.dispute.max() > _FIDELITY)
    if not disputed:
        edges[rim.samples.at_vertices] = AT_VERTICES
    return interpolate(np.concatenate(points), np.concatenate(values), tolerances, support,
                       most=min(1500, 600 + 150 * len(displacements)), smooth=disputed)


def _blend(rim: Rim, face: int, correction: RadialField | None, size: float) -> Cutoff | None:
    """The rim of an edited face along the edges where it is torn, or not close to the field for all its correction."""
    side = rim.sides[face]
    points = rim.samples.points[side.rows]
    own = side.own if correction is None else side.own + correction(points)
    distance = np.linalg.norm(rim.displacement[side.rows] - own, axis=1)
    far = side.torn | (distance > 2.0 * _SAME_AS_FIELD)
    if not far.any():
        return None
    edges = rim.samples.edges[side.rows]
    samples = rim.samples.take(side.rows[np.isin(edges, edges[far])])
    reach = max(_RIM_WIDTHS[0] * size, _RIM_WIDTHS[1] * float(distance.max()))
    return Cutoff(samples.points, samples.lengths, np.maximum(reach, samples.lengths / SPACING))


def _lines_of_edit(face: WorkpieceFace, displacement: SplineSurface) -> tuple[Array, Array]:
    """Interior knots of the displacement, and the bounds of the inner wires, where the rim runs."""
    u0, u1, v0, v1 = displacement.range
    bounds = np.array([bound for wire in face.trims for bound in (wire.min(axis=0), wire.max(axis=0))])
    u, v = (np.unique(np.concatenate([knots, side])) for knots, side in
            zip((displacement.knots_u, displacement.knots_v), bounds.T, strict=True))
    return u[(u > u0) & (u < u1)], v[(v > v0) & (v < v1)]


def _lines_of_field(face: WorkpieceFace, field: LocalField) -> tuple[Array, Array]:
    """Parameter lines across the part of a face that moves, close enough that the field cannot slip between them."""
    box = face.box
    u, v = np.linspace(box.u0, box.u1, 13), np.linspace(box.v0, box.v1, 13)
    boundary = np.concatenate([_densify(wire) for wire in face.trims])
    uv = np.concatenate([np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2), boundary])
    moving = uv[field.smooth(face.at(uv)).any(axis=1)]
    if len(moving) == 0:
        return np.empty(0), np.empty(0)
    lines = []
    for k, (grid, length) in enumerate(zip((u, v), side_lengths(face), strict=True)):
        step = grid[1] - grid[0]
        low, high = max(moving[:, k].min() - step, grid[0]), min(moving[:, k].max() + step, grid[-1])
        count = int(np.ceil((high - low) / (grid[-1] - grid[0]) * length * _LINES_PER_SUPPORT / field.smooth.support))
        lines.append(np.linspace(low, high, count + 1))
    return lines[0], lines[1]


def _densify(polyline: Array) -> Array:
    """About a hundred more points along a polyline in (u, v)."""
    fractions = np.linspace(0.0, 1.0, max(2, 100 // len(polyline)), endpoint=False)[:, None, None]
    return (polyline[:-1] + fractions * np.diff(polyline, axis=0)).reshape(-1, 2)
