# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the joint solve needs of a workpiece: all faces, every edge sampled on its faces, and the solids."""
from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..registration.joint import JointPart, SharedEdge
from . import topology
from .workpiece import Workpiece

EDGE_SAMPLES = 33
"""Samples of an edge (unit: more than any span of a lattice needs)."""


def joint_part(workpiece: Workpiece, freeze: Iterable[str] = ()) -> JointPart:
    """The faces of a workpiece as the joint solve sees them.

    Parameters
    ----------
    freeze : names of faces that must not move

    Raises
    ------
    InputError : there is no face of such a name
    """
    adjacency = workpiece.topology
    count = len(workpiece.faces)
    frozen = frozenset(workpiece.index(name) for name in freeze)
    return JointPart(tuple(workpiece.geometry(i) for i in range(count)), shared_edges(workpiece, adjacency),
                     _solids(adjacency.solid_faces, count), frozen)


def shared_edges(workpiece: Workpiece, adjacency: topology.Topology,
                 samples: int = EDGE_SAMPLES) -> tuple[SharedEdge, ...]:
    """Every edge with its parameters on each face that it bounds, a seam twice on the same face."""
    fractions = np.linspace(0.0, 1.0, samples)
    edges = []
    for index, edge in enumerate(workpiece.shape.Edges):
        faces, uv, left, points = [], [], [], topology.points_on_edge(edge, fractions)
        for face in adjacency.edge_faces[index]:
            own = workpiece.faces[face].face
            use = own.Edges[adjacency.face_edges[face].index(index)]  # turned as the face's loop runs
            traces = topology.edge_traces(own, use, fractions)
            faces += [face] * len(traces)
            uv += [trace.uv for trace in traces]
            left += [use.Orientation == "Forward", use.Orientation != "Forward"][: len(traces)]
        edges.append(SharedEdge(f"Edge{index + 1}", tuple(faces), tuple(uv), tuple(left), points,
                                adjacency.degenerate[index]))
    return tuple(edges)


def _solids(solid_faces: topology.Incidence, count: int) -> tuple[np.ndarray, ...]:
    """Faces of each solid; a face of two solids counts to the first, faces of none are a group of their own."""
    owner = np.full(count, len(solid_faces))
    for number in reversed(range(len(solid_faces))):
        owner[list(solid_faces[number])] = number
    groups = (np.flatnonzero(owner == number) for number in range(len(solid_faces) + 1))
    return tuple(group for group in groups if len(group))
