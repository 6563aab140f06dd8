# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plane that a part stands on, distinguished from the part's own planes by what lies around it."""
from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from ...registration.arrays import Array
from ...registration.robust_weights import robust_sigma
from ...registration.scan_points import TablePlane
from . import library

_SAMPLE = 20000
_TRIALS, _PLANES = 1000, 5
"""Trials of RANSAC for a plane, and how many planes are looked at, the largest first."""
_NOISE_RATIO = 1.0 / 500.0
"""A first guess of how thick a plane is, as a part of the scan's size; the scan then tells how thick it is."""
_ROUNDS = 10
_EMPTY, _THINNEST = 0.01, 3.0
"""A plane ends where there are fewer than the first times as many points as at its middle, and not within the second
times its noise."""
_IN_FRONT, _WITHIN, _WIDER = 3.0, 0.9, 1.1
"""Theory: what stands on a table is on one side of it, so many times as many points as behind; so much of that lies
within the table's outline, and the outline is so many times as large: a side of a part is as large as the part."""


def find_table(points: Array) -> TablePlane | None:
    """The largest plane in points (n, 3) near the origin that the others stand on; None where there is none.

    The plane is looked for by open3d's RANSAC among some of the points, then fitted to all points near it.
    """
    open3d = library.open3d("removing the table")
    open3d.utility.random.seed(0)
    rest = points[np.random.default_rng(0).permutation(len(points))[:_SAMPLE]]
    sample = rest
    guess = _NOISE_RATIO * float(np.linalg.norm(np.ptp(sample, axis=0)))
    for _ in range(_PLANES):
        if len(rest) < 10:
            return None
        (*normal, offset), _ = library.cloud(open3d, rest).segment_plane(guess, 3, _TRIALS)
        plane = _fitted(sample, np.array(normal), -offset, guess)
        if _stood_on(plane, sample):
            return plane
        rest = rest[np.abs(rest @ normal + offset) > guess]
    return None


def _fitted(points: Array, normal: Array, height: float, guess: float) -> TablePlane:
    """The plane fitted to the points about it, and how thick it is on either side."""
    heights, noise = points @ normal - height, guess
    for _ in range(_ROUNDS):
        near = points[np.abs(heights) < _THINNEST * noise]
        centre = near.mean(axis=0)
        normal = np.linalg.svd(near - centre, full_matrices=False)[2][2]
        heights = (points - centre) @ normal
        inside = np.abs(heights[np.abs(heights) < _THINNEST * noise])
        noise = max(robust_sigma(inside), 1e-9 * guess)
    if (heights > guess).sum() < (heights < -guess).sum():
        normal, heights = -normal, -heights
    return TablePlane(normal, float(centre @ normal), _reach(-heights, noise), _reach(heights, noise))


def _reach(heights: Array, noise: float) -> float:
    """How far a plane reaches to the side where the heights are positive: to where hardly a point is."""
    width = 0.5 * noise
    counts = np.histogram(heights, width * np.arange(0.0, 101.0))[0]
    few = counts[int(_THINNEST / 0.5):] < _EMPTY * counts[:2].mean()
    return _THINNEST * noise + width * float(np.argmax(few) if few.any() else 0)


def _stood_on(plane: TablePlane, points: Array) -> bool:
    """Whether the points that are not of the plane stand on it."""
    heights = plane.heights(points)
    front = heights > plane.above
    own = ~front & (heights > -plane.below)
    if front.sum() < 10 or own.sum() < 10 or front.sum() < _IN_FRONT * (heights < -plane.below).sum():
        return False
    flat = points @ np.linalg.svd(plane.normal[None])[2][1:].T
    try:
        outline = ConvexHull(flat[own])
        within = (flat[front] @ outline.equations[:, :2].T + outline.equations[:, 2] <= 0.0).all(axis=1)
        standing = flat[front][within]
        away = np.linalg.norm(standing - np.median(standing, axis=0), axis=1)
        footprint = ConvexHull(standing[away <= np.quantile(away, 0.95)])
    except (QhullError, ValueError):  # nothing but a line
        return False
    return bool(within.mean() > _WITHIN and outline.volume > _WIDER * footprint.volume)
