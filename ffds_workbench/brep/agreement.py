# SPDX-License-Identifier: LGPL-2.1-or-later
"""What edited faces agree on along their edges.

Each face was registered by itself; where two of them meet, their displacements differ by noise or more. Along a shared
edge the mean of its edited faces holds, at a vertex the mean of all edited faces there, and each face spreads its
correction smoothly into its own interior.
"""
from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..registration.splines import Array, SplineSurface
from .radial import RadialField, interpolate
from .samples import EdgeSamples, along_edge, join
from .topology import edge_traces
from .workpiece import Workpiece

_GENTLE = 10.0
"""A correction fades over at least this multiple of itself …"""
_SPREAD = 0.25
"""… and over this part of the face's size."""
_MOST_CENTRES = 500
_EVEN = 1e-8
"""Sides of a seam, or directions at a pole, that differ by more than this (mm) tear the face."""


@dataclass(frozen=True)
class Side:
    """One edited face along its edges.

    Attributes
    ----------
    rows : (m,) samples of its edges
    own : (m, 3) its own displacement there in mm; on a seam the mean of both sides, at a pole of all of it
    torn : (m,) whether the face disagrees with itself there: a pole that moves unevenly, a seam of a displacement that
        is not periodic
    """

    rows: NDArray[np.intp]
    own: Array
    torn: NDArray[np.bool_]


@dataclass(frozen=True)
class Rim:
    """The edges of the edited faces and how they move.

    Attributes
    ----------
    samples : points along all edges of the edited faces
    displacement : (n, 3) what the faces agree on, in mm
    sides : for each edited face, its own displacement along its edges
    """

    samples: EdgeSamples
    displacement: Array
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
    samples = join(along_edge(workpiece, edge, lambda points, s=step: np.full(len(points), s))
                   for edge, step in sorted(finest.items()))
    sides = {face: _side(workpiece, face, displacement, samples) for face, displacement in displacements.items()}
    agreed = _means(samples, sides)
    _close_at_vertices(workpiece, samples, sides, agreed)
    return Rim(samples, agreed, sides)


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
    values = displacement(np.concatenate(parameters))
    unique, inverse, count = np.unique(np.concatenate(rows), return_inverse=True, return_counts=True)
    mean = np.zeros((len(unique), 3))
    np.add.at(mean, inverse, values)
    mean /= count[:, None]
    torn = np.concatenate(on_seam) | (np.linalg.norm(values - mean[inverse], axis=1) > _EVEN)
    return Side(unique, mean, np.bincount(inverse, torn) > 0)


def _means(samples: EdgeSamples, sides: Mapping[int, Side]) -> Array:
    total, count = np.zeros((len(samples.points), 3)), np.zeros(len(samples.points))
    for side in sides.values():
        total[side.rows] += side.own
        count[side.rows] += 1
    return total / count[:, None]


def _close_at_vertices(workpiece: Workpiece, samples: EdgeSamples, sides: Mapping[int, Side], agreed: Array) -> None:
    """Shift the agreed displacement along each edge, linearly, so that edges meet in their vertices; in place."""
    ends = _ends(workpiece, samples)
    by_row = defaultdict(list)
    for row, vertex in ends:
        by_row[row].append(vertex)
    at_vertex: dict[int, list[Array]] = defaultdict(list)
    for side in sides.values():
        here: dict[int, list[Array]] = defaultdict(list)
        for k in np.flatnonzero(np.isin(side.rows, list(by_row))):
            for vertex in by_row[side.rows[k]]:
                here[vertex].append(side.own[k])
        for vertex, found in here.items():
            at_vertex[vertex].append(np.mean(found, axis=0))
    offsets = {row: np.mean(at_vertex[vertex], axis=0) - agreed[row] for row, vertex in ends}
    for edge in np.unique(samples.edges):
        rows = np.flatnonzero(samples.edges == edge)
        weight = samples.fractions[rows][:, None]
        first, last = offsets[rows[0]], offsets[rows[-1]]
        agreed[rows] += (1.0 - weight) * first + weight * last


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


def spread(rim: Rim, face: int, size: float, tolerance: float) -> RadialField | None:
    """The correction of one face as a field that fades into it; None where it agrees with its neighbours already.

    Parameters
    ----------
    rim : the agreement
    face : index of an edited face
    size : the face's size in mm
    tolerance : what counts as agreement, in mm
    """
    side = rim.sides[face]
    correction = rim.displacement[side.rows] - side.own
    largest = np.linalg.norm(correction, axis=1).max()
    if largest <= tolerance:
        return None
    return interpolate(rim.samples.points[side.rows], correction, np.full(len(side.rows), tolerance),
                       max(_GENTLE * largest, _SPREAD * size), _MOST_CENTRES)
