# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scan points of a face: a sample for the steps that need no more, and all of them, piece by piece.

Many points are not kept but located anew in each step, so that memory does not grow with the scan.
"""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...footpoints import Locator, SurfaceCoordinates, joined, located, make_locator
from ...uv_raster import Raster

_MOST_KEPT = 150_000
"""Foot points that are kept in memory; those of larger scans are located anew in every step (unit: memory)."""
_DRAWN = 2
"""The sample is drawn from this many times as many scan points (unit: half of a scan lies off the face)."""


@dataclass(frozen=True)
class FacePoints:
    """Scan points over a trimmed face.

    Attributes
    ----------
    raster : of the face
    scan : (n, 3) in mm
    reach : distance in mm from the face within which points are kept
    margin : in mm, that points have to keep from the trims
    locate : finds foot points on the face
    sample : some of those at least the margin from the trims, drawn at random but always the same
    count : number of those at least the margin from the trims; an estimate where they are not kept
    kept : all of those, and those nearer to the trims, where they are few
    """

    raster: Raster
    scan: Array
    reach: float
    margin: float
    locate: Locator
    sample: SurfaceCoordinates
    count: int
    kept: tuple[SurfaceCoordinates, SurfaceCoordinates] | None

    def pieces(self) -> Iterator[tuple[SurfaceCoordinates, SurfaceCoordinates]]:
        """All points, piece by piece: those at least the margin from the trims, and those nearer to them."""
        if self.kept is None:
            yield from _split(self.raster, self.scan, self.reach, self.margin, self.locate)
        else:
            inner, rim = self.kept
            for some in inner.chunks():
                yield some, rim.part(slice(0))
            yield inner.part(slice(0)), rim

    def only(self, mask: NDArray[np.bool_]) -> FacePoints:
        """The same with a part of the kept points, by a ``mask`` (n,) over those at least the margin from the trims.

        Raises
        ------
        ValueError : the points are too many to be kept
        """
        if self.kept is None:
            raise ValueError("the points are too many to be kept")
        inner = self.kept[0].part(np.flatnonzero(mask))
        return replace(self, sample=inner.sample(len(self.sample.x)), count=len(inner.x), kept=(inner, self.kept[1]))

    def occupied(self) -> int:
        """Number of cells that hold points at least the margin from the trims."""
        seen = np.zeros(len(self.raster.inside), dtype=bool)
        for inner, _ in self.pieces():
            seen[inner.in_cell[0]] = True
        return np.count_nonzero(seen)


def face_points(raster: Raster, scan: Array, reach: float, margin: float, sample: int) -> FacePoints:
    """The points of a scan whose foot points lie on the trimmed face.

    Parameters
    ----------
    raster : of the face
    scan : (n, 3) in mm
    reach : largest |height| in mm
    margin : distance from the trims in mm that sets inner points apart
    sample : number of points that the sample has at most
    """
    locate = make_locator(raster, reach)
    random = np.random.default_rng(0)
    drawn = _DRAWN * sample
    while len(scan) > max(_MOST_KEPT, 2 * drawn):
        some = scan[random.integers(len(scan), size=drawn)]
        inner = joined([piece for piece, _ in _split(raster, some, reach, margin, locate)], raster)
        count = round(len(inner.x) / drawn * len(scan))
        if count <= _MOST_KEPT:
            break
        if len(inner.x) >= sample:
            return FacePoints(raster, scan, reach, margin, locate, inner.part(slice(sample)), count, None)
        drawn *= 1 + round(sample / len(inner.x))
    pieces = list(_split(raster, scan, reach, margin, locate))
    inner, rim = (joined([piece[k] for piece in pieces], raster) for k in (0, 1))
    return FacePoints(raster, scan, reach, margin, locate, inner.sample(sample), len(inner.x), (inner, rim))


def _split(raster: Raster, scan: Array, reach: float, margin: float, locate: Locator
           ) -> Iterator[tuple[SurfaceCoordinates, SurfaceCoordinates]]:
    for some in located(raster, scan, reach, locate):
        depth = some.depth(raster)
        yield some.part(np.flatnonzero(depth >= margin)), some.part(np.flatnonzero((depth >= 0) & (depth < margin)))
