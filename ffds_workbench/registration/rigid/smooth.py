# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth deformation of space that a scan of the right part is allowed beyond its rigid pose."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..splines import Array
from .field import STIFF, Field, Freedom, fit_field
from .target import Target

ROUNDS = 6
_WIDEST = 0.1
"""Gate of the first round as a share of the part's size; each round halves it."""


@dataclass(frozen=True)
class Match:
    """Points of the scan matched with the part after a smooth deformation is taken back.

    Attributes
    ----------
    points : (n, 3) where the points lie without the deformation, model coordinates in mm
    distance : (n,) from the sample in mm, infinite where nothing within reach faces the same way
    nearest : (n,) index of the sample
    height, normal : (n,) in mm over the face, and (n, 3) of the face
    field : the deformation
    """

    points: Array
    distance: Array
    nearest: NDArray[np.intp]
    height: Array
    normal: Array
    field: Field


def match(target: Target, points: Array, normals: Array, reach: float, rounds: int = ROUNDS, freedom: Freedom = STIFF,
          start: Array | None = None) -> Match:
    """Match points with the part; each round takes back a smooth displacement fitted to the last one's heights.

    Parameters
    ----------
    points, normals : (n, 3) in model coordinates, normals outward
    reach : largest distance in mm
    rounds : 0 for no deformation
    freedom : of the deformation
    start : (n, 3) where the points nearly lie without it, if known: the last rounds are enough then
    """
    place, field = points if start is None else start, Field.still(points, target.size, freedom.degree)
    for turn in range(rounds + 1):
        distance, nearest = target.nearest(place, normals, reach)
        height, normal = target.heights(place, nearest)
        if turn < rounds:
            wanted = height + np.einsum("ni,ni->n", normal, points - place)
            field = fit_field(points, normal, wanted, height, np.isfinite(distance), target.samples.tangents[nearest],
                              _WIDEST * target.size * 0.5**(turn if start is None else ROUNDS - rounds + turn),
                              target.size, freedom)
            place = points - field(points)
    return Match(place, distance, nearest, height, normal, field)
