# SPDX-License-Identifier: LGPL-2.1-or-later
"""Torch and links as balls, so close to each other that between them no more than 0.2 mm of the solid stands out."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...registration.arrays import Array
from ..arms import Capsule

STANDS_OUT = 0.2
"""How far in mm a solid may stand out between two of its balls (unit: well within the clearance that is kept)."""
_RIM = 0.2
"""Radius in mm of the balls around the flat end of a cylinder, which round its edge off by that (unit, likewise)."""


@dataclass(frozen=True)
class Balls:
    """Balls: ``centres`` (n, 3) and ``radii`` (n,) in mm."""

    centres: Array
    radii: Array

    @classmethod
    def none(cls) -> Balls:
        """No ball."""
        return cls(np.empty((0, 3)), np.empty(0))


def joined_balls(parts: Sequence[Balls]) -> Balls:
    """All of them."""
    return Balls(np.concatenate([part.centres for part in parts]), np.concatenate([part.radii for part in parts]))


def along(start: Array, end: Array, radius: float, stands_out: float = STANDS_OUT) -> Balls:
    """The balls of a capsule, all points within ``radius`` of the line from ``start`` to ``end`` (3,)."""
    length = float(np.linalg.norm(end - start))
    count = 1 + int(np.ceil(length / (2.0 * np.sqrt(2.0 * radius * stands_out + stands_out**2)))) if length else 1
    return Balls(start + np.linspace(0.0, 1.0, count)[:, None] * (end - start), np.full(count, radius))


def cylinder_end(end: Array, axis: Array, radius: float) -> Balls:
    """The rim of a cylinder's flat end: small balls around it.

    Parameters
    ----------
    end : (3,) middle of the flat end; ``axis`` : (3,) unit, out of it
    """
    small = min(_RIM, 0.5 * radius)
    count = int(np.ceil(np.pi / np.sqrt(STANDS_OUT / radius)))
    angles = 2.0 * np.pi / count * np.arange(count)
    across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    across /= np.linalg.norm(across)
    ring = np.cos(angles)[:, None] * across + np.sin(angles)[:, None] * np.cross(axis, across)
    return Balls(end - small * axis + (radius - small) * ring, np.full(count, small))


def cylinder(start: Array, end: Array, radius: float) -> Balls:
    """The balls of a cylinder with a flat end at ``end``, and a round one at ``start`` that something else covers."""
    axis = (end - start) / np.linalg.norm(end - start)
    inner = along(start, end - min(radius, float(np.linalg.norm(end - start))) * axis, radius)
    return joined_balls([inner, cylinder_end(end, axis, radius)])


def of_links(capsules: Sequence[Capsule], stands_out: float) -> tuple[Balls, ...]:
    """The balls of each of the six links at zero; they stand ``stands_out`` mm wider than they are, to cover all."""
    links = []
    for link in range(6):
        parts = [along(item.start, item.end, item.radius, stands_out) for item in capsules if item.link == link]
        found = joined_balls(parts) if parts else Balls.none()
        links.append(Balls(found.centres, found.radii + stands_out))
    return tuple(links)
