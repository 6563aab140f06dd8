# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a scan ends along the part's rims: this constrains it in the directions that its surfaces leave free."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motions import apply
from ...scan_points import end_of_scan, outermost_points, weight_of_end
from ..model import Rims
from ..settings import RimSettings

_EITHER_SIDE = 2
"""Stretches on either side that one is compared with: a stray point or a hole shows in a single one (theory: a median
of five)."""


@dataclass(frozen=True)
class ScanEnds:
    """Stretches of rim along which the scan is seen to end.

    Attributes
    ----------
    stretch : (n,) their numbers
    places, outwards : (n, 3) in mm and unit vectors
    gap : (n,) in mm from the rim to the end of the scan, negative where it ends inside
    weight : (n,) 1/mm²
    """

    stretch: NDArray[np.intp]
    places: Array
    outwards: Array
    gap: Array
    weight: Array

    def moved(self, motion: Array) -> ScanEnds:
        """After a little ``motion`` (4, 4) of the scan."""
        end = self.places + self.gap[:, None] * self.outwards
        more = np.einsum("ni,ni->n", apply(motion, end) - end, self.outwards)
        return replace(self, gap=self.gap + more)


def points_near_rims(rims: Rims, points: Array, reach: float, hidden: NDArray[np.bool_] | None = None,
                     ) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Which of the points (n, 3), in model coordinates, lie near which rims: near enough to show where the scan ends
    within a reach.

    Parameters
    ----------
    reach : in mm
    hidden : (m,) which stretches are of the side of a sheet that the scan does not show: what lies beside those is of
        the other side

    Returns
    -------
    row, entry : (k,) numbers of the point and of the one on the rim; a point beside an edge has one on either face
    """
    nearest = rims.nearest(points, np.eye(4))
    row = np.flatnonzero(nearest >= 0)
    apart = points.take(row, axis=0) - rims.points.take(nearest[row], axis=0)
    row = row[np.linalg.norm(apart, axis=1) < reach + rims.settings.band[1] * rims.step]
    first = nearest[row]
    if hidden is not None:
        first = np.where(hidden[rims.stretch[first]], rims.across[first], first)
    partner = rims.partner[first]
    other = partner != first
    row, entry = np.concatenate([row, row[other]]), np.concatenate([first, partner[other]])
    clear = rims.clear(rims.settings.band[1] * rims.step)[entry]
    return row[clear], entry[clear]


def find_scan_ends(rims: Rims, points: Array, entry: NDArray[np.intp], reach: float, noise: float,
                   tolerance: float) -> ScanEnds:
    """Where the scan ends: at the outermost points on the faces, plus what their density lets one expect beyond.

    Parameters
    ----------
    points : (n, 3) in model coordinates beside the rims, of even density along each
    entry : (n,) the point on the rim that each lies beside
    reach : in mm; ends farther than this from the rim are not recognised
    noise : standard deviation of the points in mm
    tolerance : in mm, height up to which a point is on a face
    """
    settings, count, step = rims.settings, len(rims.middles), rims.step
    begin, end = settings.band
    offset, stretch = points - rims.points.take(entry, axis=0), rims.stretch[entry]
    beyond = np.einsum("ni,ni->n", offset, rims.outwards.take(entry, axis=0))
    height = np.abs(np.einsum("ni,ni->n", offset, rims.normals.take(entry, axis=0)))
    on = np.flatnonzero((height < tolerance) & (np.abs(beyond) < reach + end * step))
    outermost, number = outermost_points(stretch[on], beyond[on], count, settings.largest_rank)
    inside = (outermost[0, stretch[on]] - beyond[on]) / step
    band = np.bincount(stretch[on][(inside > begin) & (inside < end)], minlength=count)
    density = band / ((end - begin) * step)
    wall = (height >= tolerance) & (height < tolerance + 2.0 * settings.wall_steps * step)
    wall &= np.abs(beyond - outermost[0, stretch]) < settings.wall_steps * step
    strange = np.bincount(stretch[wall], minlength=count)
    told = np.flatnonzero((band >= settings.least_band_points) & (number > settings.largest_rank)
                          & (strange < 1.0 + settings.wall_noise * noise * density))
    gap, spread = end_of_scan(outermost[:, told], density[told], noise)
    spread = np.hypot(settings.uncertainty * noise, spread)
    seen = (np.abs(gap) < reach) & _agrees_with_neighbours(told, gap, spread, count, settings)
    told, gap, spread = told[seen], gap[seen], spread[seen]
    return ScanEnds(told, rims.middles[told], rims.outward_directions[told], gap,
                    weight_of_end(gap, spread, settings.usual_loss * noise))


def _agrees_with_neighbours(stretch: NDArray[np.intp], gap: Array, spread: Array, count: int,
                            settings: RimSettings) -> NDArray[np.bool_]:
    """Whether a stretch has about the same gap as its neighbours along the rim, and enough of these have one."""
    gaps = np.full(count + 2 * _EITHER_SIDE, np.nan)
    gaps[stretch + _EITHER_SIDE] = gap
    around = np.sort(np.lib.stride_tricks.sliding_window_view(gaps, 2 * _EITHER_SIDE + 1)[stretch], axis=1)
    number = np.isfinite(around).sum(axis=1)
    middle = 0.5 * (around[np.arange(len(stretch)), (number - 1) // 2] + around[np.arange(len(stretch)), number // 2])
    return (number >= settings.telling) & (np.abs(gap - middle) < settings.odd_sigmas * spread)
