# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much faces and edges can be trusted, and why: their 95 % bands, and whether the scan observes them."""
from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...splines import SplineSurface
from ..data import misfit, nearest_spans
from ..iteration import State
from ..joint_result import EdgeRegistration, Flag, JointFace
from ..priors import directions, parameters
from ..problem import Problem
from ..surfaces import normals, places_on_faces
from .bands import TWO_SIDED, edge_bands, normal_bands
from .covariance import covariance_blocks
from .observed_cells import BRIDGED, CARRIED, OBSERVED, Coverage, coverage

Flags = NDArray[np.str_]


def assess(problem: Problem, state: State, displacements: Sequence[SplineSurface]
           ) -> tuple[tuple[JointFace, ...], tuple[EdgeRegistration, ...]]:
    """Faces, whose displacements are given, and edges with their bands and flags.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    state : where the solve stands
    """
    covariance, errors = covariance_blocks(problem, state)
    seen = coverage(problem, state.values)
    off = misfit(state.values, problem.lattices, problem.cells, problem.body_size) + (state.unsure / TWO_SIDED) ** 2
    return (_faces(problem, state, displacements, covariance, errors, seen, off),
            _edges(problem, state, covariance, errors, seen, off))


def _faces(problem: Problem, state: State, displacements: Sequence[SplineSurface], covariance: Array, errors: Array,
           seen: Coverage, off: Array) -> tuple[JointFace, ...]:
    places, lattices = problem.stiffness.places, problem.lattices
    jet = places.displaced(lattices, state.control_points, 3)
    normal = normals(jet, places.outward)[0]
    span, place = np.nonzero(_assessed(problem))
    face = lattices.face_of_span[span]
    uv = parameters(lattices, places, span, place)
    gap_inside = seen.gap_of(face, places.nominal.position[span, place])
    gap = np.zeros(places.inside.shape)
    gap[span, place] = gap_inside
    beyond = np.maximum(gap - 2 * seen.near, 0.0)
    bands = normal_bands(problem, covariance, errors, places.tables[0], normal, beyond, _border(problem),
                         off)[span, place]
    flags = seen.flags(gap_inside, face, 2 * seen.near)
    points = np.bincount(problem.face_of_cell, weights=state.values.count, minlength=len(problem.part.faces))
    result, noise = [], state.values.scatter.of_face
    for index, geometry in enumerate(problem.part.faces):
        own = face == index
        result.append(JointFace(geometry.name, displacements[index], int(points[index]), float(seen.share[index]),
                                float(noise[index]), _most(flags[own]), _rms(bands[own]), uv[own], bands[own],
                                flags[own]))
    return tuple(result)


def _assessed(problem: Problem) -> NDArray[np.bool_]:
    """The Gauss places that tell of their face, (spans, k): those on it; of a narrow ring that holds none, those whose
    boxes it crosses."""
    inside, face = problem.stiffness.places.inside, problem.lattices.face_of_span
    empty = np.bincount(face, inside.any(axis=1)) == 0
    return inside | (empty[face, None] & (problem.stiffness.area > 0))


def _border(problem: Problem) -> Array:
    """Distance in mm of the Gauss places from the border of their face, that of the cells around them: (spans, k)."""
    per_span = int(np.sqrt(problem.cells.inside.shape[1]))
    cell = np.floor(problem.stiffness.places.local * per_span).astype(int)
    return problem.distance[:, cell[:, 0] * per_span + cell[:, 1]]


def _edges(problem: Problem, state: State, covariance: Array, errors: Array, seen: Coverage, off: Array
           ) -> tuple[EdgeRegistration, ...]:
    part, lattices = problem.part, problem.lattices
    edges = [edge for edge in part.edges if edge.faces]
    number = np.concatenate([np.full(len(edge.points), k) for k, edge in enumerate(part.edges) if edge.faces])
    nominal = np.concatenate([edge.points for edge in edges])
    first, last = (np.concatenate([np.full(len(edge.points), edge.faces[k]) for edge in edges]) for k in (0, -1))
    samples = places_on_faces(part.faces, lattices, first, np.concatenate([edge.uv[0] for edge in edges]))
    points = samples.nominal[0] + samples.displacement(state.control_points)
    near = seen.edge_near(problem.widest_margin)
    gaps = [seen.gap_of(face, nominal) for face in (first, last)]
    gap = np.maximum(np.minimum(*gaps) - near, 0.0)
    flags = _better(seen.flags(gaps[0], first, near), seen.flags(gaps[1], last, near))
    spans = nearest_spans(lattices, problem.cells, np.concatenate([first, last]), np.tile(nominal, (2, 1)))
    bands = edge_bands(problem, covariance, errors, samples, directions(points, number), gap,
                       off[spans].reshape(2, -1).max(axis=0))
    result = []
    for index, edge in enumerate(part.edges):
        own = number == index
        result.append(EdgeRegistration(edge.name, points[own], bands[own], flags[own], _most(flags[own]),
                                       _rms(bands[own])))
    return tuple(result)


def _better(first: Flags, second: Flags) -> Flags:
    """The stronger of two flags: an edge is observed if either of its faces is observed there."""
    order = {OBSERVED: 0, BRIDGED: 1, CARRIED: 2}
    rank = np.minimum([order[f] for f in first], [order[f] for f in second])
    return np.array([OBSERVED, BRIDGED, CARRIED])[rank]


def _most(flags: Flags) -> Flag:
    if not len(flags):
        return "carried"
    names, count = np.unique(flags, return_counts=True)
    return cast(Flag, str(names[np.argmax(count)]))


def _rms(bands: Array) -> float:
    return float(np.sqrt(np.mean(bands**2))) if len(bands) else float("inf")
