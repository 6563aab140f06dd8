# SPDX-License-Identifier: LGPL-2.1-or-later
"""Planes, lines, circles and cylinders by least squares."""
from __future__ import annotations

import numpy as np

from ..registration.arrays import Array

_STEPS = 30
_STILL = 1e-13


def fit_plane(points: Array, along: Array) -> tuple[Array, Array]:
    """Mean point (3,) and unit normal (3,) of points (n, 3), on the side of the direction ``along``."""
    middle = points.mean(axis=0)
    normal = np.linalg.svd(points - middle, full_matrices=False)[2][2]
    return middle, normal * (1.0 if normal @ along >= 0 else -1.0)


def fit_line(points: Array, along: Array) -> tuple[Array, Array]:
    """Mean point (3,) and unit direction (3,) of points (n, 3), on the side of the direction ``along``."""
    middle = points.mean(axis=0)
    direction = np.linalg.svd(points - middle, full_matrices=False)[2][0]
    return middle, direction * (1.0 if direction @ along >= 0 else -1.0)


def fit_circle(points: Array, axis: Array) -> tuple[Array, float]:
    """Centre (3,) and radius of points (n, 3) seen along a unit ``axis`` (3,); the centre is at their mean height."""
    first, second = across(axis)
    middle = points.mean(axis=0)
    flat = (points - middle) @ np.stack([first, second], axis=1)
    centre, radius = _circle(flat)
    return middle + centre[0] * first + centre[1] * second, radius


def fit_cylinder(points: Array, axis: Array) -> tuple[Array, Array, float]:
    """Point on the axis (3,) at the points' mean height, unit direction (3,) and radius, from a nominal ``axis``.

    Notes
    -----
    Gauss-Newton on the distances from the axis: its two shifts, two tilts and the radius.
    """
    direction = axis / np.linalg.norm(axis)
    centre, radius = fit_circle(points, direction)
    for _ in range(_STEPS):
        first, second = across(direction)
        off = points - centre
        along = off @ direction
        flat = off - along[:, None] * direction
        distance = np.linalg.norm(flat, axis=1)
        unit = flat / distance[:, None]
        u, v = unit @ first, unit @ second
        rows = np.column_stack([-u, -v, -u * along, -v * along, -np.ones(len(points))])
        step = np.linalg.lstsq(rows, -(distance - radius), rcond=None)[0]
        centre = centre + step[0] * first + step[1] * second
        direction = direction + step[2] * first + step[3] * second
        direction /= np.linalg.norm(direction)
        radius += float(step[4])
        if np.abs(step[[0, 1, 4]]).max() <= _STILL * radius:
            break
    middle = centre + ((points - centre) @ direction).mean() * direction
    return middle, direction, float(radius)


def across(axis: Array) -> tuple[Array, Array]:
    """Two unit vectors across an axis and each other."""
    first = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    first /= np.linalg.norm(first)
    return first, np.cross(axis, first)


def _circle(flat: Array) -> tuple[Array, float]:
    """Centre (2,) and radius of points (n, 2): algebraic start, then Gauss-Newton on the distances."""
    rows = np.column_stack([2 * flat, np.ones(len(flat))])
    x, y, c = np.linalg.lstsq(rows, (flat**2).sum(axis=1), rcond=None)[0]
    centre, radius = np.array([x, y]), float(np.sqrt(max(c + x * x + y * y, 0.0)))
    for _ in range(_STEPS):
        off = flat - centre
        distance = np.linalg.norm(off, axis=1)
        rows = np.column_stack([-off / np.maximum(distance, 1e-300)[:, None], -np.ones(len(flat))])
        step = np.linalg.lstsq(rows, radius - distance, rcond=None)[0]
        centre, radius = centre + step[:2], radius + float(step[2])
        if np.abs(step).max() <= _STILL * max(radius, 1e-300):
            break
    return centre, radius
