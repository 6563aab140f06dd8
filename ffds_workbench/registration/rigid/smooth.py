# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth deformation of space that a scan of the right part is allowed beyond its rigid pose."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..splines import Array
from .ends import find_ends, width_of_ends
from .field import SOFT, STIFF, Field, Freedom, fit_field
from .fine import gauss_newton, tukey
from .motions import angle, apply, best_fit, shift, step
from .target import Target

ROUNDS = 6
_WIDEST = 0.1
"""Gate of the first round as a share of the part's size; each round halves it."""
_SETTLED = 5e-4
"""A motion below this (rad, share of the part's size) ends the search for the pose of a deformed part."""
_WIDTH, _BLURRED, _OF_WIDTH = 0.01, 1.5, 0.2
"""Width within which the ends of a scan are counted, as a share of the part's size, and at least in standard deviations
of the noise; and height, as a share of the width, up to which a deformed part is on its face."""
_FOR_ENDS, _END_GATE = 30.0, 0.2
"""Ends weigh more than their own uncertainty gives them, as heights are off by what the polynomials cannot follow; and
the least cut-off in mm for them, as each is counted from few points."""
_ON = 0.008
"""Height, as a share of the part's size, up to which a point lies on it."""
_SLIDES, _STEPS = 1, 3
_ROUGHLY, _MORE = 1_000, 3
"""Points for the first match, and rounds of a match that starts from the last one."""


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
class Match:
    """Points of the scan matched with the part after a smooth deformation is taken back.

    Attributes
    ----------
    points : (n, 3) where the points lie without the deformation, model coordinates in mm
    distance : (n,) from the sample in mm, infinite where nothing within reach faces the same way
    nearest : (n,) index of the sample
    height, normal : (n,) in mm over the face, and (n, 3) of the face
    field : the deformation
    """

    points: Array
    distance: Array
    nearest: NDArray[np.intp]
    height: Array
    normal: Array
    field: Field


def match(target: Target, points: Array, normals: Array, reach: float, rounds: int = ROUNDS, freedom: Freedom = STIFF,
          start: Array | None = None) -> Match:
    """Match points with the part; each round takes back a smooth displacement fitted to the last one's heights.

    Parameters
    ----------
    points, normals : (n, 3) in model coordinates, normals outward
    reach : largest distance in mm
    rounds : 0 for no deformation
    freedom : of the deformation
    start : (n, 3) where the points nearly lie without it, if known: the last rounds are enough then
    """
    place, field = points if start is None else start, Field.still(points, target.size, freedom.degree)
    for turn in range(rounds + 1):
        distance, nearest = target.nearest(place, normals, reach)
        height, normal = target.heights(place, nearest)
        if turn < rounds:
            wanted = height + np.einsum("ni,ni->n", normal, points - place)
            field = fit_field(points, normal, wanted, height, np.isfinite(distance), target.samples.tangents[nearest],
                              _WIDEST * target.size * 0.5**(turn if start is None else ROUNDS - rounds + turn),
                              target.size, freedom)
            place = points - field(points)
    return Match(place, distance, nearest, height, normal, field)


def settle(target: Target, points: Array, pose: Array, normals: Array, reach: float, outline: Outline,
           iterations: int = 4) -> Array:
    """Least-squares pose of a deformed part: each place of it against where it lies without the deformation.

    Distances from the faces alone leave a deformed sheet free to slide and turn in its own surface. Of the deformations
    that explain them the smoothest that stretches least is taken back; where the scan then ends tells how far it slid.

    Parameters
    ----------
    points, normals : (n, 3) of the scan, scan coordinates, normals outward
    pose : (4, 4), T_model_scan to start from
    reach : in mm
    outline : of the scan, scan coordinates
    """
    some = slice(None, None, 1 + len(points) // _ROUGHLY)
    moved = apply(pose, points)
    field = match(target, moved[some], normals[some] @ pose[:3, :3].T, reach, ROUNDS, SOFT).field
    place = moved - field(moved)
    for turn in range(iterations):
        moved = apply(pose, points)
        found = match(target, moved, normals @ pose[:3, :3].T, reach, _MORE, SOFT, place)
        place = found.points
        if turn == 0:
            turned = _far_side(target, found, normals @ pose[:3, :3].T, reach)
            normals = np.where(turned[:, None], -normals, normals)
        spread = 1.4826 * float(np.median(np.abs(found.height)))
        sure = np.isfinite(found.distance) & (np.abs(found.height) < max(6.0 * spread, 2e-3 * target.size))
        if sure.sum() < 100:
            break
        around = apply(pose, outline.points)
        foot = _slid(target, found.points[sure], found.nearest[sure],
                     replace(outline, points=around - found.field(around)))
        # the whole part counts evenly, also where the scan is thin or shows one side alone
        goals = target.even.points
        more = best_fit(goals + (moved[sure] - foot)[cKDTree(foot).query(goals)[1]], goals)
        pose = more @ pose
        if angle(more, np.eye(4)) < _SETTLED and shift(more, np.eye(4), target.centre) < _SETTLED * target.size:
            break
    return pose


def _far_side(target: Target, found: Match, normals: Array, reach: float) -> NDArray[np.bool_]:
    """Which points lie on the part if their normals, model coordinates, are turned round, and else do not; (n,)."""
    near = _ON * target.size
    turned = ~(np.isfinite(found.distance) & (np.abs(found.height) < near))
    distance, nearest = target.nearest(found.points[turned], -normals[turned], reach)
    turned[turned] = np.isfinite(distance) & (np.abs(target.heights(found.points[turned], nearest)[0]) < near)
    return turned


def _slid(target: Target, points: Array, nearest: NDArray[np.intp], outline: Outline) -> Array:
    """Foot points (n, 3) of points on their faces, after the rigid slide that brings the ends to the rims."""
    width = width_of_ends(target.rims, len(outline.points) / outline.area,
                          max(_WIDTH * target.size, _BLURRED * outline.noise))
    slide = np.eye(4)
    for _ in range(_SLIDES):
        ends = find_ends(target.rims, apply(slide, outline.points), width, 4.0 * outline.noise + _OF_WIDTH * width)
        for _ in range(_STEPS):
            moved = apply(slide, points)
            height, normal = target.heights(moved, nearest)
            spread = max(1.4826 * float(np.median(np.abs(height))), 1e-6 * target.size)
            gate = max(4.0 * 1.4826 * float(np.median(np.abs(ends.gap))), _END_GATE) if len(ends.gap) else _END_GATE
            weight = np.concatenate([tukey(height, 4.0 * spread),
                                     _FOR_ENDS * spread**2 * ends.weight * tukey(ends.gap, gate)])
            update = gauss_newton(np.concatenate([moved, ends.places]) - target.centre,
                                  np.concatenate([normal, ends.outwards]), np.concatenate([height, ends.gap]), weight,
                                  target.size)
            more = step(update, target.centre)
            slide, ends = more @ slide, ends.moved(more)
    moved = apply(slide, points)
    height, normal = target.heights(moved, nearest)
    return moved - height[:, None] * normal
