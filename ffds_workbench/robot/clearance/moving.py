# SPDX-License-Identifier: LGPL-2.1-or-later
"""Torch and arm where they are: their clearances for many poses of the tip, or many joints, at once."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...registration.arrays import Array, Index
from ..arms import Arm
from .balls import Balls, joined_balls, of_links
from .surroundings import Nearness, Surroundings

_COARSE = 4.0
"""How much thicker in mm the links are taken to be, so that few balls do (unit: what time is worth)."""
_CHUNK = 400_000
"""Balls that are placed at once (unit: what memory is worth)."""


@dataclass(frozen=True)
class Moving:
    """What moves, and what it must keep away from.

    Attributes
    ----------
    arm : the arm
    base : (4, 4) pose of its base in the frame of the model
    tcp : (4, 4) pose of the wire's tip on the flange
    about_the_wire, beside_the_wire : the torch's balls in the frame of the tip; the first turn with the wire unseen
    surroundings : part and cell
    """

    arm: Arm
    base: Array
    tcp: Array
    about_the_wire: Balls
    beside_the_wire: Balls
    surroundings: Surroundings

    def flange(self, tips: Array) -> Array:
        """Poses (…, 4, 4) of the flange in the frame of the base for those of the tip in the model's."""
        return np.linalg.inv(self.base) @ tips @ np.linalg.inv(self.tcp)

    def tips(self, joints: Array) -> Array:
        """Poses (…, 4, 4) of the tip in the frame of the model for joints (…, 6)."""
        return self.base @ self.arm.chain.flange(joints) @ self.tcp

    def wire(self, tips: Array, cap: float) -> Nearness:
        """Of nozzle and neck for poses (n, 4, 4) of the tip."""
        return self._nearest(self.about_the_wire, tips, cap)

    def body(self, tips: Array, cap: float) -> Nearness:
        """Of the torch's body for poses (n, 4, 4) of the tip."""
        return self._nearest(self.beside_the_wire, tips, cap)

    def torch(self, tips: Array, cap: float) -> Nearness:
        """Of the whole torch."""
        return self._nearest(joined_balls([self.about_the_wire, self.beside_the_wire]), tips, cap)

    def links(self, joints: Array, cap: float) -> Nearness:
        """Of the arm, taken a little thicker than it is, for joints (n, 6)."""
        motions = self.base @ self.arm.chain.links(joints)
        found = [self._nearest(balls, motions[:, link], cap) for link, balls in enumerate(self._links)
                 if len(balls.radii)]
        return nearest(found)

    def all(self, joints: Array, cap: float) -> Nearness:
        """Of torch and arm for joints (n, 6)."""
        return nearest([self.torch(self.tips(joints), cap), self.links(joints, cap)])

    @cached_property
    def _links(self) -> tuple[Balls, ...]:
        return of_links(self.arm.capsules, _COARSE)

    def _nearest(self, balls: Balls, frames: Array, cap: float) -> Nearness:
        count = len(balls.radii)
        distances, what = np.full(len(frames), float(cap)), np.full(len(frames), -1, dtype=np.intp)
        each = max(1, _CHUNK // max(count, 1))
        for start in range(0, len(frames) if count else 0, each):
            some = frames[start : start + each]
            centres = np.einsum("nij,kj->nki", some[:, :3, :3], balls.centres) + some[:, None, :3, 3]
            found = self.surroundings.nearness(centres, balls.radii, cap)
            distances[start : start + each], what[start : start + each] = found.distances, found.what
        return Nearness(distances, what)


def nearest(found: list[Nearness]) -> Nearness:
    """The nearer of several, place by place."""
    distances, what = np.stack([one.distances for one in found]), np.stack([one.what for one in found])
    best: Index = distances.argmin(axis=0)[None]
    return Nearness(np.take_along_axis(distances, best, axis=0)[0], np.take_along_axis(what, best, axis=0)[0])
