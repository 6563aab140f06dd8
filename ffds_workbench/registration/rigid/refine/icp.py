# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coarse-to-fine iterative closest point: point to surface, with the faces' curvature and Tukey's weights.

Own code because open3d's is from points to planes and knows no curvature.
"""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motions import apply, twist_motion, twist_rows
from ...robust_weights import quantile, tukey
from ..model import Target


def refine(target: Target, points: Array, pose: Array, gates: Sequence[float], iterations: int = 12,
           normals: Array | None = None) -> Array:
    """Rigid pose at which the points fit the faces best, found from a pose nearby.

    A point counts by its height over the face, and where it sticks out beyond the rim of the face, by that as well.

    Parameters
    ----------
    target : the nominal model
    points : (n, 3) in mm, scan coordinates
    pose : (4, 4), T_model_scan to start from
    gates : largest distances in mm that still count, one stage each, in falling order; within the gate the cut-off of
        the weights follows the spread of the residuals
    iterations : most steps per stage
    normals : (n, 3) outward unit vectors, scan coordinates: a deformed sheet may lie nearer to the far side of the
        nominal one, and only the normals tell; None where they are not known

    Returns
    -------
    (4, 4), T_model_scan
    """
    settings = target.settings.refine
    for gate in gates:
        travelled = np.inf
        for _ in range(iterations):
            moved = apply(pose, points)
            if travelled > settings.matches_last * target.spacing:
                turned = None if normals is None else normals @ pose[:3, :3].T
                distance, nearest = target.nearest(moved, turned, gate)
                near = np.flatnonzero(np.isfinite(distance))
                if len(near) < 12:
                    return pose
                nearest, travelled = nearest[near], 0.0
            moved = moved[near]
            update = fit_step(target, moved, nearest, gate)
            pose = twist_motion(update, target.centre) @ pose
            moves = float(np.abs(update[3:]).max() + np.abs(update[:3]).max() * target.size / 2)
            travelled += moves
            if moves < settings.settled * target.size:
                break
    return pose


def fit_step(target: Target, points: Array, nearest: NDArray[np.intp], gate: float) -> Array:
    """Twist (6,) by which matched points come to lie on the faces and inside their rims.

    Parameters
    ----------
    points : (n, 3) in model coordinates
    nearest : (n,) samples they are matched with
    gate : in mm, the largest cut-off of the weights
    """
    height, normal = target.heights(points, nearest)
    settings = target.settings.refine
    cutoff = min(max(settings.cutoff * quantile(np.abs(height), settings.scale_quantile), 1e-3 * gate), gate)
    beyond, outwards = target.overshoot(points, nearest, gate)
    out = np.flatnonzero(beyond > 0)
    weight = np.concatenate([tukey(height, cutoff), tukey(beyond[out], gate)])
    return gauss_newton(np.concatenate([points, points[out]]) - target.centre,
                        np.concatenate([normal, outwards[out]]), np.concatenate([height, beyond[out]]), weight,
                        target.size)


def gauss_newton(arm: Array, normal: Array, height: Array, weight: Array, size: float) -> Array:
    """Twist (6,) about the target's centre that brings the heights to zero in the least-squares sense.

    A prior of 1e-6 of the points' weight keeps directions that nothing observes at rest; a turn counts as the shift
    it makes at half the part's size.

    Parameters
    ----------
    arm : (n, 3) of the points from the target's centre, in mm
    normal : (n, 3) of the faces below them
    height, weight : (n,) in mm over the faces, and how much each counts
    size : of the part in mm
    """
    scale = np.array([2.0 / size] * 3 + [1.0] * 3)
    jacobian = twist_rows(arm, normal) * scale
    matrix = (jacobian * weight[:, None]).T @ jacobian
    matrix += np.eye(6) * (1e-6 * weight.sum() + 1e-12)
    return np.asarray(scale * np.linalg.solve(matrix, -jacobian.T @ (weight * height)))
