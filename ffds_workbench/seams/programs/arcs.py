# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where poses lie on circles: fewer points for the controller, and a smoother path."""
from __future__ import annotations

from collections.abc import Collection

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from ...registration.arrays import Array

TOLERANCE = 0.02
"""In mm: how far stations may lie off the circle. Stations follow the seam within 0.05 mm; this keeps well
within (unit)."""
_TURN = np.radians(0.5)
"""How far in rad the torch may be turned off what the controller makes of an arc: an even turn from start to end
(unit)."""
_WIDEST, _FEWEST_STEPS = np.radians(170.0), 4
"""Controllers take no arcs of half a turn and more; fewer steps are as well told as lines."""


def arcs_of(poses: Array, breaks: Collection[int] = ()) -> tuple[tuple[int, int, int], ...]:
    """Stations (start, middle, end) of the longest arcs, one after the other, along poses (n, 4, 4).

    Parameters
    ----------
    breaks : stations at which something is written, so that no arc may pass them
    """
    arcs, start = [], 0
    while start < len(poses) - _FEWEST_STEPS:
        until = min((station for station in breaks if station > start), default=len(poses) - 1)
        end = _longest(poses[: until + 1], start)
        if end is None:
            start += 1
        else:
            arcs.append((start, (start + end) // 2, end))
            start = end
    return tuple(arcs)


def _longest(poses: Array, start: int) -> int | None:
    best, low, high = None, start + _FEWEST_STEPS, len(poses) - 1
    # What is an arc is one as far as any shorter part of it: halving finds where it ends.
    while low <= high:
        middle = (low + high + 1) // 2 if best is not None else low
        if _is_arc(poses[start : middle + 1]):
            best, low = middle, middle + 1
        elif best is None:
            return None
        else:
            high = middle - 1
    return best


def _is_arc(poses: Array) -> bool:
    points = poses[:, :3, 3]
    a, b, c = points[0], points[(len(points) - 1) // 2], points[-1]
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal)
    if size < 1e-6:
        return False
    # The centre of the circle through three points, from a: Cramer's rule in their plane.
    ab, ac = b - a, c - a
    centre = a + (np.dot(ac, ac) * np.cross(normal, ab) - np.dot(ab, ab) * np.cross(normal, ac)) / (2.0 * size**2)
    off = points - centre
    across = np.cross(normal / size, off[0])
    radius = np.linalg.norm(off[0])
    flat = np.abs(off @ normal) / size
    round_ = np.abs(np.linalg.norm(off, axis=1) - radius)
    angles = np.unwrap(np.arctan2(off @ across / radius, off @ off[0] / radius))
    if max(flat.max(), round_.max()) > TOLERANCE or angles[-1] > _WIDEST or (np.diff(angles) <= 0.0).any():
        return False
    rotations = Rotation.from_matrix(poses[:, :3, :3])
    even = Slerp([0.0, angles[-1]], rotations[[0, -1]])(np.clip(angles, 0.0, angles[-1]))
    return bool((even.inv() * rotations).magnitude().max() <= _TURN)
