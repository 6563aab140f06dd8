# SPDX-License-Identifier: LGPL-2.1-or-later
"""What edited faces agree on along their edges.

Each face was registered by itself; where two of them meet, their displacements differ by noise or more. A scan shows
how a face moves along its normal but hardly how it slides within itself. So along a shared edge, and at a vertex, each
edited face determines the displacement along its own normal, and in the remaining directions the mean is taken. Each
face spreads its correction smoothly into its own interior.
"""
from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from ...registration.splines import SplineSurface
from ..topology import edge_traces
from ..workpiece import Workpiece
from .cutoff import smooth_step
from .edge_samples import EdgeSamples, along_edge, join_samples, side_lengths
from .radial_basis import RadialField, interpolate

_FADE_FACTOR = 10.0
"""A correction fades over at least this multiple of itself (theory: the slope that it adds is then below a fifth), …"""
_FADE_SHARE = 0.25
"""… and over this share of the face's size (unit)."""
_LARGEST_CENTRES = 500
"""Centres of the radial functions of a face's correction (unit: time)."""
_SLIDING = 0.03
"""Weight of a face's displacement within itself relative to that along its normal: it decides where the normals are
nearly parallel (unit: along its normal a face is known far better)."""
AT_VERTICES = 1e-7
"""In the vertices faces meet within this, in mm (theory: Open CASCADE's own precision, 1e-7: readers of STEP mend what
is farther apart)."""
_TEARING_GAP = 1e-8
"""Sides of a seam, or directions at a pole, that differ by more than this, in mm, tear the face (theory: a tenth of
Open CASCADE's precision)."""


@dataclass(frozen=True)
class Side:
    """One edited face along its edges.

    Attributes
    ----------
    rows : (m,) samples of its edges
    own : (m, 3) its own displacement there in mm; on a seam the mean of both sides, at a pole of all of it
    normals : (m, 3) unit normals of the face there, 0 where it has none
    torn : (m,) whether the face disagrees with itself there: a pole that moves unevenly, a seam of a displacement that
        is not periodic
    """

    rows: NDArray[np.intp]
    own: Array
    normals: Array
    torn: NDArray[np.bool_]


@dataclass(frozen=True)
class Rim:
    """The edges of the edited faces and how they move.

    Attributes
    ----------
    samples : points along all edges of the edited faces
    displacement : (n, 3) what the faces agree on, in mm
    dispute : (n,) disagreement of the faces there in mm, of each mainly along its normal; fades along edges
    sides : for each edited face, its own displacement along its edges
    """

    samples: EdgeSamples
    displacement: Array
    dispute: Array
    sides: dict[int, Side]


def agree(workpiece: Workpiece, displacements: Mapping[int, SplineSurface], spacing: Mapping[int, float]) -> Rim:
    """Sample the edges of the edited faces and reconcile the faces' displacements there.

    Parameters
    ----------
    workpiece : the shape
    displacements : displacement of each edited face over its (u, v)
    spacing : for each edited face, the largest distance in mm of samples on its edges
    """
    topology = workpiece.topology
    finest: dict[int, float] = {}
    for face in displacements:
        for edge in topology.face_edges[face]:
            finest[edge] = min(finest.get(edge, np.inf), spacing[face])
    samples = join_samples(along_edge(workpiece, edge, _even_spacing(step))
                           for edge, step in sorted(finest.items()))
    sides = {face: _side(workpiece, face, displacement, samples) for face, displacement in displacements.items()}
    agreed = _along_edges(samples, sides)
    _close_at_vertices(workpiece, samples, sides, agreed)
    sizes = [np.linalg.norm(side_lengths(workpiece.faces[face])) for face in sides]
    dispute = _spread_out(samples.points, _disagreement(sides, agreed), _FADE_SHARE * float(np.mean(sizes)))
    return Rim(samples, agreed, dispute, sides)


def _even_spacing(step: float) -> Callable[[Array], Array]:
    """The same spacing in mm at all points (n, 3)."""
    return lambda points: np.full(len(points), step)


def _disagreement(sides: Mapping[int, Side], agreed: Array) -> Array:
    """Largest distance in mm between the compromise and where one face alone would have put it, (n,)."""
    matrix = np.zeros((len(agreed), 3, 3))
    for side in sides.values():
        np.add.at(matrix, side.rows, _directional_weight(side.normals))
    dispute = np.zeros(len(agreed))
    for side in sides.values():
        pull = np.einsum("nij,nj->ni", _directional_weight(side.normals), side.own - agreed[side.rows])
        distance = np.linalg.norm(np.linalg.solve(matrix[side.rows], pull[:, :, None])[:, :, 0], axis=1)
        np.maximum.at(dispute, side.rows, distance)
    return dispute


def _spread_out(points: Array, values: Array, radius: float) -> Array:
    """For each point the largest value around it, fading linearly to 0 at the radius; values are taken in lots of 8."""
    starts = np.arange(0, len(values), 8)
    largest = np.maximum.reduceat(values, starts)
    places = points[np.minimum(starts + 4, len(points) - 1)][largest > 0.0]
    if len(places) == 0:
        return values
    pairs = cKDTree(points).sparse_distance_matrix(cKDTree(places), radius, output_type="ndarray")
    spread = values.copy()
    np.maximum.at(spread, pairs["i"], largest[largest > 0.0][pairs["j"]] * (1.0 - pairs["v"] / radius))
    return spread


def _side(workpiece: Workpiece, face: int, displacement: SplineSurface, samples: EdgeSamples) -> Side:
    rows, parameters, on_seam = [], [], []
    periodic = displacement.periodic_u or displacement.periodic_v
    for edge in workpiece.topology.face_edges[face]:
        at = np.flatnonzero(samples.edges == edge)
        pole = workpiece.topology.degenerate[edge]
        fractions = np.linspace(0.0, 1.0, 17) if pole else samples.fractions[at]
        seam = (face, edge) in workpiece.topology.seams and not pole and not periodic
        for trace in edge_traces(workpiece.faces[face].face, workpiece.edges[edge], fractions):
            rows.append(np.repeat(at, len(fractions)) if pole else at)
            parameters.append(trace.uv)
            on_seam.append(np.full(len(fractions), seam))
    uv = np.concatenate(parameters)
    values = displacement(uv)
    unique, inverse, count = np.unique(np.concatenate(rows), return_inverse=True, return_counts=True)
    mean = np.zeros((len(unique), 3))
    np.add.at(mean, inverse, values)
    mean /= count[:, None]
    torn = np.concatenate(on_seam) | (np.linalg.norm(values - mean[inverse], axis=1) > _TEARING_GAP)
    surface = workpiece.faces[face].surface
    normals = np.zeros((len(unique), 3))
    np.add.at(normals, inverse, _unit(np.cross(surface.derivative(1, 0)(uv), surface.derivative(0, 1)(uv))))
    return Side(unique, mean, _unit(normals), np.bincount(inverse, torn) > 0)


def _unit(vectors: Array) -> Array:
    """(n, 3) at length 1; what is almost 0 beside the longest becomes 0."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 1e-6 * length.max(initial=1e-300))


def _along_edges(samples: EdgeSamples, sides: Mapping[int, Side]) -> Array:
    rows = np.concatenate([side.rows for side in sides.values()])
    return _compromise(rows, np.concatenate([side.own for side in sides.values()]),
                       np.concatenate([side.normals for side in sides.values()]), len(samples.points))


def _compromise(place: NDArray[np.intp], own: Array, normals: Array, count: int) -> Array:
    """What the faces at each place agree on: argmin over d of Σ (nᵀ(d − own))² + s |d − own|², (count, 3).

    Parameters
    ----------
    place : (m,) the place that a face speaks for; every place has one or more
    own, normals : (m, 3) its displacement and its unit normal there
    """
    say = _directional_weight(normals)
    matrix, right = np.zeros((count, 3, 3)), np.zeros((count, 3))
    np.add.at(matrix, place, say)
    np.add.at(right, place, np.einsum("nij,nj->ni", say, own))
    return np.linalg.solve(matrix, right[:, :, None])[:, :, 0]


def _directional_weight(normals: Array) -> Array:
    """Weight of a face's displacement in each direction: nnᵀ + s, (n, 3, 3)."""
    return normals[:, :, None] * normals[:, None, :] + _SLIDING * np.eye(3)


def _close_at_vertices(workpiece: Workpiece, samples: EdgeSamples, sides: Mapping[int, Side], agreed: Array) -> None:
    """Shift the agreed displacement near the ends of each edge, so that edges meet in their vertices; in place."""
    ends = _ends(workpiece, samples)
    by_row = defaultdict(list)
    for row, vertex in ends:
        by_row[row].append(vertex)
    vertices, own, normals = [], [], []
    for side in sides.values():
        here: dict[int, list[int]] = defaultdict(list)
        for k in np.flatnonzero(np.isin(side.rows, list(by_row))):
            for vertex in by_row[side.rows[k]]:
                here[vertex].append(k)
        for vertex, found in here.items():
            vertices.append(vertex)
            own.append(side.own[found].mean(axis=0))
            normals.append(side.normals[found].sum(axis=0))
    numbers, places = np.unique(vertices, return_inverse=True)
    at_vertex = dict(zip(numbers.tolist(), _compromise(places, np.array(own), _unit(np.array(normals)), len(numbers)),
                         strict=True))
    offsets = {row: at_vertex[vertex] - agreed[row] for row, vertex in ends}
    sizes = {face: float(np.linalg.norm(side_lengths(workpiece.faces[face]))) for face in sides}
    for edge in np.unique(samples.edges):
        rows = np.flatnonzero(samples.edges == edge)
        if len(rows) == 1:
            agreed[rows] += offsets[rows[0]]
            continue
        size = max(sizes[face] for face in workpiece.topology.edge_faces[edge] if face in sizes)
        along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(samples.points[rows], axis=0), axis=1)))
        for end, distance in ((rows[0], along), (rows[-1], along[-1] - along)):
            fade = min(along[-1], max(_FADE_FACTOR * float(np.linalg.norm(offsets[end])), _FADE_SHARE * size))
            agreed[rows] += (1.0 - smooth_step(distance / fade))[:, None] * offsets[end]


def _ends(workpiece: Workpiece, samples: EdgeSamples) -> list[tuple[int, int]]:
    """(sample, vertex) for the first and the last sample of every edge."""
    ends = []
    for edge in np.unique(samples.edges):
        rows = np.flatnonzero(samples.edges == edge)
        numbers = workpiece.topology.edge_vertices[edge]
        vertices = np.array([tuple(vertex.Point) for vertex in workpiece.edges[edge].Vertexes])
        for row in {int(rows[0]), int(rows[-1])}:
            nearest = np.linalg.norm(vertices - samples.points[row], axis=1).argmin()
            ends.append((row, numbers[nearest]))
    return ends


def spread(rim: Rim, face: int, size: float, tolerance: float, part: float = 0.0) -> RadialField | None:
    """The correction of one face as a field that fades into it; None where it agrees with its neighbours already.

    Parameters
    ----------
    rim : the agreement
    face : index of an edited face
    size : the face's size in mm
    tolerance : what counts as agreement, in mm
    part : this part of the largest correction will do, too
    """
    side = rim.sides[face]
    correction = rim.displacement[side.rows] - side.own
    largest = np.linalg.norm(correction, axis=1).max()
    if largest <= tolerance:
        return None
    tolerances = np.full(len(side.rows), max(tolerance, part * largest))
    if part == 0.0:
        tolerances[rim.samples.at_vertices[side.rows]] = AT_VERTICES
    return interpolate(rim.samples.points[side.rows], correction, tolerances,
                       max(_FADE_FACTOR * largest, _FADE_SHARE * size),
                       _LARGEST_CENTRES)
