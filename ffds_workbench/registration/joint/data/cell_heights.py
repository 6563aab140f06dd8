# SPDX-License-Identifier: LGPL-2.1-or-later
"""One robust height per raster cell, with its weight: medians while the shape still moves, Tukey means at the end."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Index
from ...robust_weights import TUKEY_SIGMAS, tukey
from .correspondence import Correspondence
from .scatter import Scatter, model_noise, of_cells, patch_sums, sensor_noise, spread

_MEDIAN_EFFICIENCY = 0.64
"""Of the median of very many points against their mean: 2/π (theory)."""


@dataclass(frozen=True)
class CellHeights:
    """Heights of the scan above the current surface, cell by cell.

    Attributes
    ----------
    height : (cells,) mm, zero where nothing was seen
    weight : (cells,) 1/mm²
    count : (cells,) points that carry weight
    scatter : of the heights
    """

    height: Array
    weight: Array
    count: Array
    scatter: Scatter


def no_heights(cells: int, scatter: Scatter) -> CellHeights:
    """The values before anything was matched.

    Parameters
    ----------
    cells : how many there are
    scatter : standard deviations of the heights so far
    """
    return CellHeights(np.zeros(cells), np.zeros(cells), np.zeros(cells), scatter)


def median_heights(found: Correspondence, scatter: Scatter, face_of_span: Index, per_span: int) -> CellHeights:
    """Median height of every cell, weighted 0.64 n/s² (the median's efficiency on Gaussian noise) with the scale s of
    the loss.

    Parameters
    ----------
    found : the scan points with their cells
    scatter : standard deviations of the heights so far
    face_of_span : (spans,) number of the face
    per_span : cells of a span
    """
    cells = len(face_of_span) * per_span
    order = np.lexsort((found.height, found.cell))
    cell, height = found.cell[order], found.height[order]
    first = np.flatnonzero(np.r_[True, cell[1:] != cell[:-1]]) if len(cell) else np.zeros(0, dtype=np.intp)
    count = np.diff(np.r_[first, len(cell)])
    result, weight, counts = np.zeros(cells), np.zeros(cells), np.zeros(cells)
    at = cell[first]
    result[at] = 0.5 * (height[first + (count - 1) // 2] + height[first + count // 2])
    scale = scatter.loss[face_of_span[at // per_span]]
    weight[at] = np.where(count < 3, 1.0, _MEDIAN_EFFICIENCY) * count / scale**2
    counts[at] = count
    return CellHeights(result, weight, counts, scatter)


def tukey_mean_heights(found: Correspondence, scatter: Scatter, face_of_span: Index, per_span: int,
                       least: tuple[float, float]) -> CellHeights:
    """Mean height of every cell with Tukey's biweight about the current surface, weighted n/(σ² + N τ²).

    The N points of a patch of cells share the error τ of the model. Noise σ and τ are measured anew, ``least`` are the
    smallest that they can be, in mm.

    Parameters
    ----------
    found : the scan points with their cells
    scatter : standard deviations of the heights so far
    face_of_span : (spans,) number of the face
    per_span : cells of a span
    """
    cells = len(face_of_span) * per_span
    face = np.repeat(face_of_span, per_span)
    scale = np.maximum(scatter.loss, scatter.of_face)[face[found.cell]]
    robust = tukey(found.height, TUKEY_SIGMAS * scale)
    total = np.bincount(found.cell, robust, cells).astype(float)
    height = np.bincount(found.cell, robust * found.height, cells).astype(float) / np.maximum(total, 1e-9)
    height[total == 0] = 0.0
    used = robust > 0
    count = np.bincount(found.cell[used], minlength=cells).astype(float)
    sensor = sensor_noise(found.height[used], found.cell[used], height, count, face[found.cell[used]],
                          scatter.sensor, least[0])
    shape = len(face_of_span), per_span
    model = model_noise(height.reshape(shape), total.reshape(shape), face_of_span, sensor)
    model = np.maximum(model, least[1])
    about = np.minimum(scatter.loss, spread(np.abs(found.height), face[found.cell], len(sensor), 0.9))
    shared = of_cells(patch_sums(total.reshape(shape)), int(np.sqrt(per_span))).ravel()
    weight = total / (sensor[face] ** 2 + shared * model[face] ** 2)
    return CellHeights(height, weight, count, Scatter(sensor, model, about))
