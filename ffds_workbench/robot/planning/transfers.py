# SPDX-License-Identifier: LGPL-2.1-or-later
"""Through the air between seams: straight in the joints where that is free, else around by two growing trees.

RRT-Connect (Kuffner and LaValle 2000), shortened afterwards. OMPL would do the same; its wheels need a newer numpy than
FreeCAD's Python has on Debian 12.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...registration.arrays import Array

Free = Callable[[Array], NDArray[np.bool_]]
"""Whether joints (n, 6) keep clear, (n,)."""

_STEP = np.radians(3.0)
_GROWTH = np.radians(25.0)
_TRIES, _SHORTENINGS = 400, 60
"""Largest joint step in rad between places that are looked at; how far a tree grows at once; how often at most it
grows, and how often a shorter way is tried (unit: what time is worth). At a reach of 1.4 m a step of joint 1 is 73 mm,
and nothing is looked at in between."""
_AROUND = np.radians(60.0)
"""How far in rad beyond both ends a way is sought (unit)."""


def transfer(start: Array, end: Array, limits: Array, free: Free, seed: int = 1) -> Array | None:
    """Joints (n, 6) from ``start`` to ``end`` (6,), straight in the joints in between; None where no way was found.

    Parameters
    ----------
    limits : (6, 2) in rad
    """
    if _is_free(start, end, free):
        return np.stack([start, end])
    rng = np.random.default_rng(seed)
    low, high = limits.T
    # Only what lies around both ends is tried: transfers are short, and limits wide.
    near_low = np.maximum(low, np.minimum(start, end) - _AROUND)
    near_high = np.minimum(high, np.maximum(start, end) + _AROUND)
    trees = (_Tree(start), _Tree(end))
    for number in range(_TRIES):
        goal = rng.uniform(near_low, near_high)
        one, other = trees[number % 2], trees[1 - number % 2]
        grown = one.grow_towards(goal, free)
        if grown is None:
            continue
        place = one.places[grown]
        while (met := other.grow_towards(place, free)) is not None:
            if np.abs(other.places[met] - place).max() < 1e-9:
                there, back = one.way_to(grown), other.way_to(met)
                way = [*there, *back[::-1][1:]] if number % 2 == 0 else [*back, *there[::-1][1:]]
                return _shortened(np.array(way), free, rng)
    return None


class _Tree:
    def __init__(self, root: Array) -> None:
        self.places, self._parents = [root], [-1]

    def grow_towards(self, goal: Array, free: Free) -> int | None:
        """The number of a new place towards a goal from the nearest one, or None where that is not free."""
        apart = np.abs(np.array(self.places) - goal).max(axis=1)
        nearest = int(apart.argmin())
        step = goal - self.places[nearest]
        place = goal if apart[nearest] <= _GROWTH else self.places[nearest] + step * (_GROWTH / apart[nearest])
        if not _is_free(self.places[nearest], place, free):
            return None
        self.places.append(place)
        self._parents.append(nearest)
        return len(self.places) - 1

    def way_to(self, number: int) -> list[Array]:
        """From the root to a place."""
        way = []
        while number >= 0:
            way.append(self.places[number])
            number = self._parents[number]
        return way[::-1]


def between(start: Array, end: Array) -> Array:
    """Joints (n, 6) from ``start`` to ``end`` in small steps, both included."""
    count = 2 + int(np.abs(end - start).max() / _STEP)
    return start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)


def _is_free(start: Array, end: Array, free: Free) -> bool:
    return bool(free(between(start, end)).all())


def _shortened(way: Array, free: Free, rng: np.random.Generator) -> Array:
    """Without detours: two places that see each other need none in between."""
    for _ in range(_SHORTENINGS):
        if len(way) <= 2:
            break
        one, other = np.sort(rng.choice(len(way), 2, replace=False))
        if other - one > 1 and _is_free(way[one], way[other], free):
            way = np.concatenate([way[: one + 1], way[other:]])
    return way
