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
_MOST_CENTRES = 250


@dataclass(frozen=True)
class Rim:
    """The edges of the edited faces and how they move.

    Attributes
    ----------
    samples : points along all edges of the edited faces
    displacement : (n, 3) what the faces agree on, in mm
    corrections : for each edited face, ``(samples of its edges (m,), agreed minus its own displacement (m, 3))``
    """

    samples: EdgeSamples
    displacement: Array
    corrections: dict[int, tuple[NDArray[np.intp], Array]]


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
    own = {face: _along_own_edges(workpiece, face, displacement, samples) for face, displacement in displacements.items()}
    agreed = _means(samples, own)
    _close_at_vertices(workpiece, samples, own, agreed)
    corrections = {face: (rows, agreed[rows] - values) for face, (rows, values) in own.items()}
    return Rim(samples, agreed, corrections)


def _along_own_edges(workpiece: Workpiece, face: int, displacement: SplineSurface,
                     samples: EdgeSamples) -> tuple[NDArray[np.intp], Array]:
    """A face's own displacement at the samples of its edges; on a seam the mean of both sides, at a pole of all of it."""
    rows, parameters = [], []
    for edge in workpiece.topology.face_edges[face]:
        at = np.flatnonzero(samples.edges == edge)
        pole = workpiece.topology.degenerate[edge]
        fractions = np.linspace(0.0, 1.0, 17) if pole else samples.fractions[at]
        for trace in edge_traces(workpiece.faces[face].face, workpiece.edges[edge], fractions):
            rows.append(np.repeat(at, len(fractions)) if pole else at)
            parameters.append(trace.uv)
    row = np.concatenate(rows)
    unique, inverse, count = np.unique(row, return_inverse=True, return_counts=True)
    total = np.zeros((len(unique), 3))
    np.add.at(total, inverse, displacement(np.concatenate(parameters)))
    return unique, total / count[:, None]


def _means(samples: EdgeSamples, own: Mapping[int, tuple[NDArray[np.intp], Array]]) -> Array:
    total, count = np.zeros((len(samples.points), 3)), np.zeros(len(samples.points))
    for rows, values in own.values():
        total[rows] += values
        count[rows] += 1
    return total / count[:, None]


def _close_at_vertices(workpiece: Workpiece, samples: EdgeSamples, own: Mapping[int, tuple[NDArray[np.intp], Array]],
                       agreed: Array) -> None:
    """Shift the agreed displacement along each edge, linearly, so that edges meet in their vertices; in place."""
    ends = _ends(workpiece, samples)
    by_row = defaultdict(list)
    for row, vertex in ends:
        by_row[row].append(vertex)
    at_vertex: dict[int, list[Array]] = defaultdict(list)
    for rows, values in own.values():
        here: dict[int, list[Array]] = defaultdict(list)
        for row, value in zip(rows, values, strict=True):
            for vertex in by_row.get(row, ()):
                here[vertex].append(value)
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
    rows, correction = rim.corrections[face]
    largest = np.linalg.norm(correction, axis=1).max()
    if largest <= tolerance:
        return None
    return interpolate(rim.samples.points[rows], correction, np.full(len(rows), tolerance),
                       max(_GENTLE * largest, _SPREAD * size), _MOST_CENTRES)
