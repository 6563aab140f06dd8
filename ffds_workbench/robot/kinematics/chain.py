# SPDX-License-Identifier: LGPL-2.1-or-later
"""A serial arm of revolute joints as six axes in space, for many joint vectors at once.

The axes are those of the arm with all joints at zero, in the frame of its base; a joint turns all that lies beyond it
about its axis (product of exponentials: Brockett 1984). Whatever the maker calls zero, the formulae are the same.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...registration.arrays import Array
from ...registration.motions import motion


@dataclass(frozen=True)
class Chain:
    """The axes of an arm at zero.

    Attributes
    ----------
    directions : (6, 3) unit vectors, right-handed about which the joints turn
    points : (6, 3) in mm, one on each axis
    home : (4, 4) the flange at zero
    """

    directions: Array
    points: Array
    home: Array

    def flange(self, joints: Array) -> Array:
        """Poses (…, 4, 4) of the flange for ``joints`` (…, 6) in rad."""
        return self.links(joints)[..., 5, :, :] @ self.home

    def links(self, joints: Array) -> Array:
        """Motions (…, 6, 4, 4) of the six links away from where they are at zero."""
        turns = about(self.directions, self.points, joints)
        moved = [turns[..., 0, :, :]]
        for joint in range(1, 6):
            moved.append(moved[-1] @ turns[..., joint, :, :])
        return np.stack(moved, axis=-3)


def chain_of(steps: Sequence[tuple[Array, Array]], flange: Array) -> Chain:
    """A chain from its joints one after the other, as robot descriptions tell them.

    Parameters
    ----------
    steps : per joint its frame (4, 4) in the frame of the joint before at zero, and its unit axis (3,) in that frame
    flange : (4, 4) in the frame of the last joint
    """
    at, directions, points = np.eye(4), [], []
    for frame, axis in steps:
        at = at @ frame
        directions.append(at[:3, :3] @ axis)
        points.append(at[:3, 3])
    return Chain(np.array(directions), np.array(points), at @ flange)


def rotation_about(axis: Array, angles: Array) -> Array:
    """Rotations (…, 3, 3) by ``angles`` (…) in rad about unit axes (3,) or (…, 3); NaN where an angle is."""
    vectors = axis * angles[..., None]
    return Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(*vectors.shape, 3)


def about(directions: Array, points: Array, angles: Array) -> Array:
    """Motions (…, 4, 4) that turn by ``angles`` (…) in rad about lines through ``points`` (…, 3) in mm along unit
    ``directions`` (…, 3)."""
    turn = rotation_about(directions, angles)
    return motion(turn, points - np.einsum("...ij,...j->...i", turn, points))
