# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rigid motions as 4×4 matrices, one or many at a time: compose, apply, compare, cover all rotations evenly."""
from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from .arrays import Array

_ALONG_AXIS_COSINE, _TURNED_ANGLE = 0.9998, 0.02
"""Cosine above which a direction counts as along an axis, and angle in rad above which poses count as turned (unit: one
degree, which people call straight)."""


def motion(rotation: Array, translation: Array) -> Array:
    """Matrices (…, 4, 4) from a ``rotation`` (…, 3, 3) and a ``translation`` (…, 3) in mm."""
    result = np.zeros((*np.shape(translation)[:-1], 4, 4))
    result[..., :3, :3] = rotation
    result[..., :3, 3] = translation
    result[..., 3, 3] = 1.0
    return result


def apply(pose: Array, points: Array) -> Array:
    """``points`` (n, 3) moved by one ``pose`` (4, 4) → (n, 3), or by many (k, 4, 4) → (k, n, 3)."""
    return points @ np.swapaxes(pose[..., :3, :3], -1, -2) + pose[..., None, :3, 3]


def best_fit(points: Array, goals: Array, weights: Array | None = None) -> Array:
    """Motion (4, 4) that brings points onto the goals (n, 3) best in the least squares, with ``weights`` (n,)."""
    middle, goal = np.average(points, axis=0, weights=weights), np.average(goals, axis=0, weights=weights)
    rotation = Rotation.align_vectors(goals - goal, points - middle, weights=weights)[0].as_matrix()
    return motion(rotation, goal - rotation @ middle)


def twist_motion(twists: Array, centre: Array) -> Array:
    """Motions that turn by the rotation vectors twists[..., :3] about ``centre`` and shift by twists[..., 3:].

    Parameters
    ----------
    twists : (…, 6), rad and mm
    centre : (3,) or (…, 3) in mm
    """
    flat = twists.reshape(-1, 6)
    rotation = Rotation.from_rotvec(flat[:, :3]).as_matrix().reshape(*twists.shape[:-1], 3, 3)
    turned = np.einsum("...ij,...j->...i", rotation, np.broadcast_to(centre, (*twists.shape[:-1], 3)))
    return motion(rotation, centre + twists[..., 3:] - turned)


def twist_rows(arm: Array, direction: Array) -> Array:
    """How far points move along each ``direction`` (…, 3) by each of the six parts of a twist: (…, 6).

    Parameters
    ----------
    arm : (…, 3) of the points from the centre that the twist turns about
    """
    (x, y, z), (a, b, c) = np.moveaxis(arm, -1, 0), np.moveaxis(direction, -1, 0)
    return np.stack([y * c - z * b, z * a - x * c, x * b - y * a, a, b, c], axis=-1)


def angle(a: Array, b: Array) -> Array:
    """Angle in rad between the rotations of poses a and b (broadcast over leading axes)."""
    trace = np.einsum("...ij,...ij->...", a[..., :3, :3], b[..., :3, :3])
    return np.arccos(np.clip(0.5 * (trace - 1.0), -1.0, 1.0))


def shift(a: Array, b: Array, centre: Array) -> Array:
    """Distance in mm between where poses a and b put the point ``centre`` (3,)."""
    difference = a - b
    return np.linalg.norm(difference[..., :3, :3] @ centre + difference[..., :3, 3], axis=-1)


def even_rotations(count: int) -> Array:
    """``count`` rotation matrices spread evenly over all orientations; (count, 3, 3).

    Source: super-Fibonacci spirals, M. Alexa, CVPR 2022, eq. 4 and 5.
    """
    phi, psi = np.sqrt(2.0), 1.533751168755204288118041
    s = np.arange(count) + 0.5
    r, big_r = np.sqrt(s / count), np.sqrt(1.0 - s / count)
    alpha, beta = 2.0 * np.pi * s / phi, 2.0 * np.pi * s / psi
    quaternions = np.stack([r * np.sin(alpha), r * np.cos(alpha), big_r * np.sin(beta), big_r * np.cos(beta)], axis=1)
    return Rotation.from_quat(quaternions).as_matrix()


def even_directions(count: int) -> Array:
    """``count`` unit vectors spread evenly over the sphere (Fibonacci lattice); (count, 3)."""
    k = np.arange(count) + 0.5
    z = 1.0 - 2.0 * k / count
    turn = np.pi * (1.0 + np.sqrt(5.0)) * k
    radius = np.sqrt(1.0 - z * z)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)


def axis_name(axis: Array) -> str:
    """What an ``axis``, a unit vector (3,), is called: x, y or z, with a sign, where it is one of them, else its
    components."""
    largest = int(np.argmax(np.abs(axis)))
    if abs(axis[largest]) > _ALONG_AXIS_COSINE:
        return ("−" if axis[largest] < 0 else "") + "xyz"[largest]
    return "({:.2f}, {:.2f}, {:.2f})".format(*np.round(axis, 2) + 0.0)


def turn_name(turn: Array, near: float) -> str:
    """A ``turn``, a rotation vector (3,) in rad and not zero, in words; within ``near`` of a half turn the axis has
    no sign."""
    size = float(np.linalg.norm(turn))
    half = np.pi - size < near       # a half turn about an axis is one about its opposite too
    axis = turn / size * (np.sign(turn[np.argmax(np.abs(turn))]) if half else 1.0)
    return f"{np.degrees(size):.0f}° about {axis_name(axis)}"


def describe_difference(first: Array, second: Array, place: Array) -> str:
    """How the ``second`` pose (4, 4) differs from the ``first`` (4, 4), in words.

    Parameters
    ----------
    place : (3,) in mm, in the frame that the poses lead to: what is said to move where nothing turns
    """
    between = second @ np.linalg.inv(first)
    turn = Rotation.from_matrix(between[:3, :3]).as_rotvec()
    if np.linalg.norm(turn) > _TURNED_ANGLE:
        return "turned by " + turn_name(turn, _TURNED_ANGLE)
    way = apply(between, place[None])[0] - place
    length = float(np.linalg.norm(way))
    return f"moved by {length:.2g} mm along {axis_name(way / max(length, 1e-12))}"
