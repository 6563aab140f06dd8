# SPDX-License-Identifier: LGPL-2.1-or-later
"""The size of a control lattice that a scan can determine: coarse for the early steps, by held-out data for the last.

Both directions get the same span in mm. The lattice is the one that predicts held-out parts of the face best: finer
ones follow noise, coarser ones miss shape.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...splines import DEGREE, SplineSurface, basis_matrix, clamped_knots
from ...uv_raster import Raster
from ..control_lattice import ControlLattice, displacement_lattice, periodic_knots, sum_repeated
from .layers import Layers
from .normal_equations import LEAST_NOISE

Index = NDArray[np.intp]

_SPAN_IN_LENGTHS = 4.0
"""Shortest span over the length that a smoothing spline averages over (theory: finer spans add nothing)."""
_COARSE_SPANS = 7
"""Spans along the longer side in the early steps (calibrated: by hand, on the synthetic sheets of ``./ffds benchmark
accuracy``)."""
_LARGEST_TURN = np.radians(30)
"""Turn of the normal over a span in rad (theory: a cubic follows such an arc to 2e-4 of its radius)."""
_LEAST_CONTROLS, _LARGEST_CONTROLS = 4, 64
"""Control points per direction: a cubic's least (theory), and the most (unit: time)."""
_TRIED_SPANS = (2, 3, 4, 6, 8, 11, 15, 20, 27)
"""Numbers of spans along the longer side that are tried, each a third more than the one before (unit: time)."""
_HELD_OUT_BLOCKS, _HELD_OUT_SHARE = 3, 0.125
"""Side of the squares that are held out, in blocks and in lengths of the face (unit: noise there then has little in
common with what is left)."""
_FOLD_COUNT = 4
"""Parts that are held out in turn (theory: no two neighbouring squares are in the same)."""
_ALIKE_RESIDUALS = 0.01
"""Of two lattices whose squared held-out residuals differ by less than this share the smaller is taken (calibrated: by
hand, on the synthetic sheets of ``./ffds benchmark accuracy``)."""
_ALWAYS_TRIED, _PATIENCE = 8, 2
"""Spans up to which all sizes are tried, and larger sizes that may be worse than the best one before the search ends
(unit: time)."""
_OUTLIER_VARIANCES = 16.0
"""Variances at which a squared residual is cut, so that no single stray layer decides (theory: four standard
deviations)."""
_BENDING_NODES = 100
"""Places over [0, 1] at which products of basis functions are summed: three or more a span (unit: time)."""


def coarse_lattice(raster: Raster, layers: Layers, stiffness: float) -> tuple[int, int]:
    """(N_i, N_j) for the early steps: at most 7 spans along the longer side, none finer than the data resolve.

    Parameters
    ----------
    raster : of the face
    layers : heights of the scan over the nominal, block by block
    stiffness : weight of the bending energy in chi-square units

    Notes
    -----
    A smoothing spline with bending weight λ on ρ points per mm² of noise σ averages over the length (λ σ² / ρ)^¼.
    """
    return _size(raster, min(_COARSE_SPANS, _finest(raster, layers, stiffness)))


def automatic_lattice(surface: SplineSurface, raster: Raster, layers: Layers, weights: Array,
                      stiffness: float) -> tuple[int, int]:
    """(N_i, N_j) of the lattice after the smallest that predicts held-out layers about as well as any.

    One size more costs little noise, as the fit is regularised, and holding out makes the choice a little coarse.

    Parameters
    ----------
    surface, raster : the nominal surface, and the raster of the face
    layers : heights of the scan over the nominal, block by block
    weights : (k,) weight of each layer: its points, zero for what is not the face
    stiffness : weight of the bending energy in chi-square units
    """
    finest = _finest(raster, layers, stiffness)
    sample = _folds(raster, layers, weights / max(layers.noise, LEAST_NOISE) ** 2)
    scores: list[float] = []
    sizes: list[tuple[int, int]] = []
    for spans in [s for s in _TRIED_SPANS if s <= finest] or [_TRIED_SPANS[0]]:
        sizes.append(_size(raster, spans))
        scores.append(_held_out(displacement_lattice(surface, sizes[-1]), raster, sample, stiffness))
        if spans >= _ALWAYS_TRIED and len(scores) - 1 - int(np.argmin(scores)) >= _PATIENCE:
            break
    good = np.flatnonzero(np.array(scores) <= min(scores) * (1 + _ALIKE_RESIDUALS))
    return sizes[min(int(good[0]) + 1, len(sizes) - 1)]


def _finest(raster: Raster, layers: Layers, stiffness: float) -> float:
    length = (stiffness * max(layers.noise, LEAST_NOISE) ** 2 / layers.density) ** 0.25
    return float(max(_lengths(raster)) / (_SPAN_IN_LENGTHS * length))


def _lengths(raster: Raster) -> Array:
    return raster.size * np.array(raster.shape)


def _size(raster: Raster, spans: float) -> tuple[int, int]:
    """Lattice of about ``spans`` square spans along the longer side, and enough of them where the surface turns."""
    lengths = _lengths(raster)
    edge = lengths.max() / spans
    size = []
    for axis in (0, 1):
        turns = np.ceil(raster.turn[axis] / _LARGEST_TURN)
        count = int(max(round(lengths[axis] / edge), turns, 1))
        controls = count if raster.periodic[axis] else count + DEGREE
        size.append(int(np.clip(controls, _LEAST_CONTROLS, _LARGEST_CONTROLS)))
    return size[0], size[1]


@dataclass(frozen=True)
class _Sample:
    """Layers with weight, fold by fold: parameters u and v, heights, their weights; where the folds start and end."""

    u: Array
    v: Array
    height: Array
    weight: Array
    edges: Index


def _folds(raster: Raster, layers: Layers, weights: Array) -> _Sample:
    """Squares of the face, dealt out to the folds so that no two neighbours are in the same."""
    edge = np.maximum(_HELD_OUT_BLOCKS * layers.block, _HELD_OUT_SHARE * max(_lengths(raster)) / raster.size)
    fold = ((layers.x // edge[0]).astype(int) + 2 * (layers.y // edge[1]).astype(int)) % _FOLD_COUNT
    rows = np.argsort(np.where(weights > 0, fold, _FOLD_COUNT), kind="stable")[: np.count_nonzero(weights > 0)]
    u, v = raster.corner[:, None] + raster.step[:, None] * np.stack([layers.x[rows], layers.y[rows]])
    return _Sample(u, v, layers.height[rows], weights[rows], np.searchsorted(fold[rows], np.arange(_FOLD_COUNT + 1)))


def _held_out(lattice: ControlLattice, raster: Raster, sample: _Sample, stiffness: float) -> float:
    """Mean squared residual of the folds in units of their variance, each predicted by a field fitted to the others."""
    root = np.sqrt(sample.weight)
    rows = ((lattice.basis_u(sample.u) * root[:, None])[:, :, None] * lattice.basis_v(sample.v)[:, None])
    rows, heights = rows.reshape(len(root), lattice.unknown.size), root * sample.height
    parts = [(part, y, part.T @ part, part.T @ y) for part, y in
             ((rows[a:b], heights[a:b]) for a, b in zip(sample.edges[:-1], sample.edges[1:], strict=True))]
    matrix = sum((p[2] for p in parts), start=stiffness * _flat_bending(raster, lattice))
    right = sum(p[3] for p in parts)
    matrix[np.diag_indices_from(matrix)] += 1e-9 * np.trace(matrix) / len(matrix) + 1e-9
    squared = 0.0
    for part, y, gram, moment in parts:
        residual = y - part @ np.linalg.solve(matrix - gram, right - moment)
        squared += float(np.minimum(residual**2, _OUTLIER_VARIANCES).sum())
    return squared / max(len(heights), 1)


def _flat_bending(raster: Raster, lattice: ControlLattice) -> Array:
    """Bending energy of a field of heights on the face laid flat: ∫ h_xx² + 2 h_xy² + h_yy², dense."""
    grams = []
    for length, fold, closed in zip(_lengths(raster), (lattice.fold_u, lattice.fold_v), raster.periodic, strict=True):
        grams.append([gram * length ** (1 - 2 * k) for k, gram in enumerate(_unit_grams(tuple(fold), closed))])
    (u0, u1, u2), (v0, v1, v2) = grams
    return np.kron(u2, v0) + 2 * np.kron(u1, v1) + np.kron(u0, v2)


@lru_cache(maxsize=256)
def _unit_grams(fold: tuple[int, ...], closed: bool) -> tuple[Array, Array, Array]:
    """∫ N_i^(k) N_j^(k) over [0, 1] for k = 0, 1, 2, of a direction with the given repeated control points."""
    knots = periodic_knots(0, 1, len(fold) - DEGREE) if closed else clamped_knots(0, 1, len(fold))
    x = (np.arange(_BENDING_NODES) + 0.5) / _BENDING_NODES
    bases = [sum_repeated(basis_matrix(knots, x, derivative=k), np.array(fold)) for k in range(3)]
    a, b, c = (basis.T @ basis / _BENDING_NODES for basis in bases)
    return a, b, c
