# SPDX-License-Identifier: LGPL-2.1-or-later
"""A synthetic sheet whose deformation is a formula: scans of it, clean and dirty, and the true deviation of a result.

The sheet is 75 × 70 mm, nominally the plane z = 0. Lengths in mm.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import LSQBivariateSpline
from scipy.ndimage import gaussian_filter

from ...registration.arrays import Array
from ...registration.face_geometry import FaceGeometry
from ...registration.splines import SplineSurface, clamped_knots, greville

SIZE = (75.0, 70.0)
POINTS = 42_087
NOISE = 0.13
CORRELATION = 1.5
_HIDDEN = 0.2
_OUTLIERS, _WALL, _BELOW = 0.02, 0.04, 0.04
_PIXEL = 0.25
_JUDGED = 151
_BORDER = 400


def nominal() -> FaceGeometry:
    """The undeformed sheet, its parameters in mm."""
    knots = [clamped_knots(0.0, length, 4) for length in SIZE]
    points = np.zeros((4, 4, 3))
    points[..., 0], points[..., 1] = greville(knots[0])[:, None], greville(knots[1])[None]
    (x, y) = SIZE
    trim = np.array([[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]])
    return FaceGeometry("Sheet", "Plane", SplineSurface(knots[0], knots[1], points), (trim,), 1)


def height(x: Array, y: Array) -> Array:
    """The deformed sheet, z(x, y): a bulge of 5 mm, a bend and a twist."""
    a, b = x / 75 - 0.55, y / 70 - 0.45
    return 5 * np.exp(-(a * a + b * b) / (2 * 0.28**2)) + 5 * (x / 75 - 0.5) ** 2 + (x / 75 - 0.5) * (y / 70 - 0.5)


def scan(kind: str, seed: int, points: int = POINTS) -> Array:
    """A scan of the deformed sheet, (n, 3).

    Parameters
    ----------
    kind : "A": noise alone, σ = 0.13 mm in z. "D": a fifth of the area hidden, 2 % outliers, 4 % on a wall below one
        side and 4 % on a sheet 1.5 mm below another. "E": D with noise that is correlated over 1.5 mm
    """
    random = np.random.default_rng(seed)
    cloud = _inliers(random, kind, points)
    return cloud if kind == "A" else np.concatenate([cloud, *_clutter(random, points)])


def least_squares_deviation(kind: str, seed: int, spans: int = 7, points: int = POINTS) -> Array:
    """True deviations of plain least squares on those points of a scan that are the sheet's, which only the simulation
    knows: a bicubic spline of so many spans per direction, judged as `deviation` judges."""
    x, y, z = _inliers(np.random.default_rng(seed), kind, points).T
    knots = [np.linspace(0.0, side, spans + 1)[1:-1] for side in SIZE]
    fit = LSQBivariateSpline(x, y, z, *knots, bbox=[0.0, SIZE[0], 0.0, SIZE[1]])
    return np.abs(fit(*_grid()) - height(*np.meshgrid(*_grid(), indexing="ij"))).ravel()


def _inliers(random: np.random.Generator, kind: str, points: int) -> Array:
    """The points of the sheet itself that are seen."""
    x, y = random.uniform((0, 0), SIZE, (points, 2)).T
    noise = _correlated_noise(random, x, y) if kind == "E" else random.normal(0, NOISE, points)
    cloud = np.stack([x, y, height(x, y) + noise], axis=1)
    return cloud if kind == "A" else cloud[~_hidden(random, x, y)]


@dataclass(frozen=True)
class Bend:
    """The sheet rolled on a cylinder, arc length kept: nothing in it is stretched.

    Attributes
    ----------
    radius : of the cylinder in mm
    turn : direction of rolling from the x axis in rad
    """

    radius: float = 150.0
    turn: float = 0.5

    def at(self, x: Array, y: Array) -> Array:
        """Where the material points (x, y) are, (…, 3)."""
        c, s = np.cos(self.turn), np.sin(self.turn)
        x, y = x - SIZE[0] / 2, y - SIZE[1] / 2
        along, across = c * x + s * y, c * y - s * x
        rolled = self.radius * np.sin(along / self.radius)
        z = self.radius * (1 - np.cos(along / self.radius))
        return np.stack([c * rolled - s * across + SIZE[0] / 2, s * rolled + c * across + SIZE[1] / 2, z], axis=-1)

    def scan(self, seed: int, points: int = POINTS) -> Array:
        """A scan with σ = 0.13 mm in z, (n, 3)."""
        random = np.random.default_rng(seed)
        cloud = self.at(*random.uniform((0, 0), SIZE, (points, 2)).T)
        cloud[:, 2] += random.normal(0, NOISE, points)
        return cloud

    def deviation(self, displacement: SplineSurface) -> Array:
        """True distances of the deformed sheet from the cylinder, on a grid of material points."""
        moved = _deformed(displacement, *_grid()).reshape(-1, 3)
        c, s = np.cos(self.turn), np.sin(self.turn)
        along = c * (moved[:, 0] - SIZE[0] / 2) + s * (moved[:, 1] - SIZE[1] / 2)
        return np.abs(np.hypot(along, moved[:, 2] - self.radius) - self.radius)

    def edge_deviation(self, displacement: SplineSurface) -> Array:
        """Distances of the true border from the deformed sheet's border."""
        t, zero, one = np.linspace(0, 1, _BORDER), np.zeros(_BORDER), np.ones(_BORDER)
        sides = ((t, zero), (t, one), (zero, t), (one, t))
        border = np.concatenate([np.stack(side, axis=1) for side in sides]) * SIZE
        reached = np.concatenate([border, np.zeros((len(border), 1))], axis=1) + displacement(border)
        true = self.at(border[:, 0], border[:, 1])
        return np.array([to_polyline(true[k], reached[k]) for k in np.split(np.arange(len(border)), 4)]).ravel()


def deviation(displacement: SplineSurface) -> Array:
    """True vertical deviations of a deformed sheet from `height`, on a grid of material points; absolute."""
    moved = _deformed(displacement, *_grid()).reshape(-1, 3)
    return np.abs(moved[:, 2] - height(moved[:, 0], moved[:, 1]))


def _grid() -> tuple[Array, Array]:
    return np.linspace(0, SIZE[0], _JUDGED), np.linspace(0, SIZE[1], _JUDGED)


def _deformed(displacement: SplineSurface, x: Array, y: Array) -> Array:
    place = np.stack([*np.meshgrid(x, y, indexing="ij"), np.zeros((len(x), len(y)))], axis=-1)
    return place + displacement.on_grid(x, y)


def to_polyline(points: Array, line: Array) -> Array:
    """Distances of points from a polyline."""
    start, way = line[:-1], np.diff(line, axis=0)
    share = np.einsum("pik,ik->pi", points[:, None] - start, way) / np.maximum((way * way).sum(axis=1), 1e-300)
    nearest = start + np.clip(share, 0, 1)[..., None] * way
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def _correlated_noise(random: np.random.Generator, x: Array, y: Array) -> Array:
    shape = [int(length / _PIXEL) + 1 for length in SIZE]
    field = gaussian_filter(random.normal(size=shape), CORRELATION / _PIXEL)
    return (field * NOISE / field.std())[(x / _PIXEL).astype(int), (y / _PIXEL).astype(int)]


def _hidden(random: np.random.Generator, x: Array, y: Array) -> NDArray[np.bool_]:
    """Whether points lie in the corner or the discs that the sensor does not see."""
    gx, gy = (a.ravel() for a in np.meshgrid(np.linspace(0, SIZE[0], 151), np.linspace(0, SIZE[1], 141)))
    hidden_grid, hidden = (gx > 60) & (gy < 5), (x > 60) & (y < 5)
    while hidden_grid.mean() < _HIDDEN:
        cx, cy, radius = random.uniform(0, SIZE[0]), random.uniform(0, SIZE[1]), random.uniform(3, 7)
        hidden_grid |= np.hypot(gx - cx, gy - cy) < radius
        hidden |= np.hypot(x - cx, y - cy) < radius
    return hidden


def _clutter(random: np.random.Generator, points: int) -> tuple[Array, Array, Array]:
    """Outliers in a box, a wall that goes down 8 mm at x = 75, and a sheet 1.5 mm below that starts at y = −6."""
    outliers = random.uniform((-3, -3, -8), (78, 73, 14), (round(_OUTLIERS * points), 3))
    count = round(_WALL * points)
    y = random.uniform(0, SIZE[1], count)
    x = np.full(count, SIZE[0])
    wall = np.stack([x + random.normal(0, NOISE, count), y, height(x, y) - random.uniform(0, 8, count)], axis=1)
    count = round(_BELOW * points)
    x, y = random.uniform((0, -6), (SIZE[0], 2.5), (count, 2)).T
    below = np.stack([x, y, height(x, y) - 1.5 + random.normal(0, NOISE, count)], axis=1)
    return outliers, wall, below
