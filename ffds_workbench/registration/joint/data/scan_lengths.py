# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the scan lies from the nominal part, how dense it is and how much its points scatter."""
from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ....errors import RefusedError
from ...arrays import Array, Index
from ...robust_weights import quantile, robust_sigma
from ..lengths import Lengths
from ..surfaces import BorderDistance, Lattices, SpanGrid, by_face
from .correspondence import Correspondence, correspond, make_frames
from .scan_statistics import ScanStatistics

_TYPICAL, _SEEN = 0.75, 0.4
"""Quantiles of the distances from the nominal part to the scan and back that tell how far the part has moved: most of
the scan shows the part, or, where a table fills it, some of the part is seen (unit)."""
_LARGE = 0.05
"""Typical distance over the size of the part from which the scan may be a table's for the most part (unit)."""
_FARTHEST = 3.0
"""Over the typical distance: what is matched for the first look (unit)."""
_BULK, _LEAST_EXTENT = 0.9, 0.02
"""Twice this quantile of the distances of points from their median is the extent of a scan; over the size of the part,
that of a scan that cannot tell how the part lies (unit: metres for millimetres are a thousandth; inches, a
twenty-fifth, are not found by this)."""
_MOST_POINTS, _REACH = 0.9, 2.5
"""Quantile of the matched heights, and how many times as far some of the part may have moved (unit)."""
_REACH_IN_NOISES = 6.0
"""Least reach over the noise (theory: hardly any point of a normal distribution is farther)."""
_LEAST_REACH = 1e-4
"""Over the size of the part (unit: far below what anybody can see, far above what a file rounds)."""
_PLANES_FAIL = 2.0
"""Noise about planes through neighbours over that about the nominal part from which the planes saw bends (unit)."""


def find_lengths(lattices: Lattices, cells: SpanGrid, sample: Array, statistics: ScanStatistics) -> Lengths:
    """What has a unit of length in one solve and is no property of the shape.

    Parameters
    ----------
    lattices : of all faces
    cells : of the nominal faces
    sample : (n, 3) points of the scan in mm
    statistics : of the whole scan

    Raises
    ------
    RefusedError : the scan is farther from the part than the part is large, or hardly extends along it
    """
    position = cells.nominal.position[cells.inside]
    size = 2 * float(np.linalg.norm(position - position.mean(axis=0), axis=1).max())
    extent = 2 * quantile(np.linalg.norm(sample - np.median(sample, axis=0), axis=1), _BULK)
    if extent < _LEAST_EXTENT * size:
        raise RefusedError(f"The scan extends over only {extent:.2g} mm of a part of {size:.0f} mm: check its unit, or "
                           "scan more of the part.")
    apart = np.asarray(cKDTree(position).query(sample, distance_upper_bound=size, workers=-1)[0])
    typical = quantile(apart, _TYPICAL)
    if not np.isfinite(typical):
        raise RefusedError("The scan does not overlap the part: most of it is farther away than the part is large; "
                           "check the unit of the scan and align it first.")
    if typical > _LARGE * size:
        back = cKDTree(sample).query(position, workers=-1)[0]
        typical = min(typical, float(np.quantile(back, _SEEN)))
    anywhere = BorderDistance(np.where(cells.inside, np.inf, -np.inf), np.zeros((*cells.inside.shape, 2)))
    frames = make_frames(lattices, cells, cells.nominal, np.zeros(len(cells.inside)), anywhere)
    farthest = _FARTHEST * typical
    found = correspond(sample, frames, farthest)
    beside = _noise_beside(sample[found.point], found, lattices.face_of_span[found.cell // cells.inside.shape[1]])
    noise = max(statistics.noise if statistics.noise < _PLANES_FAIL * beside else beside, statistics.resolution)
    moved = quantile(np.abs(found.height), _MOST_POINTS) if len(found.point) else typical
    reach = max(_REACH * moved, _REACH_IN_NOISES * noise, _LEAST_REACH * size)
    return Lengths(size, 1 / np.sqrt(statistics.density), noise, statistics.resolution, reach, max(reach, farthest))


def _noise_beside(points: Array, found: Correspondence, face: Index) -> float:
    """Standard deviation of the heights of neighbours (n, 3) on the same face, infinite if there are none.

    Planes through neighbours, as in `scan_statistics`, take in bends and the far side of a part where points are few;
    of a deformation, differences of heights over the nominal part contain only the slope.
    """
    if len(points) < 2:
        return float(np.inf)
    step = cKDTree(by_face(points, face)).query(by_face(points, face), k=2, workers=-1)[1][:, 1]
    same = face[step] == face
    return robust_sigma((found.height - found.height[step])[same]) / np.sqrt(2.0) if same.any() else np.inf
