# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a scan ends at an edge: beyond its outermost points, by as much as their density lets one expect.

Of points scattered at random with ρ of them per mm, the k-th outermost lies k/ρ inside the end on average, with a
standard deviation of √k/ρ (a Poisson process: theory). Noise carries a few points over the end, so the k grows with the
number of points within the noise. The visible borders of the joint solve and the rims of the alignment both rest on
this; which points belong to an edge, and when they tell anything, is their own business.
"""
from __future__ import annotations

import numpy as np

from ..arrays import Array, Index

_WITHIN_NOISE = 0.4
"""Of the noise's standard deviation σ: as many points as lie within it are passed over (theory: of ρ points per mm,
normal noise carries ρ σ/√(2π) over an end)."""


def outermost_points(station: Index, outward: Array, count: int, ranks: int) -> tuple[Array, Index]:
    """The outermost points at each of ``count`` stations along the edges, outermost first.

    Parameters
    ----------
    station : (n,) number of the station that a point belongs to
    outward : (n,) coordinate of the point across the edge, out of the face, in mm
    count : number of stations
    ranks : how many points are wanted of each

    Returns
    -------
    outermost : (ranks, count) their coordinates in mm, NaN where a station has fewer points
    number : (count,) points of each station
    """
    apart = 3.0 * float(np.abs(outward).max(initial=0.0)) or 1.0      # keeps the stations apart in one sort
    order = np.argsort(apart * station - outward)
    first = np.searchsorted(station[order], np.arange(count + 1))
    first, number = first[:-1], np.diff(first)
    outermost = np.full((ranks, count), np.nan)
    for rank in range(ranks):
        enough = number > rank
        outermost[rank, enough] = outward[order[first[enough] + rank]]
    return outermost, number


def end_of_scan(outermost: Array, density: Array, noise: float) -> tuple[Array, Array]:
    """Where the scan ends at n stations, and the standard deviation of that from the points' random places alone.

    Parameters
    ----------
    outermost : (ranks, n) from `outermost_points`
    density : (n,) points per mm across the edge
    noise : standard deviation of the points in mm

    Returns
    -------
    end, spread : (n,) each, in mm
    """
    rank = np.clip(np.ceil(_WITHIN_NOISE * noise * density), 1, len(outermost)).astype(int)
    return outermost[rank - 1, np.arange(len(density))] + rank / density, np.sqrt(rank) / density


def weight_of_end(gap: Array, spread: Array, usual_loss: float) -> Array:
    """Weight 1/variance, (n,) in 1/mm², of ends that lie ``gap`` (n,) mm outside the edge.

    Sensors lose points at edges and see none beyond them: an end that lies inside by more than ``usual_loss`` mm is as
    uncertain as it lies far inside; ``spread`` (n,) is the standard deviation of the others in mm.
    """
    return 1.0 / (spread**2 * (1.0 + (np.minimum(gap, 0.0) / usual_loss) ** 2))
