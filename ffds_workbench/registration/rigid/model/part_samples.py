# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nominal model as the rigid registration sees it: samples of the trimmed faces with normals and curvature.

A scan point is compared with the *surface*, not with the sampled cloud: the nearest sample's tangent plane and second
fundamental form give the height over the face with an error of the third order in the sample spacing.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, cKDTree

from ...arrays import Array
from ...scan_points import workers
from ..settings import RigidSettings
from .rims import Rims

Result = TypeVar("Result")
_FLAT_SHADOW = 1e-9
"""Width of a projection over its length below which it has no area (theory: far above rounding)."""


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
    everywhere : of all faces, seen or not
    even : m samples that stand for equal areas
    views : (k, 3) directions from the part to a camera
    visible : (k, m) whether a camera there sees the even sample
    rims : where the faces visibly end
    settings : how scans are aligned with it
    """

    samples: SurfaceSamples
    everywhere: SurfaceSamples
    even: SurfaceSamples
    views: Array
    visible: NDArray[np.bool_]
    rims: Rims
    settings: RigidSettings

    @cached_property
    def kept(self) -> dict[Any, Any]:
        """What ``kept_with_target`` caches."""
        return {}

    @cached_property
    def sees(self) -> NDArray[np.float32]:
        """``visible`` in numbers, to be multiplied with."""
        return self.visible.astype(np.float32)

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree of the samples."""
        return cKDTree(self.samples.points)

    @cached_property
    def _sided_tree(self) -> cKDTree:
        return cKDTree(np.hstack([self.samples.points, self._turn_length * self.samples.normals]))

    @cached_property
    def _turn_length(self) -> float:
        return self.settings.samples.turn_length * self.size

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
        facing = np.einsum("ni,ni->n", normals, self.samples.normals[index]) > self.settings.samples.facing_cosine
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
    def whole(self) -> Target:
        """The same with all of the part's surface: what can be seen has ragged borders deep inside of it."""
        return replace(self, samples=self.everywhere)

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
        return max(ConvexHull(points).volume for points in pictures  # edge on, a plane face is a line
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
    """Caches with the target what ``compute`` derives from the model alone, for the next scans."""
    @wraps(compute)
    def kept(target: Target) -> Result:
        if compute not in target.kept:
            target.kept[compute] = compute(target)
        result: Result = target.kept[compute]
        return result
    return kept
