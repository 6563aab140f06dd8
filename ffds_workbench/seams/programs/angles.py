# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the makers of robots write an orientation. A rotation matrix holds the tool's axes as columns.

* KUKA: A, B, C in degrees, R = Rz(A) · Ry(B) · Rx(C): turns about Z, then the new Y, then the new X.
* ABB: a unit quaternion q1…q4 of which q1 is the scalar.
* FANUC: W, P, R and Yaskawa: Rx, Ry, Rz are KUKA's C, B, A.
* Kawasaki: O, A, T in degrees, R = Rz(O) · Ry(A) · Rz(T).
* Universal Robots: a rotation vector in rad: the axis, as long as the angle.
"""
from __future__ import annotations

import warnings

import numpy as np
from scipy.spatial.transform import Rotation

from ...registration.arrays import Array


def kuka_angles(rotations: Array) -> Array:
    """A, B, C in degrees, (n, 3), of rotations (n, 3, 3); C = 0 where B = ±90° leaves A and C free."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock")
        return Rotation.from_matrix(rotations).as_euler("ZYX", degrees=True)


def from_kuka_angles(angles: Array) -> Array:
    """Rotations (n, 3, 3) of A, B, C in degrees, (n, 3)."""
    return Rotation.from_euler("ZYX", angles, degrees=True).as_matrix()


def kawasaki_angles(rotations: Array) -> Array:
    """O, A, T in degrees, (n, 3), of rotations (n, 3, 3), A from 0 to 180°; T = 0 where A leaves O and T free."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Gimbal lock")
        return Rotation.from_matrix(rotations).as_euler("ZYZ", degrees=True)


def from_kawasaki_angles(angles: Array) -> Array:
    """Rotations (n, 3, 3) of O, A, T in degrees, (n, 3)."""
    return Rotation.from_euler("ZYZ", angles, degrees=True).as_matrix()


def abb_quaternions(rotations: Array) -> Array:
    """q1…q4, (n, 4), q1 the scalar and not negative."""
    q = Rotation.from_matrix(rotations).as_quat()[:, [3, 0, 1, 2]]
    return np.where(q[:, :1] < 0.0, -q, q)


def ur_rotation_vectors(rotations: Array) -> Array:
    """Rotation vectors in rad, (n, 3)."""
    return Rotation.from_matrix(rotations).as_rotvec()
