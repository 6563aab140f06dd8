# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closes the gaps that a solve over all faces leaves along edges, where its fields agree to about 1e-3 mm only.

Every face keeps its own field and adds a small correction that is exactly (agreed displacement − own displacement)
on all its edges and fades inside. Since neighbours take the same agreed displacement, edges close to the fidelity of
the correction, with lattices not much finer than the fields themselves.
"""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...registration.arrays import Array
from ...registration.splines import SplineSurface
from ..face_displacement import FaceDisplacement
from ..workpiece import Workpiece
from .agreement import Rim, agree, spread
from .edge_samples import side_lengths
from .radial_basis import RadialField

FIDELITY = 1e-5
"""Largest distance in mm of a corrected field from the agreed displacement at the samples of the edges (unit: far below
any tolerance, above what a fit leaves)."""
_SAMPLE_SPACING = 0.01
"""Distance of samples on an edge, over the size of the faces (unit: no displacement changes over less), …"""
_LEAST_SPACING = 0.25
"""… and in mm at least (unit: time)."""


@dataclass(frozen=True)
class ClosedDisplacement:
    """A face's own displacement and the correction that closes its edges; called as `FaceDisplacement.evaluate` is."""

    own: SplineSurface
    correction: RadialField | None

    def __call__(self, uv: Array, points: Array) -> Array:
        displacement = self.own(uv)
        return displacement if self.correction is None else displacement + self.correction(points)


def closing_displacements(workpiece: Workpiece,
                          displacements: Mapping[int, SplineSurface]) -> dict[int, FaceDisplacement]:
    """Displacements that agree along every edge, from fields that nearly do.

    Parameters
    ----------
    workpiece : the shape
    displacements : registered displacement of each face that moves, over its own (u, v) in mm. Faces that are not
        named stay as they are; edges and vertices that they touch are held still
    """
    sizes = {face: float(np.linalg.norm(side_lengths(workpiece.faces[face]))) for face in displacements}
    spacing = {face: max(_SAMPLE_SPACING * size, _LEAST_SPACING) for face, size in sizes.items()}
    rim = agree(workpiece, displacements, spacing)
    rim = _held(workpiece, rim, displacements)
    result = {}
    for face, displacement in sorted(displacements.items()):
        correction = spread(rim, face, sizes[face], FIDELITY)
        u0, u1, v0, v1 = displacement.range
        u, v = np.unique(displacement.knots_u), np.unique(displacement.knots_v)
        result[face] = FaceDisplacement(ClosedDisplacement(displacement, correction), u[(u > u0) & (u < u1)],
                                        v[(v > v0) & (v < v1)])
    return result


def _held(workpiece: Workpiece, rim: Rim, displacements: Mapping[int, SplineSurface]) -> Rim:
    """The agreement with edges of faces that stay at zero, and other edges brought to zero where they end on those."""
    topology, samples = workpiece.topology, rim.samples
    staying = {vertex for face, vertices in enumerate(topology.face_vertices) if face not in displacements
               for vertex in vertices}
    if not staying:
        return rim
    agreed = rim.displacement.copy()
    for edge in np.unique(samples.edges):
        rows = np.flatnonzero(samples.edges == edge)
        if any(face not in displacements for face in topology.edge_faces[edge]):
            agreed[rows] = 0.0
            continue
        places = np.array([tuple(vertex.Point) for vertex in workpiece.edges[edge].Vertexes])
        ends = [topology.edge_vertices[edge][np.linalg.norm(places - samples.points[row], axis=1).argmin()]
                for row in (rows[0], rows[-1])]
        first, last = (agreed[row] if vertex in staying else np.zeros(3)
                       for row, vertex in zip((rows[0], rows[-1]), ends, strict=True))
        share = samples.fractions[rows][:, None]
        agreed[rows] -= (1 - share) * first + share * last
    return replace(rim, displacement=agreed)
