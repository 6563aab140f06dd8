# SPDX-License-Identifier: LGPL-2.1-or-later
"""Displacements of a part's faces added up, face by face over their own (u, v): exact, where a field in space is not.

Each of them agrees along the edges with its neighbours', and so does any sum of them.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..brep.face_displacement import FaceDisplacement
from ..brep.workpiece import Workpiece
from ..registration.arrays import Array
from ..registration.trims import inside_polylines
from .model_pair import FacePair, refuse_other_topology

Displacements = Mapping[int, FaceDisplacement]
_PLACES = 15
"""Places in each direction of a face where displacements are compared (unit: time)."""


@dataclass(frozen=True)
class _Sum:
    """Called as `FaceDisplacement.evaluate` is."""

    weights: tuple[float, ...]
    terms: tuple[FaceDisplacement, ...]

    def __call__(self, uv: Array, points: Array) -> Array:
        result = np.zeros_like(points)
        for weight, term in zip(self.weights, self.terms, strict=True):
            result += weight * term.evaluate(uv, points)
        return result


@dataclass(frozen=True)
class _Between:
    """Called as `FaceDisplacement.evaluate` is."""

    pair: FacePair

    def __call__(self, uv: Array, points: Array) -> Array:
        return self.pair.moved(uv) - points


def weighted_sum(terms: Sequence[tuple[float, Displacements]]) -> dict[int, FaceDisplacement]:
    """Σ weight × displacements, of every face that one of them moves."""
    result = {}
    for face in sorted({face for weight, moved in terms if weight for face in moved}):
        own = [(weight, moved[face]) for weight, moved in terms if weight and face in moved]
        lines_u, lines_v = (np.unique(np.concatenate([getattr(item, name) for _, item in own]))
                            for name in ("knots_u", "knots_v"))
        result[face] = FaceDisplacement(_Sum(tuple(weight for weight, _ in own), tuple(item for _, item in own)),
                                        lines_u, lines_v)
    return result


def between_models(nominal: Workpiece, built: Workpiece) -> dict[int, FaceDisplacement]:
    """How the faces of a nominal model move into those of another one of the same topology.

    Raises
    ------
    InputError : the models have not the same faces, edges and vertices, or a face has other parameters
    """
    refuse_other_topology(nominal, built)
    result = {}
    size = nominal.shape.BoundBox.DiagonalLength
    for before, after in zip(nominal.faces, built.faces, strict=True):
        pair = FacePair(before, after, size)
        pair.refuse_other_parameters(nominal, built)
        result[before.index] = FaceDisplacement(_Between(pair), *after.own_knots)
    return result


@dataclass(frozen=True)
class PlacesOnFace:
    """Places within a face: (n, 2) parameters and (n, 3) points in mm."""

    uv: Array
    points: Array


def places_of(part: Workpiece) -> list[PlacesOnFace]:
    """Places spread over every face of a part, in a grid within its trims."""
    result = []
    for face in part.faces:
        box = face.box
        middles = (np.arange(_PLACES) + 0.5) / _PLACES
        u, v = box.u0 + (box.u1 - box.u0) * middles, box.v0 + (box.v1 - box.v0) * middles
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        uv = uv[inside_polylines(face.trims, uv)]
        result.append(PlacesOnFace(uv, face.at(uv)))
    return result


def at_places(displacements: Displacements, places: Sequence[PlacesOnFace]) -> list[Array]:
    """Displacements (n, 3) in mm at the places of every face; 0 of a face that does not move."""
    return [displacements[face].evaluate(own.uv, own.points) if face in displacements and len(own.uv)
            else np.zeros_like(own.points) for face, own in enumerate(places)]
