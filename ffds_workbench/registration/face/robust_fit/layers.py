# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a robust fit starts: the layers that the scan forms over the face, and the rigid motion that brings it to one.

A scan holds more than the face: the back of the sheet, a table, neighbours, outliers. Along the normal the points of a
block of cells form layers. Of those near the current surface the outermost is the face: behind it lies the material.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...footpoints import SurfaceCoordinates
from ...robust_weights import TUKEY_SIGMAS, tukey
from ...uv_raster import Raster

Index = NDArray[np.intp]

_POINTS_PER_BLOCK = 16
"""Points of an occupied block (theory: a layer's median is then known to a third of the noise)."""
_SMALLEST_GAP = 0.5
"""Smallest gap in mm that parts two layers (unit: thinner than sheet metal)."""
_GAP_IN_SIGMAS = 5.0
"""The same in standard deviations of the noise (theory: 16 points of normal noise leave no such gap)."""
_DENSE_SHARE = 0.3
"""A layer counts if it has this share of the points of the densest layer of its block (calibrated: by hand, on the
synthetic sheets of ``./ffds benchmark accuracy``)."""
_THIRD_OF_NORMAL = 0.8615
"""Width of the shortest interval that holds a third of a normal distribution, in standard deviations (theory)."""
_CLEAN_QUANTILE = 0.3
"""Quantile of the blocks by which the noise is judged: the others may hold walls, steps and slopes (calibrated: by
hand, on the synthetic sheets of ``./ffds benchmark accuracy``)."""
_MOST_PLANES = 500
"""Blocks that planes are put through (theory: a quantile of them is known to 2 % of the blocks)."""
_THICK_LAYER, _STEEP_LAYER = 3.0, 0.15
"""A layer whose middle half is thicker than 3 × (noise + 0.15 × its block) is no sheet seen from above (theory: the
middle half of normal noise is 1.35 standard deviations thick; unit: a slope of 0.15)."""
_START_OFFSETS = 21
"""Offsets along the normal that the stiff motion is tried from (unit: at a reach of 15 mm, 1.5 mm apart, within the
last gate)."""
_START_GATES = (6.0, 4.0, 3.0, 2.6, 2.6)
"""Gates in mm of the steps from each of them (calibrated: by hand, on the synthetic sheets of ``./ffds benchmark
accuracy``)."""
_SHEET_WINDOW = 4.0
"""Layers this close to a start, in mm, may be the two skins of one sheet, and the outermost is taken (unit: sheets are
thinner)."""
_FARTHER_PENALTY = 0.3
"""How much more, as a share, a start at the end of the reach has to explain than one at the nominal face (calibrated:
by hand, on the synthetic sheets of ``./ffds benchmark accuracy``)."""
_EXPECTED_TILT = 0.1
"""Expected tilt of a face in rad (unit)."""


@dataclass(frozen=True)
class Layers:
    """The dense layers of each block of cells, block by block and outwards.

    Attributes
    ----------
    order, begin, end : layer k consists of the points ``order[begin[k] : end[k]]``
    first : (b,) where the layers of each block start
    x, y : (k,) mean cell coordinates of a layer's points
    height : (k,) their median height in mm
    count : (k,) number of points
    thin : (k,) no thicker than a sheet seen from above; of the others only the densest third was kept
    noise : estimated standard deviation of the points along the normal in mm
    density : points per mm² of face where the scan covers it
    block : cells along the side of a block
    shape : cells of the raster
    """

    order: Index
    begin: Index
    end: Index
    first: Index
    x: Array
    y: Array
    height: Array
    count: Array
    thin: NDArray[np.bool_]
    noise: float
    density: float
    block: int
    shape: tuple[int, int]

    def as_points(self) -> SurfaceCoordinates:
        """The layers as if each were one scan point."""
        return SurfaceCoordinates(np.arange(len(self.x)), self.x, self.y, self.height, self.shape)

    def part(self, kept: NDArray[np.bool_]) -> Layers:
        """The layers that are ``kept``, (k,)."""
        block = np.repeat(np.arange(len(self.first)), np.diff(np.append(self.first, len(kept))))[kept]
        return Layers(self.order, self.begin[kept], self.end[kept], np.flatnonzero(np.diff(block, prepend=-1)),
                      self.x[kept], self.y[kept], self.height[kept], self.count[kept], self.thin[kept], self.noise,
                      self.density, self.block, self.shape)

    def cells(self) -> NDArray[np.bool_]:
        """Whether a cell lies in a block with layers, (m·n,)."""
        rows, columns = (np.arange(k) // self.block for k in self.shape)
        seen = np.zeros((rows[-1] + 1, columns[-1] + 1), dtype=bool)
        seen[self.x.astype(np.intp) // self.block, self.y.astype(np.intp) // self.block] = True
        return seen[np.ix_(rows, columns)].ravel()

    def outermost(self, residual: Array, window: float) -> NDArray[np.bool_]:
        """Whether a layer is the outermost of its block of those within ``window`` mm of a surface.

        Parameters
        ----------
        residual : (…, k) heights of the layers over the surface
        """
        number = np.arange(residual.shape[-1])
        last = np.maximum.reduceat(np.where(np.abs(residual) <= window, number, -1), self.first, axis=-1)
        sizes = np.diff(np.append(self.first, len(number)))
        return np.asarray(np.repeat(last, sizes, axis=-1) == number)


def dense_layers(raster: Raster, points: SurfaceCoordinates) -> Layers:
    """Split the points of each block of cells at gaps along the normal, and keep the dense layers.

    ``points`` on the ``raster`` of the face must not be empty. Blocks are large enough to hold about 16 points where
    the scan covers the face.
    """
    block, edge = _blocks(raster, points)
    order = np.lexsort((points.height, block))
    block, height = block[order], points.height[order]
    first = np.flatnonzero(np.diff(block, prepend=-1))
    count = np.diff(np.append(first, len(block)))
    place = np.stack([points.x[order] * raster.size[0], points.y[order] * raster.size[1], height])
    noise = min(_spread_of_thirds(height, first, count), _spread_about_planes(place, first, count))
    gap = max(_SMALLEST_GAP, _GAP_IN_SIGMAS * noise)
    start = np.flatnonzero((np.diff(block, prepend=-1) != 0) | (np.diff(height, prepend=-np.inf) > gap))
    size = np.diff(np.append(start, len(block)))
    owner = np.searchsorted(first, start, side="right") - 1
    densest = np.maximum.reduceat(size, np.searchsorted(start, first))
    dense = size >= _DENSE_SHARE * densest[owner]
    start, size = start[dense], size[dense]
    inner = height[start + (3 * size) // 4] - height[start + size // 4]
    thin = inner <= _THICK_LAYER * (noise + _STEEP_LAYER * edge * float(raster.size.max()))
    third = np.maximum(size // 3, 1)
    begin = np.where(thin, start, _shortest(height, start, size, third)[0])
    end = begin + np.where(thin, size, third)
    x, y = (_means(a[order], begin, end) for a in (points.x, points.y))
    median = height[(begin + end) // 2]
    first = np.flatnonzero(np.diff(owner[dense], prepend=-1))
    density = float(np.median(count)) / (edge**2 * float(raster.area.mean()))
    count = (end - begin).astype(float)
    return Layers(order, begin, end, first, x, y, median, count, thin, noise, density, edge, raster.shape)


@dataclass(frozen=True)
class SmallMotion:
    """An infinitesimal rigid motion x → x + shift + turn × (x − centre); mm and rad."""

    shift: Array
    turn: Array
    centre: Array

    def displacement(self, points: Array) -> Array:
        """(n, 3) to (n, 3)."""
        return self.shift + np.cross(self.turn, points - self.centre)


def rigid_start(raster: Raster, layers: Layers) -> SmallMotion:
    """The small rigid motion that explains most of the layers on the ``raster`` of a face.

    Motions are fitted from starts spread along the normal, with gates that narrow; the one that explains most blocks
    wins, the one nearer to the nominal where two explain about as many.
    """
    cell = layers.as_points().in_cell[0]
    centre = raster.position.mean(axis=0)
    size = max(float(np.ptp(raster.position, axis=0).max()), 1e-9)
    arm = (raster.position[cell] - centre) / size
    columns = np.concatenate([raster.normal[cell], np.cross(arm, raster.normal[cell])], axis=1)
    reach = max(float(np.abs(layers.height).max()), 1e-6)
    prior = 1e-3 * np.array([1 / reach**2] * 3 + [1 / (_EXPECTED_TILT * size) ** 2] * 3) * len(cell)
    offsets = np.linspace(-reach, reach, _START_OFFSETS)
    residual = layers.height[None] - offsets[:, None]
    products = (columns[:, :, None] * columns[:, None]).reshape(len(cell), -1)
    motion = np.zeros((_START_OFFSETS, 6))
    for gate in _START_GATES:
        weight = _weights(layers, residual, gate)
        normal = (weight @ products).reshape(-1, 6, 6) + np.diag(prior)
        motion = np.linalg.solve(normal, ((weight * layers.height) @ columns)[..., None])[..., 0]
        residual = layers.height[None] - motion @ columns.T
    explained = _weights(layers, residual, _START_GATES[-1]).sum(axis=1)
    offset = np.abs(motion @ columns.mean(axis=0))
    best = motion[np.argmax(explained * (1 - _FARTHER_PENALTY * offset / reach))]
    return SmallMotion(best[:3], best[3:] / size, centre)


def _weights(layers: Layers, residual: Array, gate: float) -> Array:
    gate = max(gate, TUKEY_SIGMAS * layers.noise)
    window = max(min(gate, _SHEET_WINDOW), TUKEY_SIGMAS * layers.noise)
    return tukey(residual, gate) * layers.outermost(residual, window)


def plateau(residual: Array, gate: float) -> Array:
    """Weights (1 − (r / gate)⁴)² within the gate, 0 beyond it: Tukey's, but hardly less than 1 up to half the gate.

    Where the gate is 4.685 standard deviations of normal noise, nothing of the points' precision is lost.
    """
    share = np.minimum(np.square(residual / gate), 1.0)
    return np.square(1 - np.square(share))


def _blocks(raster: Raster, points: SurfaceCoordinates) -> tuple[Index, int]:
    """Block of each point, and k: blocks have k × k cells, so that an occupied one holds about 16 points."""
    i, j = points.x.astype(np.int32), points.y.astype(np.int32)
    k = 1
    while True:
        columns = raster.shape[1] // k + 1
        block = i // k * columns + j // k
        occupied = np.count_nonzero(np.bincount(block))
        if len(block) >= _POINTS_PER_BLOCK * occupied or k >= max(raster.shape) // 4:
            return block, k
        k += max(1, k // 2)


def _spread_of_thirds(height: Array, first: Index, count: Index) -> float:
    """Standard deviation from the shortest interval that holds a third of a block's points, in the cleaner blocks."""
    width = _shortest(height, first, count, np.maximum(count // 3, 1))[1][count >= 6]
    return float(np.quantile(width, _CLEAN_QUANTILE)) / _THIRD_OF_NORMAL if len(width) else float(np.std(height))


def _spread_about_planes(place: Array, first: Index, count: Index) -> float:
    """Standard deviation about a block's own plane, whatever way it faces, in the cleaner blocks.

    ``place`` : (3, n) in mm, block by block.
    """
    mean = np.add.reduceat(place, first, axis=1) / count
    place = place - np.repeat(mean, count, axis=1)
    full = np.flatnonzero(count >= 6)[:_MOST_PLANES]
    if not len(full):
        return float(np.std(place[2]))
    moments = np.array([[np.add.reduceat(place[a] * place[b], first)[full] for b in range(3)] for a in range(3)])
    smallest = np.linalg.eigvalsh((moments / (count[full] - 3)).transpose(2, 0, 1))[:, 0]
    return float(np.sqrt(np.quantile(np.maximum(smallest, 0), _CLEAN_QUANTILE)))


def _shortest(height: Array, first: Index, count: Index, steps: Index) -> tuple[Index, Array]:
    """Of the intervals of ``steps`` successive points in each run of sorted heights, where the shortest starts, and its
    length."""
    run = np.repeat(np.arange(len(first)), count)
    row = np.arange(len(run)) + np.repeat(first - np.cumsum(count) + count, count)
    other = np.minimum(row + steps[run], (first + count)[run] - 1)
    width = np.where(row + steps[run] == other, height[other] - height[row], np.inf)
    least = np.minimum.reduceat(width, np.cumsum(count) - count)
    hit = np.flatnonzero(width == least[run])
    start = first.copy()
    start[run[hit]] = row[hit]
    return start, np.where(np.isfinite(least), least, 0.0)


def _means(values: Array, begin: Index, end: Index) -> Array:
    total = np.concatenate([[0.0], np.cumsum(values)])
    return (total[end] - total[begin]) / (end - begin)
