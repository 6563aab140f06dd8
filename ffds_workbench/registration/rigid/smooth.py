# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth deformation of space that a scan of the right part is allowed beyond its rigid pose."""
from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ..splines import Array
from .fine import tukey
from .motions import angle, apply, motion, shift
from .target import Target

ROUNDS = 6
_WIDEST = 0.1
"""Gate of the first round as a share of the part's size; each round halves it."""
_SETTLED = 1e-4
"""A motion below this (rad, share of the part's size) ends the search for the pose of a deformed part."""


@dataclass(frozen=True)
class Freedom:
    """Displacements of space that are allowed: polynomials of a degree, held at zero by a ridge."""

    degree: int
    ridge: float


STIFF = Freedom(2, 1e-2)
"""Tells the part from another one."""
SOFT = Freedom(3, 1e-3)
"""Follows a deformed part."""


@dataclass(frozen=True)
class Match:
    """Points of the scan matched with the part after a smooth deformation is taken back.

    Attributes
    ----------
    points : (n, 3) where the points lie without the deformation, model coordinates in mm
    distance : (n,) from the sample in mm, infinite where nothing within reach faces the same way
    nearest : (n,) index of the sample
    height, normal : (n,) in mm over the face, and (n, 3) of the face
    """

    points: Array
    distance: Array
    nearest: NDArray[np.intp]
    height: Array
    normal: Array


def match(target: Target, points: Array, normals: Array, reach: float, rounds: int = ROUNDS, freedom: Freedom = STIFF,
          place: Array | None = None, widest: float = _WIDEST) -> Match:
    """Match points with the part; each round takes back a smooth displacement fitted to the last one's heights.

    Parameters
    ----------
    points, normals : (n, 3) in model coordinates, normals outward
    reach : largest distance in mm
    rounds : 0 for no deformation
    freedom : of the deformation
    place : (n, 3) where the points lie without the deformation, as far as known
    widest : gate of the first round, as a share of the part's size
    """
    place = points if place is None else place
    for turn in range(rounds + 1):
        distance, nearest = target.nearest(place, normals, reach)
        height, normal = target.heights(place, nearest)
        if turn < rounds:
            place = points - _displacement(points, normal, height + np.einsum("ni,ni->n", normal, points - place),
                                           height, np.isfinite(distance), target.size, widest * target.size * 0.5**turn,
                                           freedom)
    return Match(place, distance, nearest, height, normal)


def _displacement(points: Array, normal: Array, wanted: Array, left: Array, chosen: NDArray[np.bool_],
                  size: float, gate: float, freedom: Freedom) -> Array:
    """Displacement (n, 3), polynomial in space, whose normal component is as wanted at the chosen points.

    Points count by how much of it is ``left`` to explain, within the gate in mm or the spread of all, if that is wider.
    """
    x = (points - points.mean(axis=0)) / (0.5 * size)
    powers = [power for degree in range(freedom.degree + 1)
              for power in combinations_with_replacement(range(3), degree)]
    monomials = np.stack([x[:, power].prod(axis=1) for power in powers], axis=1)
    rows = (monomials[:, :, None] * normal[:, None, :]).reshape(len(x), -1)
    if chosen.sum() < 2 * rows.shape[1]:
        return np.zeros_like(points)
    for _ in range(3):
        spread = 1.4826 * float(np.median(np.abs(left[chosen])))
        weight = chosen * tukey(left, max(4.0 * spread, gate))
        matrix = (rows * weight[:, None]).T @ rows
        matrix += np.eye(len(matrix)) * (freedom.ridge * weight.sum() / 30.0 + 1e-12)
        coefficients = np.linalg.solve(matrix, rows.T @ (weight * wanted))
        left = wanted - rows @ coefficients
    return monomials @ coefficients.reshape(-1, 3)


def settle(target: Target, points: Array, pose: Array, normals: Array, reach: float, iterations: int = 6) -> Array:
    """Least-squares pose of a deformed part: each place of it against where it lies without the deformation.

    Distances from the faces alone leave a deformed sheet free to slide and turn in its own surface; the smoothest
    deformation that explains them does not.

    Parameters
    ----------
    points, normals : (n, 3) of the scan, scan coordinates, normals outward
    pose : (4, 4), T_model_scan to start from
    reach : in mm
    """
    place, rounds, widest = None, ROUNDS, _WIDEST
    for _ in range(iterations):
        moved = apply(pose, points)
        found = match(target, moved, normals @ pose[:3, :3].T, reach, rounds, SOFT, place, widest)
        spread = 1.4826 * float(np.median(np.abs(found.height)))
        sure = np.isfinite(found.distance) & (np.abs(found.height) < max(6.0 * spread, 2e-3 * target.size))
        if sure.sum() < 100:
            break
        # the deformation goes on from here, and only its fine matches change
        place, rounds, widest = found.points, 2, _WIDEST * 0.5**ROUNDS
        foot = place[sure] - found.height[sure, None] * found.normal[sure]
        # the whole part counts evenly, also where the scan is thin or shows one side alone
        goals = target.even.points
        more = best_fit(goals + (moved[sure] - foot)[cKDTree(foot).query(goals)[1]], goals)
        pose = more @ pose
        if angle(more, np.eye(4)) < _SETTLED and shift(more, np.eye(4), target.centre) < _SETTLED * target.size:
            break
    return pose


def best_fit(points: Array, goals: Array) -> Array:
    """Motion (4, 4) that brings points onto the goals (n, 3) best in the least squares."""
    middle, goal = points.mean(axis=0), goals.mean(axis=0)
    rotation = Rotation.align_vectors(goals - goal, points - middle)[0].as_matrix()
    return motion(rotation, goal - rotation @ middle)
