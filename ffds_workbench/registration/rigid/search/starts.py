# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the search for a pose starts."""
from __future__ import annotations

from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

from ...arrays import Array
from ...motions import apply, even_rotations, motion
from ...scan_sketch import Sketch
from ..model import Target

_AROUND_ROTATIONS, _AROUND_TURN, _AROUND_SHIFT = 16, 0.35, 0.08
"""Number of turns, their largest in rad, and the shift as a share of the part's size, of the second search around the
best pose."""
_GLOBAL_ROTATIONS = 500
_LOCAL_ROTATIONS, _LOCAL_TURN = 60, 0.7
"""Number of turns from the present pose that mode "fine" starts from, and the largest in rad."""


def starts_of(target: Target, sketch: Sketch, mode: str) -> Array:
    """Poses of the ``sketch`` on the ``target`` to start from, (k, 4, 4): ``mode`` "fine" near the present one,
    "global" anywhere."""
    if mode == "fine":
        rotations = turns_up_to(_LOCAL_TURN, _LOCAL_ROTATIONS)
        # the last one leaves the part where the scan is now
        goals = np.concatenate([_centres(sketch.points, target.size), target.centre[None]])
        return np.concatenate([motion(rotations, target.centre - rotations @ centre) for centre in goals])
    centres = _centres(sketch.points, target.size)
    rotations = even_rotations(_GLOBAL_ROTATIONS)
    return np.concatenate([motion(rotations, target.centre - rotations @ centre) for centre in centres])


def starts_around(target: Target, sketch: Sketch, pose: Array) -> Array:
    """Poses a little turned and shifted from a ``pose`` (4, 4) of the ``sketch`` on the ``target`` that may have
    settled beside the right one: (k, 4, 4)."""
    place = apply(pose, sketch.points).mean(axis=0)
    rotations = turns_up_to(_AROUND_TURN, _AROUND_ROTATIONS)
    shifts = _AROUND_SHIFT * target.size * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
    return np.concatenate([motion(rotations, place + shift - rotations @ place) for shift in shifts]) @ pose


@cache
def turns_up_to(largest: float, count: int) -> Array:
    """No turn, and turns spread evenly over those of up to ``largest`` rad; (about count, 3, 3)."""
    share = (largest - np.sin(largest)) / np.pi
    turns = Rotation.from_matrix(even_rotations(int(count / share))).as_rotvec()
    near = turns[np.linalg.norm(turns, axis=1) < largest]
    return Rotation.from_rotvec(np.concatenate([np.zeros((1, 3)), near])).as_matrix()


def _centres(points: Array, size: float, most: int = 5) -> Array:
    """Where the part may be in the scan: the centroid, or places spread over a scan larger than the part."""
    middle = points.mean(axis=0)
    if np.linalg.norm(np.ptp(points, axis=0)) < 1.4 * size:
        return middle[None]
    centres = [middle]
    distance = np.linalg.norm(points - middle, axis=1)
    while len(centres) < most and distance.max() > 0.3 * size:
        far = points[np.argmax(distance)]
        around = points[np.linalg.norm(points - far, axis=1) < 0.5 * size].mean(axis=0)
        centres.append(around)
        distance = np.minimum(distance, np.minimum(np.linalg.norm(points - around, axis=1),
                                                   np.linalg.norm(points - far, axis=1)))
    return np.array(centres)
