# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the search for a pose starts."""
from __future__ import annotations

from functools import cache, partial

import numpy as np
from scipy.spatial.transform import Rotation

from ...arrays import Array
from ...motions import apply, even_rotations, motion
from ..evidence import UnalignedScan
from ..model import Target
from ..search_settings import SearchSettings


def starts_of(scan: UnalignedScan, kind: str, pose: Array | None = None) -> Array:
    """Poses to start from, (k, 4, 4).

    Parameters
    ----------
    scan : even points of it, and the part
    kind : "close" and "nearby", turned little from the present pose; "anywhere"; "around" a ``pose``, turned and
        shifted a little
    pose : (4, 4) that may have settled beside the right one; by default the present one
    """
    target, points, settings = scan.target, scan.sketch.points, scan.target.settings.search
    if kind == "around":
        return _starts_around(target, points, np.eye(4) if pose is None else pose)
    turns = {"close": partial(turns_up_to, settings.close_turn, settings.close_turns),
             "nearby": partial(turns_up_to, settings.nearby_turn, settings.nearby_turns),
             "anywhere": partial(even_rotations, settings.anywhere_turns)}[kind]()
    goals = points.mean(axis=0)[None] if kind == "close" else _centres(points, target.size, settings)
    if kind == "nearby":  # the last goal leaves the part where the scan is now
        goals = np.concatenate([goals, target.centre[None]])
    return np.concatenate([motion(turns, target.centre - turns @ centre) for centre in goals])


def _starts_around(target: Target, points: Array, pose: Array) -> Array:
    settings, place = target.settings.search, apply(pose, points).mean(axis=0)
    rotations = turns_up_to(settings.around_turn, settings.around_turns)
    shifts = settings.around_shift * target.size * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
    return np.concatenate([motion(rotations, place + shift - rotations @ place) for shift in shifts]) @ pose


@cache
def turns_up_to(largest: float, count: int) -> Array:
    """No turn, and turns spread evenly over those of up to ``largest`` rad; (about count, 3, 3)."""
    share = (largest - np.sin(largest)) / np.pi
    turns = Rotation.from_matrix(even_rotations(int(count / share))).as_rotvec()
    near = turns[np.linalg.norm(turns, axis=1) < largest]
    return Rotation.from_rotvec(np.concatenate([np.zeros((1, 3)), near])).as_matrix()


def _centres(points: Array, size: float, settings: SearchSettings) -> Array:
    """Where the part may be in the scan: the centroid, or places spread over a scan larger than the part."""
    middle = points.mean(axis=0)
    if np.linalg.norm(np.ptp(points, axis=0)) < settings.one_centre * size:
        return middle[None]
    centres = [middle]
    distance = np.linalg.norm(points - middle, axis=1)
    while len(centres) < settings.centres and distance.max() > settings.other_centre * size:
        far = points[np.argmax(distance)]
        around = points[np.linalg.norm(points - far, axis=1) < settings.centre_reach * size].mean(axis=0)
        centres.append(around)
        distance = np.minimum(distance, np.minimum(np.linalg.norm(points - around, axis=1),
                                                   np.linalg.norm(points - far, axis=1)))
    return np.array(centres)
