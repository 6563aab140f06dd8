# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lattices' own errors: residual heights of the scan that have the same sign among neighbours and exceed the noise.

Where priors hold a face off the scan, or its lattice cannot follow, the covariance does not show it.
"""
from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array, Index
from ..surfaces import Lattices, SpanGrid, by_face
from .cell_heights import CellHeights
from .scatter import patch_sums

_POOLING_RADIUS = 0.115
"""Over the size of their solid: spans this near to each other are judged together, as one alone holds too few points to
tell (unit: a little more than a span)."""


def misfit(values: CellHeights, lattices: Lattices, cells: SpanGrid, body_size: Array) -> Array:
    """Variance of the misfit around every span, (spans,) in mm²: of its mean, and of what varies from patch to patch.

    Both are what is left when the expectation from noise is taken off (the moment estimator of DerSimonian and Laird,
    Controlled Clinical Trials 7, 1986).

    Parameters
    ----------
    values : heights of the scan, cell by cell
    lattices : of all faces
    cells : the raster over them
    body_size : (spans,) size in mm of the solid that a span belongs to
    """
    height, weight = (cell.reshape(cells.inside.shape) for cell in (values.height, values.weight))
    pull, total = patch_sums(height * weight), patch_sums(weight)
    seen = total > 0
    excess = np.where(seen, pull**2 / np.where(seen, total, 1.0) - 1.0, 0.0).sum(axis=(1, 2))
    place = _span_middles(lattices, cells)
    near = cKDTree(place).query_ball_point(place, _POOLING_RADIUS * body_size, workers=-1)
    row, column = np.repeat(np.arange(len(place)), [len(item) for item in near]), np.concatenate(near).astype(np.intp)
    around = [np.bincount(row, item[column], len(place))
              for item in (total.sum(axis=(1, 2)), pull.sum(axis=(1, 2)), excess)]
    information = np.maximum(around[0], 1e-12)
    mean = np.maximum((around[1] / information) ** 2 - 1.0 / information, 0.0)
    varying = np.maximum(around[2] / information, 0.0)
    return np.where(around[0] > 0, mean + varying, 0.0)


def nearest_spans(lattices: Lattices, cells: SpanGrid, face: Index, position: Array) -> Index:
    """The span of faces (n,) whose middle is nearest to nominal places (n, 3) in mm: (n,).

    Parameters
    ----------
    lattices : of all faces
    cells : the raster over them
    face : (n,) number of the face
    position : (n, 3) in mm
    """
    return cKDTree(_span_middles(lattices, cells)).query(by_face(position, face), workers=-1)[1]


def _span_middles(lattices: Lattices, cells: SpanGrid) -> Array:
    """Middles of the spans `by_face`: (spans, 4)."""
    return by_face(cells.nominal.position.mean(axis=1), lattices.face_of_span)
