# SPDX-License-Identifier: LGPL-2.1-or-later
"""One robust height per raster cell, with its weight: medians while the shape still moves, Tukey means at the end."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Index
from ...robust_weights import TUKEY_SIGMAS, robust_sigma, tukey
from .correspondence import Correspondence

_MEDIAN_EFFICIENCY = 0.64
_LEAST_POINTS_FOR_NOISE = 200


@dataclass(frozen=True)
class CellHeights:
    """Heights of the scan above the current surface, cell by cell.

    Attributes
    ----------
    height : (cells,) mm, zero where nothing was seen
    weight : (cells,) 1/mm²
    count : (cells,) points that carry weight
    noise : (faces,) standard deviation in mm
    """

    height: Array
    weight: Array
    count: Array
    noise: Array


def no_heights(cells: int, noise: Array) -> CellHeights:
    """The values before anything was matched."""
    return CellHeights(np.zeros(cells), np.zeros(cells), np.zeros(cells), noise)


def median_heights(found: Correspondence, cells: int, noise: Array, face_of_cell: Index) -> CellHeights:
    """Median height of every cell, weighted 0.64 n/σ² (the median's efficiency on Gaussian noise)."""
    order = np.lexsort((found.height, found.cell))
    cell, height = found.cell[order], found.height[order]
    first = np.flatnonzero(np.r_[True, cell[1:] != cell[:-1]]) if len(cell) else np.zeros(0, dtype=np.intp)
    count = np.diff(np.r_[first, len(cell)])
    result, weight, counts = np.zeros(cells), np.zeros(cells), np.zeros(cells)
    at = cell[first]
    result[at] = 0.5 * (height[first + (count - 1) // 2] + height[first + count // 2])
    weight[at] = np.where(count < 3, 1.0, _MEDIAN_EFFICIENCY) * count / noise[face_of_cell[at]] ** 2
    counts[at] = count
    return CellHeights(result, weight, counts, noise)


def tukey_mean_heights(found: Correspondence, cells: int, start: Array, face_of_cell: Index) -> CellHeights:
    """Mean height of every cell with Tukey's biweight (c = 4.685 σ) about the current surface, weighted n/σ².

    ``start`` (faces,) is the noise to fall back on where a face has too few points to measure its own.
    """
    noise = face_noise(found, start, face_of_cell)
    weight = tukey(found.height, TUKEY_SIGMAS * noise[face_of_cell[found.cell]])
    total = np.bincount(found.cell, weights=weight, minlength=cells)
    height = np.bincount(found.cell, weights=weight * found.height, minlength=cells) / np.maximum(total, 1e-9)
    height[total == 0] = 0.0
    count = np.bincount(found.cell[weight > 0], minlength=cells).astype(float)
    return CellHeights(height, total / noise[face_of_cell] ** 2, count, noise)


def face_noise(found: Correspondence, start: Array, face_of_cell: Index) -> Array:
    """Robust standard deviation of the heights on every face, within its cells where they hold enough points."""
    face = face_of_cell[found.cell]
    order = np.argsort(face, kind="stable")
    bounds = np.searchsorted(face[order], np.arange(len(start) + 1))
    noise = start.copy()
    for k in np.flatnonzero(np.diff(bounds) >= _LEAST_POINTS_FOR_NOISE):
        height = found.height[order[bounds[k] : bounds[k + 1]]]
        noise[k] = robust_sigma(height - np.median(height))
    return np.maximum(noise, 1e-6)
