# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which faces of a part a scan observes."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .coverage import covered_share
from .face import FaceGeometry
from .footpoints import surface_coordinates
from .raster import Raster, make_raster
from .splines import Array

Index = NDArray[np.intp]

REACH = 10.0
LEAST_COVERAGE = 0.5
_LEAST_POINTS = 50
_SAMPLE = 60000
_CELLS = 1024


@dataclass(frozen=True)
class _Candidate:
    """The sampled scan points that have a foot point on a face: their numbers, distances and cells."""

    raster: Raster
    points: Index
    distance: Array
    cell: Index


def observed_faces(faces: Sequence[FaceGeometry], scan: Array, reach: float = REACH,
                   least: float = LEAST_COVERAGE) -> dict[int, float]:
    """Numbers of the faces that a scan observes, and the share of each that it covers.

    Parameters
    ----------
    faces : all faces of the part
    scan : (n, 3) in mm
    reach : largest distance in mm of a point from its face
    least : coverage from which a face counts as observed

    Notes
    -----
    Each point belongs to the nearest face that has a foot point for it. The face with the least coverage is then given
    up and its points go to the next nearest, until all that are left are covered: so the skin of a sheet that moved
    inwards by more than half the thickness is not taken for the other skin.
    """
    if len(scan) > _SAMPLE:
        scan = scan[np.random.default_rng(0).choice(len(scan), _SAMPLE, replace=False)]
    candidates = {number: _candidate(face, scan, reach) for number, face in enumerate(faces)}
    while candidates:
        owned = _owned(candidates, len(scan))
        shares = {number: covered_share(c.raster, np.bincount(c.cell[owned[number]], minlength=len(c.raster.area))) if np.count_nonzero(owned[number]) >= _LEAST_POINTS
                  else 0.0 for number, c in candidates.items()}
        worst = min(shares, key=shares.__getitem__)
        if shares[worst] >= least:
            return shares
        for number in [n for n, share in shares.items() if share == 0] or [worst]:
            del candidates[number]
    return {}


def _candidate(face: FaceGeometry, scan: Array, reach: float) -> _Candidate:
    raster = make_raster(face, _CELLS)
    points = surface_coordinates(raster, scan, reach).on_face(raster, 0.0)
    return _Candidate(raster, points.index, np.abs(points.height), points.in_cell[0])


def _owned(candidates: dict[int, _Candidate], count: int) -> dict[int, NDArray[np.bool_]]:
    """For each face, which of its candidate points are nearer to it than to any other."""
    nearest, owner = np.full(count, np.inf), np.full(count, -1)
    for number, c in candidates.items():
        nearer = c.distance < nearest[c.points]
        nearest[c.points[nearer]], owner[c.points[nearer]] = c.distance[nearer], number
    return {number: owner[c.points] == number for number, c in candidates.items()}
