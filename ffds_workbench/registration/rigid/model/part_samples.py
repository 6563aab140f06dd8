# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nominal model as the rigid registration sees it: samples of the trimmed faces with normals and curvature.

A scan point is compared with the *surface*, not with the sampled cloud: the nearest sample's tangent plane and second
fundamental form give the height over the face with an error of the third order in the sample spacing.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, cKDTree

from ...arrays import Array
from ...face_geometry import FaceGeometry
from ...motions import even_directions
from ...parallel import workers
from ...trims import inside_polylines
from .rims import Rims, rims_of

Result = TypeVar("Result")
_SAMPLE_COUNT = 24_000
_EVEN_COUNT = 2_500
_VIEW_COUNT = 64
_AREA_GRID = 40
_LARGEST_TURN = 0.35
"""Largest angle (rad) that a face may turn between two samples before it is sampled more densely."""
_TURN_LENGTH = 0.04
"""A normal turned by 1 rad counts as this share of the part's size in the search for the nearest sample."""
_FACING_COSINE = 0.3
"""Cosine below which a sample does not face the way a point's normal does."""
_GRAZING_COSINE = 0.15
"""Cosine under which a surface is too oblique for a camera to see it."""

_FLAT_SHADOW = 1e-9
"""Width of a shadow, as a share of its length, that is none."""
_FACE_ON_COSINE = 0.6
"""Cosine from which a view proves that a sample can be seen: the depth buffer is too coarse for obliquer ones."""


@dataclass(frozen=True)
class SurfaceSamples:
    """Points of the nominal faces.

    Attributes
    ----------
    points, normals : (n, 3) in mm and outward unit vectors
    tangents : (n, 2, 3) orthonormal frame in the tangent plane
    curvature : (n, 3) second fundamental form (h11, h12, h22) in that frame, in 1/mm, along the outward normal
    area : (n,) area in mm² that the sample stands for
    face : (n,) index of the face
    """

    points: Array
    normals: Array
    tangents: Array
    curvature: Array
    area: Array
    face: NDArray[np.intp]

    def __getitem__(self, chosen: NDArray) -> SurfaceSamples:
        return SurfaceSamples(self.points[chosen], self.normals[chosen], self.tangents[chosen], self.curvature[chosen],
                              self.area[chosen], self.face[chosen])


@dataclass(frozen=True, eq=False)
class Target:
    """The nominal model to register against. Use ``target_of`` to make one; it serves any number of scans.

    Attributes
    ----------
    samples : what can be seen of the faces from anywhere outside
    even : m samples that stand for equal areas
    views : (k, 3) directions from the part to a camera
    visible : (k, m) whether a camera there sees the even sample
    rims : where the faces visibly end
    """

    samples: SurfaceSamples
    even: SurfaceSamples
    views: Array
    visible: NDArray[np.bool_]
    rims: Rims

    @cached_property
    def kept(self) -> dict[Any, Any]:
        """What ``kept_with_target`` keeps."""
        return {}

    @cached_property
    def sees(self) -> NDArray[np.float32]:
        """``visible`` in numbers, to be multiplied with."""
        return self.visible.astype(np.float32)

    @cached_property
    def tree(self) -> cKDTree:
        return cKDTree(self.samples.points)

    @cached_property
    def _sided_tree(self) -> cKDTree:
        return cKDTree(np.hstack([self.samples.points, self._turn_length * self.samples.normals]))

    @cached_property
    def _turn_length(self) -> float:
        return _TURN_LENGTH * self.size

    def nearest(self, points: Array, normals: Array | None, reach: float) -> tuple[Array, NDArray[np.intp]]:
        """Nearest sample, or where normals are given, the nearest one that faces about the same way.

        Parameters
        ----------
        points : (n, 3) in mm
        normals : (n, 3) outward unit vectors, or None
        reach : in mm

        Returns
        -------
        distance : (n,) in mm, infinite where nothing is within reach
        index : (n,) of the sample, 0 where nothing is within reach
        """
        if normals is None:
            distance, index = self.tree.query(points, distance_upper_bound=reach, workers=workers(points))
            return distance, np.where(np.isfinite(distance), index, 0)
        place = np.hstack([points, self._turn_length * normals])
        index = self._sided_tree.query(place, distance_upper_bound=np.hypot(reach, self._turn_length),
                                        workers=workers(points))[1]
        index = np.where(index < len(self.samples.area), index, 0)
        distance = np.linalg.norm(points - self.samples.points[index], axis=1)
        facing = np.einsum("ni,ni->n", normals, self.samples.normals[index]) > _FACING_COSINE
        return np.where(facing & (distance < reach), distance, np.inf), index

    @cached_property
    def centre(self) -> Array:
        """Area centroid in mm; (3,)."""
        return np.average(self.samples.points, axis=0, weights=self.samples.area)

    @cached_property
    def size(self) -> float:
        """Diagonal of the box of the faces in mm."""
        return float(np.linalg.norm(np.ptp(self.samples.points, axis=0)))

    @cached_property
    def spacing(self) -> float:
        """Mean distance in mm between neighbouring samples."""
        return float(np.sqrt(self.samples.area.sum() / len(self.samples.area)))

    @cached_property
    def coarse(self) -> Target:
        """The same with a quarter of the samples, for poses that are only on trial."""
        quarter = self.samples[np.arange(0, len(self.samples.area), 4)]
        return replace(self, samples=replace(quarter, area=4.0 * quarter.area))

    @cached_property
    def largest_projection(self) -> float:
        """Largest area in mm² that the part covers on a plane, of those across its principal axes."""
        arm = self.samples.points - self.centre
        axes = np.linalg.eigh(arm.T @ arm)[1]
        pictures = [arm @ np.delete(axes, k, axis=1) for k in range(3)]
        return max(ConvexHull(points).volume for points in pictures  # a plane face is a line from aside
                   if np.ptp(points, axis=0).min() > _FLAT_SHADOW * np.ptp(points))

    @cached_property
    def _forms(self) -> Array:
        """Place, normal, tangents and curvature of the samples side by side: one look-up for all; (n, 15)."""
        s = self.samples
        return np.concatenate([s.points, s.normals, s.tangents.reshape(-1, 6), s.curvature], axis=1)

    def heights(self, points: Array, nearest: NDArray[np.intp]) -> tuple[Array, Array]:
        """Signed heights of points over the faces, to second order about the nearest sample.

        Parameters
        ----------
        points : (n, 3) in mm
        nearest : (n,) indices of samples

        Returns
        -------
        height : (n,) in mm, positive outside
        normal : (n, 3) outward normal at the foot point
        """
        row = self._forms.take(nearest, axis=0)
        offset = points - row[:, :3]
        outward, first, second = row[:, 3:6], row[:, 6:9], row[:, 9:12]
        along, across, flat = (np.einsum("ni,ni->n", axis, offset) for axis in (first, second, outward))
        h11, h12, h22 = row[:, 12:].T
        slope, slope_across = h11 * along + h12 * across, h12 * along + h22 * across
        normal = outward - slope[:, None] * first - slope_across[:, None] * second
        length = np.linalg.norm(normal, axis=1)
        height = (flat - 0.5 * (slope * along + slope_across * across)) / length
        return height, normal / length[:, None]

    @cached_property
    def _beside_rim(self) -> NDArray[np.bool_]:
        """Which samples are the nearest ones to something that sticks out beyond a rim."""
        if not len(self.rims.points):
            return np.zeros(len(self.samples.area), dtype=bool)
        return np.isfinite(self.rims.tree.query(self.samples.points, distance_upper_bound=3.0 * self.spacing)[0])

    def overshoot(self, points: Array, nearest: NDArray[np.intp], gate: float) -> tuple[Array, Array]:
        """How far points stick out beyond the rim of the face they are matched with; see ``Rims.overshoot``.

        Parameters
        ----------
        points : (n, 3) in mm
        nearest : (n,) indices of samples
        gate : in mm
        """
        beyond, outwards = np.zeros(len(points)), np.zeros((len(points), 3))
        some = np.flatnonzero(self._beside_rim[nearest])
        beyond[some], outwards[some] = self.rims.overshoot(points[some], self.samples.face[nearest[some]], gate)
        return beyond, outwards


def kept_with_target(compute: Callable[[Target], Result]) -> Callable[[Target], Result]:
    """What follows from the model alone is computed for the first scan and kept for the next ones."""
    @wraps(compute)
    def kept(target: Target) -> Result:
        if compute not in target.kept:
            target.kept[compute] = compute(target)
        result: Result = target.kept[compute]
        return result
    return kept


def target_of(faces: Sequence[FaceGeometry], count: int = _SAMPLE_COUNT) -> Target:
    """Sample the faces of a part.

    Parameters
    ----------
    faces : the faces that the scan may show; faces that nothing outside can see (contacts inside an assembly) drop out
    count : how many samples to aim at

    Raises
    ------
    ValueError
        There is no face with an area.
    """
    areas = [_AreaGrid.of(face) for face in faces]
    total = sum(area.inside for area in areas)
    if not total > 0:
        raise ValueError("the faces have no area")
    spacing = np.sqrt(total / count)
    pieces = [_sample_face(face, k, area, spacing) for k, (face, area) in enumerate(zip(faces, areas, strict=True))]
    all_samples = SurfaceSamples(*(np.concatenate([getattr(piece, name) for piece in pieces])
                                   for name in ("points", "normals", "tangents", "curvature", "area", "face")))
    views = even_directions(_VIEW_COUNT)
    generator = np.random.default_rng(0)
    share = all_samples.area / all_samples.area.sum()
    rough = generator.choice(len(share), size=min(len(share), 3 * _EVEN_COUNT), replace=False, p=share)
    seen = _visibility(all_samples[rough], all_samples.points, views, np.sqrt(total / len(rough)))
    exposed_rough = (seen & (views @ all_samples.normals[rough].T > _FACE_ON_COSINE)).any(axis=0)
    exposed = exposed_rough[cKDTree(all_samples.points[rough] + 1e-3 * all_samples.normals[rough]).query(
        all_samples.points + 1e-3 * all_samples.normals)[1]]
    kept = np.flatnonzero(exposed_rough & exposed[rough])[:_EVEN_COUNT]
    samples_seen = all_samples[exposed]
    rims = rims_of(faces, samples_seen.points, samples_seen.normals, spacing)
    return Target(samples_seen, all_samples[rough[kept]], views, seen[:, kept], rims)


@dataclass(frozen=True)
class _AreaGrid:
    """Area density |S_u × S_v| of a face on a regular grid of cells over its parameter box."""

    box: tuple[float, float, float, float]
    density: Array
    inside: float

    @classmethod
    def of(cls, face: FaceGeometry) -> _AreaGrid:
        polyline = np.concatenate(face.trims)
        u0, u1, v0, v1 = face.surface.range
        (ul, vl), (uh, vh) = polyline.min(axis=0), polyline.max(axis=0)
        box = (max(u0, ul), min(u1, uh), max(v0, vl), min(v1, vh))
        u = box[0] + (np.arange(_AREA_GRID) + 0.5) / _AREA_GRID * (box[1] - box[0])
        v = box[2] + (np.arange(_AREA_GRID) + 0.5) / _AREA_GRID * (box[3] - box[2])
        cross = np.cross(face.surface.derivative(1, 0).on_grid(u, v), face.surface.derivative(0, 1).on_grid(u, v))
        density = np.linalg.norm(cross, axis=2)
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)
        within = inside_polylines(face.trims, uv).reshape(density.shape)
        cell = (box[1] - box[0]) * (box[3] - box[2]) / density.size
        return cls(box, density, float((density * within).sum() * cell))

    @property
    def whole(self) -> float:
        """Area of the parameter box in mm², trims left out of account."""
        return float(self.density.mean() * (self.box[1] - self.box[0]) * (self.box[3] - self.box[2]))

    def place(self, unit: Array) -> Array:
        """Points of the unit square (n, 2) to parameters (n, 2) even by area: inverse distribution function."""
        u0, u1, v0, v1 = self.box
        marginal = np.concatenate([[0.0], np.cumsum(self.density.sum(axis=1))])
        u = np.interp(unit[:, 0] * marginal[-1], marginal, np.linspace(0, 1, _AREA_GRID + 1))
        row = np.minimum((u * _AREA_GRID).astype(int), _AREA_GRID - 1)
        conditional = np.concatenate([np.zeros((_AREA_GRID, 1)), np.cumsum(self.density, axis=1)], axis=1)
        conditional /= np.maximum(conditional[:, -1:], 1e-300)
        position = np.empty(len(unit))
        for k in np.unique(row):
            mine = row == k
            position[mine] = np.interp(unit[mine, 1], conditional[k], np.linspace(0, 1, _AREA_GRID + 1))
        return np.stack([u0 + u * (u1 - u0), v0 + position * (v1 - v0)], axis=1)


def _sample_face(face: FaceGeometry, index: int, area: _AreaGrid, spacing: float) -> SurfaceSamples:
    """Even samples, denser where the face turns by more than `_LARGEST_TURN` between two of them."""
    probe = _evaluate(face, area.place(_r2_sequence(32)), index)
    bent = float(np.quantile(np.linalg.norm(probe.curvature, axis=1), 0.75)) * spacing / _LARGEST_TURN
    count = int(np.ceil(area.whole / spacing**2 * np.clip(bent**2, 1.0, 9.0)))
    uv = area.place(_r2_sequence(max(count, 12)))
    uv = uv[inside_polylines(face.trims, uv)]
    samples = _evaluate(face, uv, index)
    return SurfaceSamples(samples.points, samples.normals, samples.tangents, samples.curvature,
                          np.full(len(uv), area.inside / max(len(uv), 1)), samples.face)


def _r2_sequence(count: int) -> Array:
    """First points of the R2 low-discrepancy sequence in the unit square (M. Roberts, 2018); (count, 2)."""
    g = 1.32471795724474602596
    return np.mod(0.5 + np.arange(1, count + 1)[:, None] * np.array([1.0 / g, 1.0 / g**2]), 1.0)


def _evaluate(face: FaceGeometry, uv: Array, index: int) -> SurfaceSamples:
    """Points, outward frame and second fundamental form at parameters (n, 2)."""
    surface = face.surface
    su, sv = surface.derivative(1, 0)(uv), surface.derivative(0, 1)(uv)
    normal = face.outward * np.cross(su, sv)
    length = np.linalg.norm(normal, axis=1)
    regular = length > 1e-12 * max(float(length.max(initial=0.0)), 1e-300)
    uv, su, sv, normal, length = uv[regular], su[regular], sv[regular], normal[regular], length[regular]
    normal /= length[:, None]
    first = su / np.maximum(np.linalg.norm(su, axis=1), 1e-300)[:, None]
    second = np.cross(normal, first)
    forms = np.stack([np.einsum("ni,ni->n", surface.derivative(*order)(uv), normal)
                      for order in ((2, 0), (1, 1), (0, 2))], axis=1)
    # S_u = a·t1, S_v = b·t1 + c·t2, so the second form in the orthonormal frame follows by back substitution
    a, b, c = (np.einsum("ni,ni->n", x, y) for x, y in ((su, first), (sv, first), (sv, second)))
    h11 = forms[:, 0] / a**2
    h12 = (forms[:, 1] - a * b * h11) / (a * c)
    h22 = (forms[:, 2] - b * b * h11 - 2.0 * b * c * h12) / c**2
    points = surface(uv)
    return SurfaceSamples(points, normal, np.stack([first, second], axis=1), np.stack([h11, h12, h22], axis=1),
                          np.zeros(len(uv)), np.full(len(uv), index))


def _visibility(samples: SurfaceSamples, hiding: Array, views: Array, spacing: float) -> NDArray[np.bool_]:
    """Which samples an orthographic camera in each direction sees, by a depth buffer; (len(views), n).

    Parameters
    ----------
    hiding : (m, 3) points that hide what is behind them, some per pixel so that no pixel is a hole
    spacing : of the samples in mm; a pixel is twice that
    """
    visible = np.zeros((len(views), len(samples.points)), dtype=bool)
    pixel = 2.0 * spacing
    for k, view in enumerate(views):
        across = np.cross(view, np.eye(3)[np.argmin(np.abs(view))])
        across /= np.linalg.norm(across)
        axes = np.stack([across, np.cross(view, across)], axis=1)
        corner = (hiding @ axes).min(axis=0)
        behind, mine = (np.floor((points @ axes - corner) / pixel).astype(int) + 1
                        for points in (hiding, samples.points))
        width = int(behind[:, 1].max()) + 2
        top = np.full(width * (int(behind[:, 0].max()) + 2), -np.inf)
        np.maximum.at(top, behind[:, 0] * width + behind[:, 1], hiding @ view)
        key = mine[:, 0] * width + mine[:, 1]
        height = samples.points @ view
        facing = samples.normals @ view
        steepness = np.sqrt(1.0 - np.clip(facing, _GRAZING_COSINE, 1.0) ** 2) / np.maximum(facing, _GRAZING_COSINE)
        slack = pixel * (0.2 + np.sqrt(2.0) * steepness)
        visible[k] = (facing > _GRAZING_COSINE) & (height > top[key] - slack)
    return visible
