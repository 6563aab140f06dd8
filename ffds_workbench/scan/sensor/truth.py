# SPDX-License-Identifier: LGPL-2.1-or-later
"""The ground truth of a simulated scan: points and edges of the part before and after its deformation."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from .camera import sees
from .settings import SensorSettings
from .simulate import cameras, in_field
from .target import Scene, inside_outlines

EDGE_SAMPLES = 200
_SPACING = 1.2
_LEAST_SAMPLES, _LARGEST_SAMPLES = 120, 3000
_SHEET_POINTS = 600
_CONTACT_SEARCH = 2.0
"""A point this close to a corner of a face's cells may have its foot on the face."""


@dataclass(frozen=True)
class Truth:
    """Ground truth in mm.

    Attributes
    ----------
    nominal, warped : (n, 3) points of the faces before and after; ``face`` (n,) their face's index
    visible : (n,) whether a view sees the point (all of them without views)
    views : (k, 3) unit directions to the cameras
    edges_nominal, edges : (m, 200, 3) points along every edge, in the shape's own order, before and after
    sheet_i, sheet_face, sheet_t : of a sheet, indices of points, the face opposite, and the distance to it after
    T_scan_model : (4, 4), the frame of the part in the scan
    """

    nominal: Array
    warped: Array
    face: NDArray[np.intp]
    visible: NDArray[np.bool_]
    views: Array
    edges_nominal: Array
    edges: Array
    sheet_i: NDArray[np.intp]
    sheet_face: NDArray[np.intp]
    sheet_t: Array
    T_scan_model: Array

    def write(self, path: Path) -> None:
        """Write as a compressed numpy archive, one array per attribute."""
        with path.open("wb") as file:
            np.savez_compressed(file, **self.__dict__)


def make_truth(target: Scene, settings: SensorSettings, edges_nominal: Array, edges: Array,
               thickness: float | None = None) -> Truth:
    """The truth of what ``simulate(target, settings)`` scans.

    Parameters
    ----------
    edges_nominal, edges : (m, 200, 3) points along the edges before and after the deformation
    thickness : of the part, if it is a sheet
    """
    rng = np.random.default_rng(settings.seed)
    area = np.array([cells.area.sum() for cells in target.cells])
    samples = target.sample(np.clip(area / _SPACING**2, _LEAST_SAMPLES, _LARGEST_SAMPLES) / np.maximum(area, 1e-12),
                            rng)
    seen = np.zeros(len(samples), dtype=bool)
    for camera, depths in cameras(target, settings):
        inside = in_field(camera.project(samples.points)[0], settings)
        seen |= inside & sees(camera, depths, samples.points, samples.normals, settings.grazing)
    nominal = np.empty_like(samples.points)
    for i in range(len(target.faces)):
        of_face = samples.face == i
        nominal[of_face] = target.nominal(i, samples.uv[of_face])
    pairs = _sheet(target, nominal, samples.points, samples.face, samples.uv, thickness, rng)
    directions = np.array([view.direction for view in settings.views], dtype=float).reshape(-1, 3)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return Truth(nominal, samples.points, samples.face, seen if settings.views else ~seen, directions,
                 edges_nominal, edges, *pairs, np.eye(4))


def _sheet(target: Scene, nominal: Array, warped: Array, face: NDArray[np.intp], uv: Array, thickness: float | None,
           rng: np.random.Generator) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Points whose opposite skin lies one thickness behind them, that skin's face, and the distance to it now."""
    empty = np.zeros(0, dtype=np.intp)
    if thickness is None:
        return empty, empty, np.zeros(0)
    plain = Scene(target.faces)
    index, opposite, distance = [], [], []
    candidates = rng.permutation(len(face))[: 4 * _SHEET_POINTS]
    behind = np.empty((len(candidates), 3))
    for i in np.unique(face[candidates]):
        mine = face[candidates] == i
        behind[mine] = nominal[candidates[mine]] - thickness * _normals(plain, i, uv[candidates[mine]])
    for j in range(len(target.faces)):
        near = np.flatnonzero((face[candidates] != j) & (_grid_tree(plain, j)[1].query(behind)[0] < _CONTACT_SEARCH))
        if not len(near):
            continue
        start, gap = foot(plain, j, behind[near])
        pair = (gap < 1e-4) & inside_outlines(target.faces[j].trims, start)
        mine = candidates[near[pair]]
        index.append(mine)
        opposite.append(np.full(len(mine), j))
        distance.append(foot(target, j, warped[mine], start[pair])[1])
    if not index:
        return empty, empty, np.zeros(0)
    pairs, faces, distances = np.concatenate(index), np.concatenate(opposite), np.concatenate(distance)
    pick = rng.permutation(len(pairs))[:_SHEET_POINTS]
    return pairs[pick], faces[pick], distances[pick]


def _normals(target: Scene, i: int, uv: Array) -> Array:
    a, b = _tangents(target, i, uv)
    normal = target.faces[i].outward * np.cross(a, b)
    return normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]


def _tangents(target: Scene, i: int, uv: Array) -> tuple[Array, Array]:
    """Derivatives of the displaced surface by central differences, (n, 3) each."""
    u0, u1, v0, v1 = target.faces[i].surface.range
    result = []
    for step in (np.array([1e-5 * (u1 - u0), 0.0]), np.array([0.0, 1e-5 * (v1 - v0)])):
        ahead, back = np.minimum(uv + step, (u1, v1)), np.maximum(uv - step, (u0, v0))
        length = np.abs(ahead - back).sum(axis=1)[:, None]
        result.append((target.points(i, ahead) - target.points(i, back)) / length)
    return result[0], result[1]


def _grid_tree(target: Scene, i: int) -> tuple[Array, cKDTree]:
    """(u, v) at the corners of a face's cells, and a tree of the points there."""
    cells = target.cells[i]
    grid = np.stack(np.meshgrid(cells.u, cells.v, indexing="ij"), axis=-1).reshape(-1, 2)
    return grid, cKDTree(target.points(i, grid))


def foot(target: Scene, i: int, points: Array, start: Array | None = None, steps: int = 12) -> tuple[Array, Array]:
    """Foot points on a displaced face: (u, v) (n, 2) and distance (n,), by Gauss-Newton from ``start`` or a grid."""
    if start is None:
        grid, tree = _grid_tree(target, i)
        start = grid[tree.query(points)[1]]
    u0, u1, v0, v1 = target.faces[i].surface.range
    uv = start
    for _ in range(steps):
        a, b = _tangents(target, i, uv)
        r = points - target.points(i, uv)
        aa, ab, bb = (a * a).sum(1), (a * b).sum(1), (b * b).sum(1)
        ra, rb = (a * r).sum(1), (b * r).sum(1)
        det = np.maximum(aa * bb - ab * ab, 1e-12 * aa * bb + 1e-300)
        uv = np.clip(uv + np.stack([bb * ra - ab * rb, aa * rb - ab * ra], axis=1) / det[:, None], (u0, v0), (u1, v1))
    return uv, np.linalg.norm(points - target.points(i, uv), axis=1)
