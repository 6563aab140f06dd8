# SPDX-License-Identifier: LGPL-2.1-or-later
"""Torch frames from directions, and angles between them. Arrays only.

The frame stands on the seam: x = travel, z = approach, into the joint, along −(n1 + n2); y = z × x. A rotation matrix
holds the axes as columns, and takes torch coordinates to the model's.
"""
from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from ..errors import RefusedError
from ..registration.arrays import Array

_LEAST_SUM = 0.1
"""Length of n1 + n2 below which the faces are back to back, or 6° from it, and the bisector means nothing."""


def torch_frames(tangents: Array, n1: Array, n2: Array) -> Array:
    """Frames of the bisector of both faces, (n, 3, 3), from unit tangents and outward normals, (n, 3) each.

    Where a normal is not perpendicular to the tangent (parts with a gap), z is adjusted and x stays the travel
    direction.

    Raises
    ------
    RefusedError
        the faces are back to back somewhere
    """
    out = n1 + n2
    out = out - np.einsum("ij,ij->i", out, tangents)[:, None] * tangents
    lengths = np.linalg.norm(out, axis=1, keepdims=True)
    if lengths.min() < _LEAST_SUM:
        raise RefusedError("The two faces of the seam lie back to back, so there is no torch direction between them.")
    z = -out / lengths
    return np.stack([tangents, np.cross(z, tangents), z], axis=2)


def leaning(frames: Array, work_angle: float, travel_angle: float) -> Array:
    """Frames turned by the work angle about x, then by the travel angle about the new y (rad), right-handed."""
    turn = Rotation.from_euler("XY", [work_angle, travel_angle]).as_matrix()
    return frames @ turn


def quaternions(frames: Array) -> Array:
    """Unit quaternions (x, y, z, w), (n, 4), without a change of sign between neighbours; the first has w ≥ 0."""
    q = Rotation.from_matrix(frames).as_quat()
    q[0] *= -1.0 if q[0, 3] < 0.0 else 1.0
    turns = np.where(np.einsum("ij,ij->i", q[1:], q[:-1]) < 0.0, -1.0, 1.0)
    q[1:] *= np.cumprod(turns)[:, None]
    return q


def angle_between(a: Array, b: Array) -> Array:
    """Angles in rad between unit vectors, (n, 3) each."""
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("ij,ij->i", a, b))


def rotation_between(a: Array, b: Array) -> Array:
    """Angles in rad of the rotations between frames, (n, 3, 3) each."""
    return Rotation.from_matrix(np.swapaxes(a, 1, 2) @ b).magnitude()
