# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth deformation of space that a scan of the right part is allowed beyond its rigid pose."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..splines import Array
from .fine import fit_step, tukey
from .motions import apply, step
from .target import Target

_RIDGE = 1e-2
ROUNDS = 6
_WIDEST = 0.1
"""Gate of the first round as a share of the part's size; each round halves it."""
_EVERYTHING = 10.0


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


def match(target: Target, points: Array, normals: Array, reach: float, rounds: int = ROUNDS) -> Match:
    """Match points with the part; each round takes back a quadratic displacement fitted to the last one's heights.

    Parameters
    ----------
    points, normals : (n, 3) in model coordinates, normals outward
    reach : largest distance in mm
    rounds : 0 for no deformation
    """
    place = points
    for turn in range(rounds + 1):
        distance, nearest = target.nearest(place, normals, reach)
        height, normal = target.heights(place, nearest)
        if turn < rounds:
            place = points - _displacement(points, normal, height + np.einsum("ni,ni->n", normal, points - place),
                                           height, np.isfinite(distance), target.size,
                                           _WIDEST * target.size * 0.5**turn)
    return Match(place, distance, nearest, height, normal)


def _displacement(points: Array, normal: Array, wanted: Array, left: Array, chosen: NDArray[np.bool_],
                  size: float, gate: float) -> Array:
    """Displacement (n, 3), quadratic in space, whose normal component is as wanted at the chosen points.

    Points count by how much of it is ``left`` to explain, within the gate in mm or the spread of all, if that is wider.
    """
    x = (points - points.mean(axis=0)) / (0.5 * size)
    monomials = np.stack([np.ones(len(x)), *x.T, x[:, 0] ** 2, x[:, 1] ** 2, x[:, 2] ** 2,
                          x[:, 0] * x[:, 1], x[:, 0] * x[:, 2], x[:, 1] * x[:, 2]], axis=1)
    rows = (monomials[:, :, None] * normal[:, None, :]).reshape(len(x), -1)
    if chosen.sum() < 2 * rows.shape[1]:
        return np.zeros_like(points)
    for _ in range(3):
        spread = 1.4826 * float(np.median(np.abs(left[chosen])))
        weight = chosen * tukey(left, max(4.0 * spread, gate))
        matrix = (rows * weight[:, None]).T @ rows
        matrix += np.eye(len(matrix)) * (_RIDGE * weight.sum() / len(matrix) + 1e-12)
        coefficients = np.linalg.solve(matrix, rows.T @ (weight * wanted))
        left = wanted - rows @ coefficients
    return monomials @ coefficients.reshape(-1, 3)


def settle(target: Target, points: Array, pose: Array, normals: Array, reach: float, iterations: int = 8) -> Array:
    """Least-squares pose of a deformed part: each point against the face that it belongs to, however far that moved.

    Parameters
    ----------
    points, normals : (n, 3) of the scan, scan coordinates, normals outward
    pose : (4, 4), T_model_scan to start from
    reach : in mm
    """
    found = match(target, apply(pose, points), normals @ pose[:3, :3].T, reach)
    spread = 1.4826 * float(np.median(np.abs(found.height)))
    sure = np.isfinite(found.distance) & (np.abs(found.height) < max(4.0 * spread, 2e-3 * target.size))
    points, face = points[sure], target.samples.face[found.nearest[sure]]
    members = {k: np.flatnonzero(target.samples.face == k) for k in np.unique(face)}
    trees = {k: cKDTree(target.samples.points[index]) for k, index in members.items()}
    for _ in range(iterations if len(points) > 100 else 0):
        moved = apply(pose, points)
        nearest = np.empty(len(points), dtype=np.intp)
        for k, tree in trees.items():
            nearest[face == k] = members[k][tree.query(moved[face == k])[1]]
        pose = step(fit_step(target, moved, nearest, _EVERYTHING * reach, reach), target.centre) @ pose
    return pose
