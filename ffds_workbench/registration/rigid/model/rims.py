# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the part's faces visibly end: this constrains a scan in directions that the surfaces leave free."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array
from ...face_geometry import FaceGeometry
from ...trims import inside_polylines
from ..settings import RimSettings


@dataclass(frozen=True, eq=False)
class Rims:
    """Points on edges beyond which the surface does not go on.

    Attributes
    ----------
    points : (n, 3) in mm
    outwards : (n, 3) unit vectors in the tangent plane of the face, across the edge, away from the face
    normals : (n, 3) outward unit vectors of the face
    face : (n,) index of the face
    stretch : (n,) number of the short stretch of edge, some samples long, that the point belongs to
    step : distance in mm between neighbours on an edge
    settings : how ends of a scan are found along them
    """

    points: Array
    outwards: Array
    normals: Array
    face: NDArray[np.intp]
    stretch: NDArray[np.intp]
    step: float
    settings: RimSettings

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree of the points."""
        return cKDTree(self.points)

    @cached_property
    def middles(self) -> Array:
        """Middle of each stretch; (m, 3) in mm."""
        return self._means(self.points)

    @cached_property
    def outward_directions(self) -> Array:
        """Direction out of the face at each stretch; (m, 3) unit vectors."""
        means = self._means(self.outwards)
        return means / np.maximum(np.linalg.norm(means, axis=1, keepdims=True), 1e-12)

    @cached_property
    def faces(self) -> Array:
        """Direction of the face's normal at each stretch; (m, 3)."""
        return self._means(self.normals)

    def _means(self, values: Array) -> Array:
        count = np.maximum(np.bincount(self.stretch), 1)
        return np.stack([np.bincount(self.stretch, values[:, k]) / count for k in range(3)], axis=1)

    @cached_property
    def partner(self) -> NDArray[np.intp]:
        """For each point the one beside it on the other face of the same edge, itself where there is none; (n,)."""
        near = self.tree.query(self.points, k=min(4, len(self.points)))[1].reshape(len(self.points), -1)
        other = self.face[near] != self.face[:, None]
        beside = np.linalg.norm(self.points[near] - self.points[:, None], axis=2) < self.step
        found = other & beside
        return np.where(found.any(axis=1), near[np.arange(len(near)), found.argmax(axis=1)], np.arange(len(near)))

    @cached_property
    def _clear(self) -> dict[float, NDArray[np.bool_]]:
        return {}

    @cached_property
    def across(self) -> NDArray[np.intp]:
        """For each point the one on the other side of a sheet, itself where there is none; (n,)."""
        settings, count = self.settings, min(self.settings.sheet_neighbours, len(self.points))
        near = self.tree.query(self.points, k=count)[1].reshape(len(self.points), -1)
        found = (self.normals[near] * self.normals[:, None]).sum(axis=2) < -settings.opposite_cosine
        found &= (self.outwards[near] * self.outwards[:, None]).sum(axis=2) > settings.opposite_cosine
        return np.where(found.any(axis=1), near[np.arange(len(near)), found.argmax(axis=1)], np.arange(len(near)))

    def clear(self, depth: float) -> NDArray[np.bool_]:
        """At which points no other one is nearer to what lies ``depth`` mm inside the face; (n,)."""
        if depth not in self._clear:
            self._clear[depth] = self.tree.query(self.points - depth * self.outwards)[0] > 0.9 * depth
        return self._clear[depth]

    @cached_property
    def _grid(self) -> tuple[Array, float, NDArray[np.int32]]:
        """Lower corner (3,) and edge length in mm of voxels, and the nearest point of each (nx, ny, nz), −1 where none
        is near."""
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        length = float((high - low).max())
        voxel, near = length / self.settings.voxels, self.settings.near * length
        low = low - near
        shape = np.ceil((high + near - low) / voxel).astype(int) + 1
        middles = low + (np.moveaxis(np.indices(shape), 0, -1).reshape(-1, 3) + 0.5) * voxel
        nearest = self.tree.query(middles, distance_upper_bound=near, workers=-1)[1].astype(np.int32)
        return low, voxel, np.where(nearest < len(self.points), nearest, np.int32(-1)).reshape(shape)

    def nearest(self, points: Array, pose: Array) -> NDArray[np.int32]:
        """For points (n, 3) moved by a pose (4, 4) the point of the rims that is the nearest, to within a voxel, and −1
        where none is near: (n,). A look-up instead of a search."""
        if not len(self.points):
            return np.full(len(points), -1, dtype=np.int32)
        low, voxel, table = self._grid
        place = (pose[:3, :3] / voxel) @ points.T + ((pose[:3, 3] - low) / voxel)[:, None]
        x, y, z = np.floor(place, out=place).astype(np.int32)
        nx, ny, nz = table.shape
        inside = (x >= 0) & (x < nx) & (y >= 0) & (y < ny) & (z >= 0) & (z < nz)
        return np.where(inside, table.ravel().take(np.where(inside, (x * ny + y) * nz + z, 0)), np.int32(-1))

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
        index = self.nearest(points, np.eye(4))
        outwards = self.outwards[index]
        beyond = np.einsum("ni,ni->n", points - self.points[index], outwards)
        near = (index >= 0) & (beyond < gate) & (self.face[index] == face)
        return np.where(near, np.maximum(beyond, 0.0), 0.0), outwards


def rims_of(faces: Sequence[FaceGeometry], points: Array, normals: Array, spacing: float,
            settings: RimSettings) -> Rims:
    """Find the rims.

    Parameters
    ----------
    points, normals : (m, 3) samples of all faces; where they go on smoothly across an edge, it is no rim
    spacing : distance in mm between the samples
    settings : where a face goes on, and how its rims are sampled
    """
    pieces = [_edge_points(face, k, 0.5 * spacing, settings) for k, face in enumerate(faces)]
    places, outwards, outer_normals, face, part = (np.concatenate(column) for column in zip(*pieces, strict=True))
    tree = cKDTree(points)
    ahead = places + settings.ahead * spacing * outwards
    distance, index = tree.query(ahead, k=4, distance_upper_bound=1.5 * spacing)
    padded_points = np.concatenate([points, [[np.inf] * 3]])
    padded_normals = np.concatenate([normals, np.zeros((1, 3))])
    beyond = np.einsum("nki,ni->nk", padded_points[index] - places[:, None], outwards) > 0.3 * spacing
    smooth = np.einsum("nki,ni->nk", padded_normals[index], outer_normals) > settings.smooth_cosine
    on = (np.isfinite(distance) & beyond & smooth).any(axis=1)
    stretch = np.unique(np.stack([face, part])[:, ~on], axis=1, return_inverse=True)[1]
    return Rims(places[~on], outwards[~on], outer_normals[~on], face[~on], stretch, 0.5 * spacing, settings)


def _edge_points(face: FaceGeometry, index: int, step: float, settings: RimSettings,
                 ) -> tuple[Array, Array, Array, NDArray[np.intp], NDArray[np.intp]]:
    """Points along the trims, the directions across them and out of the face, the face's outward normals, its index,
    and the number of the stretch within the face."""
    surface = face.surface
    starts, along, parts, before = [], [], [], 0
    for polyline in face.trims:
        length = np.linalg.norm(np.diff(surface(polyline), axis=0), axis=1)
        travelled = np.concatenate([[0.0], np.cumsum(length)])
        count = int(np.clip(travelled[-1] / step, 4, settings.points_per_loop))
        at = (np.arange(count) + 0.5) / count * travelled[-1]
        segment = np.clip(np.searchsorted(travelled, at, side="right") - 1, 0, len(length) - 1)
        share = (at - travelled[segment]) / np.maximum(length[segment], 1e-300)
        run = np.diff(polyline, axis=0)[segment]
        starts.append(polyline[segment] + share[:, None] * run)
        along.append(run)
        parts.append(before + np.arange(count) // settings.stretch_points)
        before = int(parts[-1][-1]) + 1
    uv, direction, part = np.concatenate(starts), np.concatenate(along), np.concatenate(parts)
    su, sv = surface.derivative(1, 0)(uv), surface.derivative(0, 1)(uv)
    tangent = su * direction[:, :1] + sv * direction[:, 1:]
    normal = face.outward * np.cross(su, sv)
    fine = (np.linalg.norm(tangent, axis=1) > 1e-12) & (np.linalg.norm(normal, axis=1) > 1e-12)
    uv, su, sv, tangent, normal, part = (column[fine] for column in (uv, su, sv, tangent, normal, part))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    across = np.cross(normal, tangent)
    across /= np.linalg.norm(across, axis=1)[:, None]
    # parameters of a small step across the edge tell which side is the face
    a, b, c = (np.einsum("ni,ni->n", x, y) for x, y in ((su, su), (su, sv), (sv, sv)))
    e, f = np.einsum("ni,ni->n", su, across), np.einsum("ni,ni->n", sv, across)
    determinant = np.maximum(a * c - b * b, 1e-300)
    small = 0.02 * step * np.stack([(c * e - b * f) / determinant, (a * f - b * e) / determinant], axis=1)
    inside = inside_polylines(face.trims, uv + small)
    across *= np.where(inside, -1.0, 1.0)[:, None]
    return surface(uv), across, normal, np.full(len(uv), index), part
