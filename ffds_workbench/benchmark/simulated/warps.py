# SPDX-License-Identifier: LGPL-2.1-or-later
"""Known deformations of space, in closed form: points (n, 3) in mm to points (n, 3) in mm."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .profile import Profile

Array = NDArray[np.float64]
Warp = Callable[[Array], Array]


def still(points: Array) -> Array:
    """Nothing moves."""
    return points


def roll(radius: float, axis_angle: float, middle: Array) -> Warp:
    """Roll the plane z = middle_z on a cylinder of that radius: an exact isometry of the plane, thickness kept.

    The cylinder's axis lies parallel to the plane, turned by ``axis_angle`` from y; at ``middle`` nothing moves.
    """
    c, s = np.cos(axis_angle), np.sin(axis_angle)
    across, along, up = np.array([c, s, 0.0]), np.array([-s, c, 0.0]), np.array([0.0, 0.0, 1.0])

    def warp(points: Array) -> Array:
        local = points - middle
        angle = (local @ across) / radius
        arm = radius + local @ up
        return (middle + (arm * np.sin(angle))[:, None] * across + (local @ along)[:, None] * along
                + (arm * np.cos(angle) - radius)[:, None] * up)

    return warp


def springback(profile: Profile, factor: float, held: int) -> Warp:
    """Open the bends of a sheet whose profile lies in (x, z): lengths of the neutral line and the thickness stay."""
    opened = profile.opened(factor, held)

    def warp(points: Array) -> Array:
        result = points.copy()
        result[:, [0, 2]] = opened.point(*profile.coordinates(points[:, [0, 2]]))
        return result

    return warp


def bend(amplitude: float, axis: int, along: int, box: tuple[Array, Array]) -> Warp:
    """Shift along coordinate ``axis`` by a parabola over coordinate ``along``: ±amplitude/2 from ends to middle."""
    low, high = box

    def warp(points: Array) -> Array:
        x = (2 * points[:, along] - low[along] - high[along]) / (high[along] - low[along])
        result = points.copy()
        result[:, axis] += amplitude * (x**2 - 0.5)
        return result

    return warp


def twist(angle: float, along: int, box: tuple[Array, Array]) -> Warp:
    """Turn each cross-section about the line through the box's middle, from −angle/2 to angle/2 over ``along``."""
    low, high = box
    first, second = (k for k in range(3) if k != along)

    def warp(points: Array) -> Array:
        middle = 0.5 * (low + high)
        turn = angle * (points[:, along] - middle[along]) / (high[along] - low[along])
        c, s = np.cos(turn), np.sin(turn)
        a, b = points[:, first] - middle[first], points[:, second] - middle[second]
        result = points.copy()
        result[:, first], result[:, second] = middle[first] + c * a - s * b, middle[second] + s * a + c * b
        return result

    return warp


def bumps(amplitude: float, width: float, count: int, box: tuple[Array, Array], rng: np.random.Generator) -> Warp:
    """A sum of Gaussian bumps of that width at random places of the box, each in a random direction."""
    low, high = box
    places = rng.uniform(low, high, (count, 3))
    directions = rng.normal(size=(count, 3))
    directions *= amplitude / np.linalg.norm(directions, axis=1)[:, None]

    def warp(points: Array) -> Array:
        result = points.copy()
        for place, direction in zip(places, directions, strict=True):
            weight = np.exp(-((points - place) ** 2).sum(axis=1) / (2 * width**2))
            result += weight[:, None] * direction
        return result

    return warp


def bump(middle: Array, height: Array, width: float) -> Warp:
    """One Gaussian bump of that width: ``middle`` (3,) moves by ``height`` (3,)."""
    return lambda points: points + np.exp(-((points - middle) ** 2).sum(axis=1) / (2 * width**2))[:, None] * height


def chain(*warps: Warp) -> Warp:
    """One deformation after the other."""

    def warp(points: Array) -> Array:
        for one in warps:
            points = one(points)
        return points

    return warp


def scaled(warp: Warp, amplitude: float, points: Array) -> Warp:
    """The same deformation with its displacements multiplied, so that ``points`` move ``amplitude`` mm at most."""
    factor = amplitude / np.linalg.norm(warp(points) - points, axis=1).max()
    return lambda x: x + factor * (warp(x) - x)
