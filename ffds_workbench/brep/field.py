# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local edits: the faces around an edited face follow one continuous field in space, so that every edge stays closed.

``D(x) = χ(x) Φ(x)``. Φ is smooth and takes the displacement of the edited faces along their edges and, more loosely,
inside; χ is 0 along the edges of the faces that stay, 1 on the edited faces. Faces around the edited ones move by D;
an edited face moves by its own registered displacement, which passes into D in a narrow rim along its edges. So two
faces that share an edge, a seam or a pole move alike there by construction. This module decides which faces adapt and
puts the pieces together; the rebuild makes surfaces of them.
"""
from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..errors import InputError, RefusedError
from ..registration.splines import Array, SplineSurface
from .agreement import Rim, agree, spread
from .cutoff import SPACING, Cutoff
from .displacement import FaceDisplacement
from .radial import RadialField, interpolate
from .samples import FaceSamples, on_face, side_lengths
from .stay import held_edges
from .workpiece import Workpiece, WorkpieceFace

_RIM = 0.08
"""Width of the rim of an edited face, where its own displacement passes into the field, over the face's size."""
_FIDELITY = 1e-3
"""Largest distance of the field from the registered displacement along edges, over the largest displacement …"""
_FIDELITY_RANGE = 1e-4, 2e-3
"""… but between these, in mm."""
_FIDELITY_INSIDE = 20.0
"""Inside an edited face the field only serves what lies behind it, and may be this much farther off."""
_SUPPORT = 0.6, 5.0
"""Support of the field: so much of the largest edited face's size plus so many times the largest displacement."""
_LINES_PER_SUPPORT = 4.0


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
    """The displacement of an edited face: its own, corrected, held where χ holds it, and D along its edges.

    Attributes
    ----------
    own : registered displacement over the face's (u, v)
    correction : what makes it agree with its edited neighbours, or None
    rim : factor that is 0 along the face's edges and 1 inside
    field : D
    """

    own: SplineSurface
    correction: RadialField | None
    rim: Cutoff
    field: LocalField

    def __call__(self, uv: Array, points: Array) -> Array:
        """χ (d + c + (1 − rim) (Φ − d − c))"""
        displacement = self.own(uv)
        if self.correction is not None:
            displacement += self.correction(points)
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
    if not face_displacements:
        return {}
    samples = {face: on_face(workpiece.faces[face], _spans(d)) for face, d in face_displacements.items()}
    sizes = {face: float(np.linalg.norm(side_lengths(workpiece.faces[face]))) for face in face_displacements}
    rim = agree(workpiece, face_displacements, {face: SPACING * _RIM * size for face, size in sizes.items()})
    largest = float(np.linalg.norm(rim.displacement, axis=1).max())
    largest = max([largest, *(_largest(d) for d in face_displacements.values())])
    fidelity = float(np.clip(_FIDELITY * largest, *_FIDELITY_RANGE))
    corrections = {face: spread(rim, face, sizes[face], fidelity) for face in face_displacements}
    support = _SUPPORT[0] * max(sizes.values()) + _SUPPORT[1] * largest
    smooth = _smooth_field(face_displacements, samples, sizes, rim, corrections, fidelity, support)

    edited_points = np.concatenate([rim.samples.points, *(s.points for s in samples.values())])
    held = held_edges(workpiece, frozenset(face_displacements), frozen, smooth, cKDTree(edited_points),
                      max(sizes.values()))
    field = LocalField(smooth, held.cutoff)
    result = {}
    for face, displacement in face_displacements.items():
        rows = rim.corrections[face][0]
        own_rim = rim.samples.take(rows)
        factor = Cutoff(own_rim.points, own_rim.lengths, np.maximum(_RIM * sizes[face], own_rim.lengths / SPACING))
        edited = EditedFace(displacement, corrections[face], factor, field)
        result[face] = FaceDisplacement(edited, *_lines_of_edit(workpiece.faces[face], displacement))
    for face in held.adapting:
        lines = _lines_of_field(workpiece.faces[face], field)
        result[face] = FaceDisplacement(lambda uv, points: field(points), *lines)
    return dict(sorted(result.items()))


def _refuse_contradictions(workpiece: Workpiece, edited: Collection[int], frozen: frozenset[int]) -> None:
    both = sorted(frozen.intersection(edited))
    if both:
        names = ", ".join(workpiece.faces[face].name for face in both)
        raise InputError(f"{names} cannot be deformed and frozen at the same time: take it out of one of the two lists.")
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
                  sizes: Mapping[int, float], rim: Rim, corrections: Mapping[int, RadialField | None], fidelity: float,
                  support: float) -> RadialField:
    """Φ, through the agreed displacement of the rims and the corrected displacement inside."""
    points, values = [rim.samples.points], [rim.displacement]
    tolerances = [np.full(len(rim.displacement), fidelity)]
    for face, displacement in displacements.items():
        coarse = samples[face].coarse
        inner = samples[face].points[coarse]
        value = displacement(samples[face].uv[coarse])
        correction = corrections[face]
        points.append(inner)
        values.append(value if correction is None else value + correction(inner))
        own_rim = cKDTree(rim.samples.points[rim.corrections[face][0]])
        in_rim = own_rim.query(inner)[0] < _RIM * sizes[face]
        tolerances.append(np.where(in_rim, fidelity, _FIDELITY_INSIDE * fidelity))
    return interpolate(np.concatenate(points), np.concatenate(values), np.concatenate(tolerances), support,
                       most=min(1500, 450 + 150 * len(displacements)))


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
