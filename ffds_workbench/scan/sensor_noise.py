# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures a sensor's noise, white and correlated, on a flat datum or by repeated scans of anything that stands still.

Both give mean heights in small cells: above the datum's plane, or of each scan above the mean of all. White noise is
not shared by two cells, so the covariance of different cells is that of the correlated noise alone, at their distance.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..errors import RefusedError
from ..registration.arrays import Array
from ..registration.joint import SensorProfile
from ..registration.robust_weights import MAD_TO_SIGMA
from .covariogram import covariogram, fit

Index = NDArray[np.intp]

_LEAST_POINTS = 1000
_TRIM = 4.5
_MOST_LOST = 0.3
_PER_CELL = 4.0
_NEIGHBOURS = 40
_SOME = 5000
_ROUGH = 2.0
_OTHER_SCANS = 0.5


@dataclass(frozen=True)
class _NoiseCells:
    """Points (n,) in small cells, with their heights there.

    Attributes
    ----------
    cell, height : (n,) of every point
    place, normal : (cells, 3)
    size : in mm
    """

    cell: Index
    height: Array
    place: Array
    normal: Array
    size: float


def measure(scans: Sequence[Array], flat: bool = False, name: str = "measured") -> SensorProfile:
    """The profile of a sensor from scans (n, 3) in mm: of a flat datum that fills each of them, or repeated.

    Repeated scans show the same thing from the same place. What they all share is shape, and a small rigid motion
    between them is no noise.

    Parameters
    ----------
    flat : the scans show a flat datum; a single one must

    Raises
    ------
    RefusedError : too few points, no plane, or scans that do not show the same thing
    """
    for scan in scans:
        if len(scan) < _LEAST_POINTS:
            raise RefusedError(f"The scan has {len(scan)} points: measuring a sensor takes at least {_LEAST_POINTS}.")
    if flat or len(scans) == 1:
        found = [_one(_flat_cells(scan), name) for scan in scans]
        return _mean(found, name)
    return _repeated(scans, name)


def _one(cells: _NoiseCells, name: str) -> SensorProfile:
    shot = np.zeros(len(cells.cell), dtype=np.intp)
    return _profile(cells, shot, 1, name)


def _mean(profiles: Sequence[SensorProfile], name: str) -> SensorProfile:
    """The profile whose variances are the means of those of several scans."""
    white, shared = (float(np.mean(values)) for values in
                     zip(*(((item.sigma or 0.0) ** 2, item.sigma_c**2) for item in profiles), strict=True))
    length = np.sqrt(np.mean([item.shared for item in profiles]) / (2 * np.pi * shared)) if shared else 0.0
    return SensorProfile(float(np.sqrt(white)), float(np.sqrt(shared)), float(length), name)


def _flat_cells(scan: Array) -> _NoiseCells:
    """Cells on the plane of a scan, without outliers."""
    kept = np.ones(len(scan), dtype=bool)
    for _ in range(6):
        middle = scan[kept].mean(axis=0)
        axes = np.linalg.eigh(np.cov((scan[kept] - middle).T))[1]
        local = (scan - middle) @ axes
        kept = _trimmed(local[:, 0])
    if kept.mean() < 1 - _MOST_LOST:
        raise RefusedError("The scan does not show a flat datum: crop it to the datum alone.")
    local = local[kept]
    size = _cell_size(local * [0, 1, 1], 1)
    cell = np.unique(np.floor(local[:, 1:] / size), axis=0, return_inverse=True)[1]
    count = np.bincount(cell)
    place = np.stack([np.bincount(cell, local[:, k]) / count for k in (1, 2)], axis=1)
    return _NoiseCells(cell, local[:, 0] - local[:, 0].mean(), np.column_stack([place, np.zeros(len(place))]),
                       np.tile([0.0, 0.0, 1.0], (len(place), 1)), size)


def _repeated(scans: Sequence[Array], name: str) -> SensorProfile:
    fused = np.concatenate(scans)
    shot = np.repeat(np.arange(len(scans)), [len(scan) for scan in scans])
    cells, kept = _surface_cells(fused, len(scans))
    shot = shot[kept]
    seen = np.bincount(cells.cell * len(scans) + shot, minlength=len(cells.place) * len(scans)).reshape(-1, len(scans))
    full = (seen > 0).all(axis=1)
    if seen[full].sum() < _OTHER_SCANS * len(fused):
        raise RefusedError("The repeated scans do not show the same thing: scan it again without moving it or the "
                           "sensor.")
    number = np.cumsum(full) - 1
    inside = full[cells.cell]
    cells = _NoiseCells(number[cells.cell[inside]], cells.height[inside], cells.place[full], cells.normal[full],
                        cells.size)
    return _profile(cells, shot[inside], len(scans), name)


def _surface_cells(points: Array, scans: int) -> tuple[_NoiseCells, Index]:
    """Cells over any surface, on a grid seen along the axis that the normal is nearest to, so that noise does not cut
    them, and which points they hold: no outliers, and none where the surface is not smooth."""
    size = _cell_size(points, scans)
    some = points[:: max(1, len(points) // _SOME)]
    axis = np.abs(_normals(points, some)[0]).argmax(axis=1)[cKDTree(some).query(points, workers=-1)[1]]
    key = np.column_stack([np.floor(points / size), axis])
    key[np.arange(len(points)), axis] = 0
    cell = np.unique(key, axis=0, return_inverse=True)[1]
    count = np.bincount(cell)
    place = np.stack([np.bincount(cell, points[:, k]) / count for k in range(3)], axis=1)
    normal, spread = _normals(points, place)
    height = np.einsum("nx,nx->n", points - place[cell], normal[cell])
    kept = (spread < _ROUGH * np.median(spread))[cell] & _trimmed(height)
    return _NoiseCells(cell[kept], height[kept], place, normal, size), np.flatnonzero(kept)


def _normals(points: Array, places: Array) -> tuple[Array, Array]:
    """Normals (n, 3) at places from the points around, and the points' rms distance from their planes (n,)."""
    near = points[cKDTree(points).query(places, _NEIGHBOURS, workers=-1)[1]]
    near = near - near.mean(axis=1, keepdims=True)
    spread, axes = np.linalg.eigh(np.matmul(near.swapaxes(1, 2), near))
    return axes[:, :, 0], np.sqrt(np.maximum(spread[:, 0], 0) / _NEIGHBOURS)


def _trimmed(height: Array) -> NDArray[np.bool_]:
    """Which heights lie within 4.5 robust standard deviations of their median."""
    off = np.abs(height - np.median(height))
    return off <= _TRIM * MAD_TO_SIGMA * np.median(off)


def _cell_size(points: Array, scans: int) -> float:
    """Size in mm of cells that hold a few points of every scan."""
    probes = points[:: max(1, len(points) // 2000)]
    reach = np.median(cKDTree(points).query(probes, _NEIGHBOURS)[0][:, -1])
    return float(np.sqrt(_PER_CELL * scans * np.pi / _NEIGHBOURS) * reach)


def _profile(cells: _NoiseCells, shot: Index, scans: int, name: str) -> SensorProfile:
    """White and correlated noise from the heights in cells and the number (n,) of the scan that each point is of."""
    flat = cells.cell * scans + shot
    count = np.bincount(flat, minlength=len(cells.place) * scans).astype(float)
    mean = np.bincount(flat, cells.height, len(count)) / np.maximum(count, 1)
    scatter = float(((cells.height - mean[flat]) ** 2).sum() / max(len(flat) - (count > 0).sum(), 1))
    mean, count = mean.reshape(-1, scans), count.reshape(-1, scans)
    if scans > 1:
        mean = mean - mean.mean(axis=1, keepdims=True)
    tables = [covariogram(cells.place, cells.normal, _without_motion(mean[:, k], cells), count[:, k])
              for k in range(scans)]
    found = fit(tables, cells.size, 1.0 - 1.0 / scans if scans > 1 else 1.0)
    if found is None:
        return SensorProfile(float(np.sqrt(scatter)), 0.0, 0.0, name)
    variance, length = found
    # Averaging over a cell is nearly a Gaussian filter of variance size²/12 per axis: this much varies within it.
    blur = cells.size**2 / 6
    white = max(scatter - variance * blur / (length**2 + blur), 1e-4 * scatter)
    return SensorProfile(float(np.sqrt(white)), float(np.sqrt(variance)), length, name)


def _without_motion(height: Array, cells: _NoiseCells) -> Array:
    """Heights without what a small rigid motion of the scan explains."""
    rows = np.hstack([np.cross(cells.place - cells.place.mean(axis=0), cells.normal), cells.normal])
    return height - rows @ np.linalg.lstsq(rows, height, rcond=1e-9)[0]
