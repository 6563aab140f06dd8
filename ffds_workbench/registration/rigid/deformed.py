# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pose that fits all of a deformed part best: each place of it against where it lies without the deformation."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..splines import Array
from .ends import Beside, Ends, beside, depth_of, find_ends, width_of_ends
from .field import SOFT, Field, Pulls, fit_field
from .motions import apply, best_fit
from .target import Target, once_for_target

_GATES = (0.1, 0.05, 0.025, 0.0125, 0.006, 0.003, 0.003)
"""Least cut-off of the weights in each round, as a share of the part's size."""
_FIRST_ENDS, _COARSE = 2, 3
"""Round from which on the ends of the scan count; and rounds that are left out where a start is known, when the ends
count from the second one on."""
_WIDTH, _BLURRED, _OF_WIDTH = 0.01, 1.5, 0.2
"""Width within which the ends of a scan are counted, as a share of the part's size, and at least in standard deviations
of the noise; and height, as a share of the width, up to which a deformed part is on its face."""
_WIDE = 1.5
"""Widths in which the ends are counted at first, when they may lie farther off."""
_FOR_ENDS, _END_GATE = 1.0 / 200.0, 0.2
"""Weight of the ends for each point on a face, beyond what their own uncertainty gives them, as heights are off by what
the polynomials cannot follow; and the least cut-off in mm for them, as each is counted from few points."""
_ON = 0.008
"""Height, as a share of the part's size, up to which a point lies on it."""
_OFF, _LEAST_OFF = 6.0, 2e-3
"""Heights that make a point one beside the part: in their spread, and as a share of the part's size."""
_FEWEST = 100
_CELLS = 600
"""Pieces of the part's surface that its pose is the best fit of."""


@dataclass(frozen=True)
class Outline:
    """What of a scan the ends are looked for in.

    Attributes
    ----------
    points : (n, 3) in mm
    area : mm² that they cover
    noise : standard deviation in mm
    """

    points: Array
    area: float
    noise: float


@dataclass(frozen=True)
class Places:
    """Places of a deformed part in model coordinates in mm, and where they lie without the deformation; (n, 3)."""

    bent: Array
    straight: Array

    def moved(self, motion: Array) -> Places:
        """After the scan has moved by (4, 4)."""
        return replace(self, bent=apply(motion, self.bent))

    def straightened(self, field: Field) -> Places:
        return replace(self, straight=self.bent - field(self.bent))

    def bending(self, field: Field) -> Places:
        """With the bent places made better known by a field."""
        return replace(self, bent=self.straight + field(self.bent))


def settle(target: Target, points: Array, pose: Array, normals: Array, reach: float, outline: Outline,
           start: Array | None = None) -> Array:
    """Least-squares pose of a deformed part, over all of its surface alike.

    Distances from the faces alone leave a deformed sheet free to slide and turn in its own surface. Of the deformations
    that explain them and the places where the scan ends, the smoothest that stretches least is taken back.

    Parameters
    ----------
    points, normals : (n, 3) of the scan, scan coordinates, normals outward
    pose : (4, 4), T_model_scan to start from
    reach : in mm
    outline : of the scan, scan coordinates
    start : (n, 3) where the points nearly lie without the deformation, model coordinates, if known
    """
    size, rims = target.size, target.rims
    facing = normals @ pose[:3, :3].T
    bent = apply(pose, points)
    seen = Places(bent, bent if start is None else start)
    gates, first = (_GATES, _FIRST_ENDS) if start is None else (_GATES[_COARSE:], 1)
    border, stretches = Places(outline.points[:0], outline.points[:0]), Places(rims.middles, rims.middles)
    near = None
    for turn, gate in enumerate(gates):
        distance, nearest = target.nearest(seen.straight, facing, reach)
        height, normal = target.heights(seen.straight, nearest)
        chosen = np.isfinite(distance)
        pulls = None
        if near is not None:
            width = _width(target, outline, _WIDE if turn == first else 1.0)
            ends = find_ends(rims, border.straight, width, 4.0 * outline.noise + _OF_WIDTH * width, near)
            pulls = _pulls(ends, stretches, len(points))
        wanted = height + np.einsum("ni,ni->n", normal, seen.bent - seen.straight)
        field = fit_field(seen.bent, normal, wanted, height, chosen, target.samples.tangents[nearest], gate * size,
                          size, SOFT, pulls)
        seen = seen.straightened(field)
        if turn == first - 1:
            turned = _far_side(target, seen.straight, facing, reach)
            facing = np.where(turned[:, None], -facing, facing)
            border, near = _border(target, outline, pose, field)
            stretches = stretches.bending(field)
        if turn >= first - 1:
            motion = _best_motion(target, seen, nearest, chosen)
            if motion is None:
                break
            border, stretches = border.straightened(field).moved(motion), stretches.bending(field).moved(motion)
            pose, seen, facing = motion @ pose, seen.moved(motion), facing @ motion[:3, :3].T
    return pose


def _width(target: Target, outline: Outline, factor: float) -> float:
    return width_of_ends(target.rims, len(outline.points) / outline.area,
                         factor * max(_WIDTH * target.size, _BLURRED * outline.noise))


def _border(target: Target, outline: Outline, pose: Array, field: Field) -> tuple[Places, Beside]:
    """The points of the scan near the rims, and which of those they lie near."""
    bent = apply(pose, outline.points)
    straight = bent - field(bent)
    reach = depth_of(_width(target, outline, _WIDE))
    some = target.rims.near(straight, np.eye(4), reach)
    near = beside(target.rims, straight[some], reach)
    return Places(bent[some], straight[some]), near


def _pulls(ends: Ends, stretches: Places, count: int) -> Pulls:
    """What the ends want of the deformation, beside so many points on the faces."""
    beyond = ends.gap[:, None] * ends.outwards
    bent = stretches.bent[ends.stretch] + beyond
    wanted = np.einsum("ni,ni->n", bent - ends.places, ends.outwards)
    return Pulls(bent, ends.outwards, wanted, ends.gap, ends.weight, _END_GATE, _FOR_ENDS * count)


def _far_side(target: Target, points: Array, normals: Array, reach: float) -> NDArray[np.bool_]:
    """Which points lie on the part if their normals, model coordinates, are turned round, and else do not; (n,)."""
    off = ~_on(target, points, normals, reach)
    off[off] = _on(target, points[off], -normals[off], reach)
    return off


def _on(target: Target, points: Array, normals: Array, reach: float) -> NDArray[np.bool_]:
    distance, nearest = target.nearest(points, normals, reach)
    return np.isfinite(distance) & (np.abs(target.heights(points, nearest)[0]) < _ON * target.size)


def _best_motion(target: Target, seen: Places, nearest: NDArray[np.intp], chosen: NDArray[np.bool_]) -> Array | None:
    """Motion (4, 4) that brings the deformed part nearest to the part, over all of its surface; None of too few points.

    A piece of surface moves like the place nearest to it that is seen: the whole part counts evenly, also where the
    scan is thin or shows one side alone.
    """
    height, normal = target.heights(seen.straight, nearest)
    spread = 1.4826 * float(np.median(np.abs(height)))
    sure = chosen & (np.abs(height) < max(_OFF * spread, _LEAST_OFF * target.size))
    if sure.sum() < _FEWEST:
        return None
    foot = seen.straight[sure] - height[sure, None] * normal[sure]
    middles, area = cells_of(target)
    return best_fit(middles + (seen.bent[sure] - foot)[cKDTree(foot).query(middles)[1]], middles, area)


@once_for_target
def cells_of(target: Target) -> tuple[Array, Array]:
    """Centroids (k, 3) in mm and areas (k,) in mm² of small pieces of the surface.

    A mean over them is exact for what is linear within a piece; one over points at random has the error of a random
    sample, which tilts a bent part by some tenths of a degree.
    """
    samples, seeds = target.samples, target.even.points[:_CELLS]
    cell = cKDTree(seeds).query(samples.points)[1]
    area: Array = np.bincount(cell, samples.area, len(seeds)).astype(float)
    held = area > 0.0
    sums = np.stack([np.bincount(cell, samples.area * samples.points[:, k], len(seeds)) for k in range(3)], axis=1)
    return sums[held] / area[held, None], area[held]
