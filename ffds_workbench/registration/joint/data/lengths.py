# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lengths of one solve, found once: everything that has a unit of length and is no property of the shape."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ....errors import RefusedError
from ...arrays import Array, Index
from ...robust_weights import robust_sigma
from ..surfaces import Lattices, SpanGrid, by_face
from .correspondence import Correspondence, correspond, make_frames
from .scan_statistics import ScanStatistics

_TYPICAL, _SEEN = 0.75, 0.4
"""Quantiles of the distances from the nominal part to the scan and back that tell how far the part has moved: most of
the scan shows the part, or, where a table fills it, some of the part is seen."""
_REACH = 1.5
_LEAST_REACH = 3.0
_STIFF = 30.0
"""The reach over the scatter of the points about the shape while it is still stiff (unit)."""
_BESIDE_EDGE = 0.01
"""The same beside an edge, where no points hold the shape, over the reach (unit)."""
_PLANES_FAIL = 2.0
"""Noise about planes through neighbours over that about the nominal part from which the planes saw bends (unit)."""
_MODEL = 3e-4
"""Of the reach: what a lattice and linear matching leave of a displacement at best (unit: one in a thousand of it)."""


@dataclass(frozen=True)
class Lengths:
    """In mm.

    Attributes
    ----------
    size : diagonal of the box around the part
    spacing : between neighbouring points of the scan
    noise : standard deviation of the scan's points, and their ``resolution``
    reach : how far the scan may lie from the nominal part
    """

    size: float
    spacing: float
    noise: float
    resolution: float
    reach: float

    @property
    def start(self) -> float:
        """Standard deviation of a point about the part before it is deformed."""
        return max(self.noise, self.reach / _STIFF)

    @property
    def border(self) -> float:
        """Least standard deviation of the points about the shape beside an edge, where the cells hold none."""
        return max(self.noise, self.reach * _BESIDE_EDGE)

    @property
    def model(self) -> float:
        """Least standard deviation of what the points of a patch share."""
        return self.reach * _MODEL


def find_lengths(lattices: Lattices, cells: SpanGrid, distance: Array, sample: Array, statistics: ScanStatistics
                 ) -> tuple[Lengths, Array]:
    """The lengths, for cells with their ``distance`` (spans, k) from the border of their face, and how far the points
    of the sample lie from the nominal part, infinite beyond its size: (n,).

    Parameters
    ----------
    lattices : of all faces
    cells : the raster over them
    distance : (spans, k) of the cells from the border of their face in mm, negative outside
    sample : (n, 3) scan points in mm
    statistics : density and noise of the scan

    Raises
    ------
    RefusedError : the scan is farther from the part than the part is large
    """
    position = cells.nominal.position[cells.inside]
    size = float(np.linalg.norm(np.ptp(position, axis=0)))
    apart = np.asarray(cKDTree(position).query(sample, distance_upper_bound=size, workers=-1)[0])
    typical = float(np.sort(apart)[int(_TYPICAL * (len(apart) - 1))])
    if not np.isfinite(typical):
        raise RefusedError("The scan does not overlap the part: most of it is farther away than the part is large; "
                           "check the unit of the scan and align it first.")
    if typical > _LEAST_REACH / _REACH:
        back = cKDTree(sample).query(position, workers=-1)[0]
        typical = min(typical, float(np.quantile(back, _SEEN)))
    reach = max(_LEAST_REACH, _REACH * typical)
    frames = make_frames(lattices, cells, cells.nominal, np.zeros(len(distance)), distance)
    found = correspond(sample, frames, reach)
    beside = _noise_beside(sample[found.point], found, lattices.face_of_span[found.cell // distance.shape[1]])
    noise = max(statistics.noise if statistics.noise < _PLANES_FAIL * beside else beside, statistics.resolution)
    return Lengths(size, 1 / np.sqrt(statistics.density), noise, statistics.resolution, max(reach, 4 * noise)), apart


def _noise_beside(points: Array, found: Correspondence, face: Index) -> float:
    """Standard deviation of the heights of neighbours (n, 3) on the same face, infinite if there are none.

    Planes through neighbours, as in `scan_statistics`, see the bends and the far side of a part where points are few;
    heights above the nominal part see of a deformation only its slope.
    """
    if len(points) < 2:
        return float(np.inf)
    step = cKDTree(by_face(points, face)).query(by_face(points, face), k=2, workers=-1)[1][:, 1]
    same = face[step] == face
    return robust_sigma((found.height - found.height[step])[same]) / np.sqrt(2.0) if same.any() else np.inf
