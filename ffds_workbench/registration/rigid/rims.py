# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the part's faces visibly end: they hold a scan in directions that the surface itself leaves free."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..face import FaceGeometry
from ..splines import Array
from .trimmed import inside_trims

_MOST_PER_FACE = 1500


@dataclass(frozen=True, eq=False)
class Rims:
    """Points on edges beyond which the surface does not go on.

    Attributes
    ----------
    points : (n, 3) in mm
    outwards : (n, 3) unit vectors in the tangent plane of the face, across the edge, away from the face
    face : (n,) index of the face
    """

    points: Array
    outwards: Array
    face: NDArray[np.intp]

    @cached_property
    def tree(self) -> cKDTree:
        return cKDTree(self.points)

    def overshoot(self, points: Array, face: NDArray[np.intp], gate: float) -> tuple[Array, Array]:
        """How far points stick out of the face they are matched with, beyond its rim.

        Parameters
        ----------
        points : (n, 3) in mm
        face : (n,) index of the face each is matched with
        gate : in mm; points farther from any rim count as inside

        Returns
        -------
        overshoot : (n,) in mm, 0 inside
        outwards : (n, 3)
        """
        if not len(self.points):
            return np.zeros(len(points)), np.zeros((len(points), 3))
        distance, index = self.tree.query(points, distance_upper_bound=gate)
        near = np.isfinite(distance)
        index = np.where(near, index, 0)
        outwards = self.outwards[index]
        beyond = np.einsum("ni,ni->n", points - self.points[index], outwards)
        return np.where(near & (self.face[index] == face), np.maximum(beyond, 0.0), 0.0), outwards


def rims_of(faces: Sequence[FaceGeometry], points: Array, normals: Array, spacing: float) -> Rims:
    """Find the rims.

    Parameters
    ----------
    points, normals : (m, 3) samples of all faces; where they go on smoothly across an edge, it is no rim
    spacing : distance in mm between the samples
    """
    pieces = [_edge_points(face, k, 0.5 * spacing) for k, face in enumerate(faces)]
    places, outwards, outer_normals, face = (np.concatenate(column) for column in zip(*pieces, strict=True))
    tree = cKDTree(points)
    ahead = places + 1.2 * spacing * outwards
    distance, index = tree.query(ahead, k=4, distance_upper_bound=1.5 * spacing)
    padded_points = np.concatenate([points, [[np.inf] * 3]])
    padded_normals = np.concatenate([normals, np.zeros((1, 3))])
    beyond = np.einsum("nki,ni->nk", padded_points[index] - places[:, None], outwards) > 0.3 * spacing
    smooth = np.einsum("nki,ni->nk", padded_normals[index], outer_normals) > 0.8
    on = (np.isfinite(distance) & beyond & smooth).any(axis=1)
    return Rims(places[~on], outwards[~on], face[~on])


def _edge_points(face: FaceGeometry, index: int, step: float) -> tuple[Array, Array, Array, NDArray[np.intp]]:
    """Points along the trims, the directions across them and out of the face, and the face's outward normals."""
    surface = face.surface
    starts, along = [], []
    for polyline in face.trims:
        length = np.linalg.norm(np.diff(surface(polyline), axis=0), axis=1)
        travelled = np.concatenate([[0.0], np.cumsum(length)])
        count = int(np.clip(travelled[-1] / step, 4, _MOST_PER_FACE))
        at = (np.arange(count) + 0.5) / count * travelled[-1]
        segment = np.clip(np.searchsorted(travelled, at, side="right") - 1, 0, len(length) - 1)
        share = (at - travelled[segment]) / np.maximum(length[segment], 1e-300)
        run = np.diff(polyline, axis=0)[segment]
        starts.append(polyline[segment] + share[:, None] * run)
        along.append(run)
    uv, direction = np.concatenate(starts), np.concatenate(along)
    su, sv = surface.derivative(1, 0)(uv), surface.derivative(0, 1)(uv)
    tangent = su * direction[:, :1] + sv * direction[:, 1:]
    normal = face.outward * np.cross(su, sv)
    fine = (np.linalg.norm(tangent, axis=1) > 1e-12) & (np.linalg.norm(normal, axis=1) > 1e-12)
    uv, su, sv, tangent, normal = uv[fine], su[fine], sv[fine], tangent[fine], normal[fine]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    across = np.cross(normal, tangent)
    across /= np.linalg.norm(across, axis=1)[:, None]
    # parameters of a small step across the edge tell which side is the face
    a, b, c = (np.einsum("ni,ni->n", x, y) for x, y in ((su, su), (su, sv), (sv, sv)))
    e, f = np.einsum("ni,ni->n", su, across), np.einsum("ni,ni->n", sv, across)
    determinant = np.maximum(a * c - b * b, 1e-300)
    small = 0.02 * step * np.stack([(c * e - b * f) / determinant, (a * f - b * e) / determinant], axis=1)
    inside = inside_trims(face.trims, uv + small)
    across *= np.where(inside, -1.0, 1.0)[:, None]
    return surface(uv), across, normal, np.full(len(uv), index)
