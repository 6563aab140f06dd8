# SPDX-License-Identifier: LGPL-2.1-or-later
"""Takes the shots and fuses them: the virtual sensor, top to bottom."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...errors import RefusedError
from ...registration.arrays import Array
from . import errors
from .camera import Camera, DepthPicture, depth_picture, pixel_size, place, sees
from .settings import SensorSettings
from .target import Scene

_NEARNESS = 1.6
"""Points are drawn this much denser than the picture's, for surfaces nearer to the camera than the stand-off."""

_AROUND = 8.0
"""How far the background reaches beyond the part in the picture, in mm."""

OUTLIER, TABLE = -1, -2


@dataclass(frozen=True)
class SimulatedScan:
    """A scan and where it comes from.

    Attributes
    ----------
    points : (n, 3) in mm, all shots fused
    face : (n,) index of the face a point lies on; −1 for an outlier, −2 for the background
    shot : (n,) which view took it; −1 without views and for outliers
    poses : per shot the 4×4 motion by which it is misplaced
    """

    points: Array
    face: NDArray[np.intp]
    shot: NDArray[np.intp]
    poses: tuple[Array, ...]


@dataclass(frozen=True)
class _Shot:
    points: Array
    face: NDArray[np.intp]


def simulate(target: Scene, settings: SensorSettings) -> SimulatedScan:
    """Scan a target.

    Raises
    ------
    RefusedError : no view sees anything of the target
    """
    rng = np.random.default_rng(settings.seed)
    shots = [_shot(target, camera, depths, settings, settings.table if i == 0 else None, rng)
             for i, (camera, depths) in enumerate(cameras(target, settings))]
    if not settings.views:
        shots = [_everywhere(target, settings, rng)]
    if not any(len(shot.points) for shot in shots):
        raise RefusedError("The views see nothing of the part: turn or aim them at it.")
    poses = tuple(errors.pose_error(target.centre, settings.pose_error, settings.pose_error_angle, rng) for _ in shots)
    points = np.concatenate([shot.points @ T[:3, :3].T + T[:3, 3] for shot, T in zip(shots, poses, strict=True)])
    face = np.concatenate([shot.face for shot in shots])
    number = np.repeat(np.arange(len(shots)) if settings.views else [-1], [len(shot.points) for shot in shots])
    kept = ~errors.in_holes(points, settings.holes, settings.hole_radius, rng)
    points, face, number = points[kept], face[kept], number[kept]
    gross = errors.outliers(points, settings.outliers, settings.outlier_margin, rng)
    points = np.concatenate([points, gross])
    face = np.concatenate([face, np.full(len(gross), OUTLIER)])
    number = np.concatenate([number, np.full(len(gross), -1)])
    order = rng.permutation(len(points))
    return SimulatedScan(points[order], face[order], number[order], poses)


def cameras(target: Scene, settings: SensorSettings) -> list[tuple[Camera, DepthPicture]]:
    """The camera of every view and its depth picture of the target."""
    if not settings.views:
        return []
    low, high = target.box
    pixel = pixel_size(float(np.linalg.norm(high - low)))
    dense = target.grid(0.5 * pixel)
    placed = [place(view, target.centre, settings.standoff) for view in settings.views]
    return [(camera, depth_picture(camera, dense, pixel, settings.field)) for camera in placed]


def in_field(picture: Array, settings: SensorSettings) -> NDArray[np.bool_]:
    """Which picture coordinates (n, 2) lie in the field of view; (n,)."""
    return (np.abs(picture) <= 0.5 * np.array(settings.field)).all(axis=1)


def _everywhere(target: Scene, settings: SensorSettings, rng: np.random.Generator) -> _Shot:
    samples = target.sample(settings.spacing**-2, rng)
    if settings.edge_dropout:
        boundary = target.boundary(0.25 * settings.edge_band)
        beside = np.isfinite(cKDTree(boundary).query(samples.points, distance_upper_bound=settings.edge_band)[0])
        samples = samples[~(beside & (rng.random(len(samples)) < settings.edge_dropout))]
    heights = errors.noise(samples.points, settings.noise, settings.correlation, settings.correlated_share, rng)
    return _Shot(samples.points + heights[:, None] * samples.normals, samples.face)


def _shot(target: Scene, camera: Camera, depths: DepthPicture, settings: SensorSettings, table: float | None,
          rng: np.random.Generator) -> _Shot:
    """One shot: what is seen, as dense as the picture is, with noise along the lines of sight."""
    samples = target.sample(_NEARNESS * settings.spacing**-2, rng)
    picture, _ = camera.project(samples.points)
    kept = rng.random(len(samples)) < camera.magnification(samples.points, samples.normals) / _NEARNESS
    kept &= in_field(picture, settings) & sees(camera, depths, samples.points, samples.normals, settings.grazing)
    if settings.edge_dropout:
        beside = depths.beside_jump(picture, settings.edge_band)
        kept &= ~(beside & (rng.random(len(samples)) < settings.edge_dropout))
    points, face = samples.points[kept], samples.face[kept]
    if table is not None:
        background = _table(target, camera, depths, settings, table, rng)
        points = np.concatenate([points, background])
        face = np.concatenate([face, np.full(len(background), TABLE)])
    if len(points) > settings.limit:
        pick = rng.permutation(len(points))[: settings.limit]
        points, face = points[pick], face[pick]
    picture, _ = camera.project(points)
    along = errors.noise(picture, settings.noise, settings.correlation, settings.correlated_share, rng)
    return _Shot(points + along[:, None] * camera.towards(points), face)


def _table(target: Scene, camera: Camera, depths: DepthPicture, settings: SensorSettings, distance: float,
           rng: np.random.Generator) -> Array:
    """Points of the flat background, where the part does not hide it; (n, 3)."""
    seen, depth = camera.project(target.grid(2.0))
    half = 0.5 * np.array(settings.field)
    low, high = np.maximum(seen.min(axis=0) - _AROUND, -half), np.minimum(seen.max(axis=0) + _AROUND, half)
    count = int((high - low).clip(0).prod() / settings.spacing**2)
    picture = rng.uniform(low, high, (count, 2))
    return camera.on_plane(picture[~np.isfinite(depths.at(picture))], float(depth.max()) + distance)
