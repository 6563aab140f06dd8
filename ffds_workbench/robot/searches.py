# SPDX-License-Identifier: LGPL-2.1-or-later
"""Touches with the wire where a seam is less sure than its process needs: of both faces, at the seam's ends.

The wire is brought beside the seam, over one face, and moved along that face's normal until it touches; then over the
other. What it finds is what the seam is off by along both normals.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..registration.arrays import Array
from ..seams.measured import MeasuredSeam
from .cells import Cell
from .clearance import Moving
from .planning import within_branch

_BESIDE, _ABOVE, _BEYOND = 8.0, 6.0, 3.0
"""In mm: how far beside the seam a face is touched, from what distance to it, and how far past it is searched (unit: an
assumption on fillets and fixtures, until the process can say it)."""
_LONG = 40.0
"""Length in mm from which on both ends of a seam are searched (unit: shorter, both touches are nearly the same)."""


@dataclass(frozen=True)
class Search:
    """A touch.

    Attributes
    ----------
    station : of the seam; ``face``: 1 or 2, which of its faces
    start, end : (4, 4) poses of the tip: from where, and how far at most
    """

    station: int
    face: int
    start: Array
    end: Array


def is_needed(seam: MeasuredSeam, tolerance: float) -> bool:
    """Whether a band is wider than the tolerance, or a part was not observed and has no band.

    Without a registration's report nothing is known, and nothing is searched for.
    """
    unknown = np.isnan(seam.bands) & (seam.flags != "observed")
    return seam.reported and bool((np.nan_to_num(seam.bands) > tolerance).any() or unknown.any())


def searches_of(seam: MeasuredSeam, tips: Array, joints: Array, moving: Moving, cell: Cell
                ) -> tuple[Search, ...] | None:
    """The touches at a seam's ends, in the order in which they are made; None where one cannot be reached.

    Parameters
    ----------
    tips : (n, 4, 4) poses of the tip along the seam, and their ``joints`` (n, 6)
    """
    stations = seam.stations
    ends = [0, len(stations) - 1] if stations.length >= _LONG and not stations.seam.closed else [0]
    found = []
    for station in ends:
        n1, n2 = stations.n1[station], stations.n2[station]
        for face, (own, other) in enumerate(((n1, n2), (n2, n1)), 1):
            # Beside the seam on the face: away from the other face, within this one.
            aside = other - (other @ own) * own
            aside /= np.linalg.norm(aside)
            poses = np.tile(tips[station], (2, 1, 1))
            at = stations.positions[station] + _BESIDE * aside
            poses[:, :3, 3] = at + _ABOVE * own, at - _BEYOND * own
            touching = poses[:1].copy()
            touching[0, :3, 3] = at
            ways = within_branch(moving, np.concatenate([poses[:1], touching]), joints[station])
            if ways is None or (moving.all(ways, cell.clearance + 1.0).distances < cell.clearance).any():
                return None
            found.append(Search(station, face, *poses))
    return tuple(found)
