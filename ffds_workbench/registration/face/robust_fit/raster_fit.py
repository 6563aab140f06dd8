# SPDX-License-Identifier: LGPL-2.1-or-later
"""One step of a robust fit: residuals of the scan against the current surface, and the lattice that fits them.

The displaced surface S + d is expressed over the nominal one as scan points are: the point of material cell (x, y) has
its nominal foot point at (x + shift) and the height H there. So the scan is compared with it without projecting it
again.
"""
from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...face_geometry import FaceGeometry
from ...footpoints import SurfaceCoordinates, joined, newton_in_cells
from ...robust_weights import MAD_TO_SIGMA, TUKEY_SIGMAS, tukey
from ...splines import SplineSurface, basis_matrix, tensor_product
from ...uv_raster import Raster, dot
from ..control_lattice import ControlLattice
from .bending import bending_and_gauge, curvature_variation
from .face_points import FacePoints
from .layers import Layers, SmallMotion, plateau
from .normal_equations import LEAST_NOISE, grid_products, normal_matrix, offset_products, solve_banded
from .robust_settings import RobustSettings

Index = NDArray[np.intp]

_RIM_BLOCK = 8
"""Cells along the side of the blocks in which points near the trims are judged (theory: some dozens of points)."""
_STRAY_SHARE, _OFF_SURFACE = 0.1, 0.2
"""A block near the trims is used if at most a tenth of its points lie beyond the gate, and the mean of the others
within 0.2 standard deviations of the surface, or three of its own (calibrated: by hand, on the synthetic sheets of
``./ffds benchmark accuracy``; theory: normal noise)."""
_BENDING_SHARE, _EVEN_SHARE, _LONGEST_LENGTH = 0.1, 0.6, 20.0
"""Weights of all bending and of uneven bending, as shares of the weight that bending had before, and the longest length
in mm over which curvature is expected to change (calibrated: by hand, on the synthetic sheets of ``./ffds benchmark
accuracy``)."""
_LARGEST_NOISE_GROWTH = 1.5
"""Noise that a step may find, over the noise that it assumed: gates that follow clutter would never narrow (calibrated:
by hand, on the synthetic sheets of ``./ffds benchmark accuracy``)."""
_STEEPEST = 0.5
"""Change of the shift from cell to cell, in cells, and of the height, in cell sizes, up to which the surface is a graph
over the nominal (theory: well below 1, where it folds)."""


@dataclass(frozen=True)
class FitState:
    """A displacement on the raster, and the data behind it.

    Attributes
    ----------
    d, d_x, d_y : (m·n, 3), displacement and its derivatives per cell, in mm
    control_points : stored control points (nu, nv, components), empty for a rigid motion
    weights : (m·n,) sum of the Tukey weights of the points of each cell
    points : number of points with weight
    noise : robust standard deviation of the points about the surface that this step started from
    """

    d: Array
    d_x: Array
    d_y: Array
    control_points: Array = field(default_factory=lambda: np.zeros((0, 0, 0)))
    weights: Array = field(default_factory=lambda: np.zeros(0))
    points: int = 0
    noise: float = 0.0


@dataclass(frozen=True)
class _Graph:
    """The current surface over the nominal, per material cell: shift of the foot point and height, with gradients in
    nominal cell coordinates; the current normal, and its cosine to the nominal one."""

    shift_x: Array
    shift_y: Array
    height: Array
    slope_x: Array
    slope_y: Array
    normal: Array
    cosine: Array
    usable: NDArray[np.bool_]


@dataclass(frozen=True)
class _CellSums:
    """Data against a surface, per cell (m·n,): sums of weights and of weighted residuals, and the number of points with
    weight; and the absolute residuals of some of them."""

    weight: Array
    moment: Array
    count: Array
    spread: Array


class RasterFit:
    """Fits displacements of one control lattice on one raster; data in ``ignored`` cells, (m·n,), are left out."""

    def __init__(self, face: FaceGeometry, raster: Raster, lattice: ControlLattice, settings: RobustSettings) -> None:
        self.ignored = np.zeros(len(raster.inside), dtype=bool)
        self.surface = face.surface
        self.raster, self.lattice, self.settings = raster, lattice, settings
        self.size = lattice.size
        self.directions = raster.normal[:1] if raster.flat else np.eye(3)
        self.layout = normal_matrix(lattice, len(self.directions))
        self.bending, self.gauge = bending_and_gauge(face.surface, lattice, self.layout)
        self.basis_u = [basis_matrix(lattice.knots_u, raster.u, derivative=k) * raster.step[0] ** k for k in (0, 1)]
        self.basis_v = [basis_matrix(lattice.knots_v, raster.v, derivative=k) * raster.step[1] ** k for k in (0, 1)]
        self.products_u = offset_products(self.basis_u[0], self.basis_u[0])
        self.products_v = offset_products(self.basis_v[0], self.basis_v[0])

    def allow_even_bending(self, state: FitState) -> None:
        """From here on a plane may bend evenly: the change of its curvature is penalised instead of the curvature.

        With little data and much clutter the stiffer energy comes first; once the face is known, this one follows it
        more closely, and extrapolates its bend where nothing is seen. The length over which curvature may change is
        that of the displacement of ``state``, on this lattice.
        """
        if not self.raster.flat:
            return
        variation = curvature_variation(self.surface, self.lattice, self.layout)
        bent = self.layout.energy(self.bending, state.control_points)
        varied = self.layout.energy(variation, state.control_points)
        share = min(_EVEN_SHARE * bent / max(varied, 1e-300), _LONGEST_LENGTH**2)
        self.bending = _BENDING_SHARE * self.bending + share * variation

    def moved(self, motion: SmallMotion) -> FitState:
        """The nominal face after a small rigid motion; along the normal alone where the face is flat."""
        raster = self.raster
        fields = [motion.displacement(raster.position), np.cross(motion.turn, raster.tangent_u),
                  np.cross(motion.turn, raster.tangent_v)]
        if raster.flat:
            fields = [dot(f, raster.normal)[:, None] * raster.normal for f in fields]
        d, d_x, d_y = fields
        return FitState(d, d_x, d_y)

    def step(self, state: FitState, data: FacePoints | SurfaceCoordinates | Layers, noise: float, stiffness: float,
             gate: float) -> FitState:
        """Weight the data about the current surface, and solve for the displacement that fits them.

        Parameters
        ----------
        state : the displacement so far
        data : scan points, or their layers; `FacePoints` near the trims count where they agree with the surface
        noise : standard deviation of a point along the normal, in mm
        stiffness : multiplier of the bending energy
        gate : distance in mm at which a point loses its weight; never below 4.685 standard deviations
        """
        graph = self._graph(state)
        gate = max(gate, TUKEY_SIGMAS * noise)
        seen = self._cells(graph, self._parts(graph, data, noise, gate), gate)
        mean = np.divide(seen.moment, seen.weight, out=np.zeros_like(seen.weight), where=seen.weight > 0)
        certainty = np.where(graph.usable, seen.weight, 0.0) / max(noise, LEAST_NOISE) ** 2
        row = graph.normal @ self.directions.T
        target = dot(graph.normal, state.d) + mean * graph.cosine
        control_points = self._solve(row, target, certainty, stiffness)
        measured = MAD_TO_SIGMA * float(np.median(seen.spread)) if len(seen.spread) else noise
        new_noise = min(measured, _LARGEST_NOISE_GROWTH * noise)
        return self._state(control_points, seen.weight, int(seen.count.sum()), new_noise)

    def look(self, state: FitState, layers: Layers, gate: float) -> tuple[Array, Array]:
        """Heights of k layers over the surface of a ``state``, (k,) in mm, and their weights (k,) within the ``gate``
        in mm."""
        _, residual, weight = self._weighed(self._graph(state), layers, max(gate, TUKEY_SIGMAS * layers.noise))
        return residual, weight

    def field(self, state: FitState) -> SplineSurface:
        """The displacement of a state as a spline in mm."""
        lattice = self.lattice
        return SplineSurface(lattice.knots_u, lattice.knots_v, state.control_points @ self.directions,
                             periodic_u=lattice.periodic_u, periodic_v=lattice.periodic_v)

    def _graph(self, state: FitState) -> _Graph:
        raster = self.raster
        if raster.flat:
            height, slope_x, slope_y = (dot(f, raster.normal) for f in (state.d, state.d_x, state.d_y))
            none, one = np.zeros_like(height), np.ones_like(height)
            return _Graph(none, none, height, slope_x, slope_y, raster.normal, one, one > 0)
        m, n = raster.shape
        cells = np.arange(m * n)
        steps = 1 if np.abs(state.d).max() < raster.size.min() else 2
        x, y, height, valid = newton_in_cells(raster, (raster.position + state.d).T, cells, steps)
        i, j = np.divmod(cells, n)
        shift_x, shift_y = raster.nearest_turn(x - i - 0.5, 0), raster.nearest_turn(y - j - 0.5, 1)
        (xx, xy), (yx, yy), (hx, hy) = (raster.gradient(f) for f in (shift_x, shift_y, height))
        xx, yy = xx + 1, yy + 1
        jacobian = xx * yy - xy * yx
        steep = np.maximum.reduce([np.abs(xx - 1), np.abs(xy), np.abs(yx), np.abs(yy - 1)])
        usable = valid & (steep < _STEEPEST)
        jacobian = np.where(usable, jacobian, 1.0)
        slope_x, slope_y = (yy * hx - yx * hy) / jacobian, (xx * hy - xy * hx) / jacobian
        tangent_x, tangent_y = raster.tangent_u + state.d_x, raster.tangent_v + state.d_y
        normal = np.cross(tangent_x, tangent_y)
        length = np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)
        normal *= (np.sign(dot(normal, raster.normal)) / length)[:, None]
        below = raster.cell(x, y)
        cosine = dot(normal, raster.normal[np.where(below >= 0, below, cells)])
        return _Graph(shift_x, shift_y, height, slope_x, slope_y, normal, cosine, usable & (cosine > _STEEPEST))

    def _agreeing(self, graph: _Graph, rim: SurfaceCoordinates, noise: float, gate: float) -> SurfaceCoordinates:
        """The points in those blocks of the rim in which hardly anything but the face is seen."""
        cell, residual = self._residuals(graph, rim)
        rows, columns = (count // _RIM_BLOCK + 1 for count in self.raster.shape)
        i, j = np.divmod(cell, self.raster.shape[1])
        block = i // _RIM_BLOCK * columns + j // _RIM_BLOCK
        near = np.abs(residual) <= gate
        total, hits = (np.bincount(block, some, rows * columns) for some in (None, near))
        mean = np.bincount(block, np.where(near, residual, 0), rows * columns) / np.maximum(hits, 1)
        off = noise * np.maximum(_OFF_SURFACE, 3 / np.sqrt(np.maximum(hits, 1)))
        used = (hits >= (1 - _STRAY_SHARE) * total) & (np.abs(mean) <= off)
        return rim.part(np.flatnonzero(used[block] & near))

    def _parts(self, graph: _Graph, data: FacePoints | SurfaceCoordinates | Layers, noise: float, gate: float
               ) -> Iterator[tuple[SurfaceCoordinates | Layers, int]]:
        """The data piece by piece, and the stride of those that the noise is measured on."""
        if isinstance(data, FacePoints):
            every, rim = max(1, data.count // self.settings.sample), []
            for inner, near_trims in data.pieces():
                yield inner, every
                rim.append(near_trims)
            yield self._agreeing(graph, joined(rim, self.raster), noise, gate), every
        elif isinstance(data, SurfaceCoordinates):
            for inner in data.chunks():
                yield inner, 1
        else:
            yield data, 1

    def _cells(self, graph: _Graph, parts: Iterable[tuple[SurfaceCoordinates | Layers, int]], gate: float) -> _CellSums:
        """Weigh the data and sum them up cell by cell."""
        cells = len(self.raster.inside)
        sums, spread = np.zeros((3, cells)), []
        for part, every in parts:
            cell, residual, weight = self._weighed(graph, part, gate)
            residual[weight == 0] = 0
            for total, values in zip(sums, (weight, weight * residual, weight > 0), strict=True):
                total += np.bincount(cell, values, cells)
            spread.append(np.abs(residual[::every][weight[::every] > 0]))
        sums[:, self.ignored] = 0
        return _CellSums(sums[0], sums[1], sums[2], np.concatenate(spread) if spread else np.zeros(0))

    def _weighed(self, graph: _Graph, data: SurfaceCoordinates | Layers, gate: float) -> tuple[Index, Array, Array]:
        """Material cell, residual and weight of scan points or layers."""
        if isinstance(data, SurfaceCoordinates):
            cell, residual = self._residuals(graph, data)
            return cell, residual, plateau(residual, gate)
        cell, residual = self._residuals(graph, data.as_points())
        return cell, residual, tukey(residual, gate) * data.count * data.outermost(residual, gate)

    def _residuals(self, graph: _Graph, points: SurfaceCoordinates) -> tuple[Index, Array]:
        """Material cell of each point and its height over the current surface in mm, infinite off the face."""
        raster = self.raster
        cell, dx, dy = points.in_cell
        outside = None
        if not raster.flat:
            material_x, material_y = points.x - graph.shift_x[cell], points.y - graph.shift_y[cell]
            cell = raster.cell(material_x, material_y)
            outside = cell < 0
            cell[outside] = 0
            i, j = np.divmod(cell, raster.shape[1])
            dx = raster.nearest_turn(points.x - i - 0.5 - graph.shift_x[cell], 0)
            dy = raster.nearest_turn(points.y - j - 0.5 - graph.shift_y[cell], 1)
        residual = points.height - graph.height[cell]
        residual -= graph.slope_x[cell] * dx
        residual -= graph.slope_y[cell] * dy
        if outside is not None:
            residual[outside] = np.inf
        return cell, residual

    def _solve(self, row: Array, target: Array, data: Array, stiffness: float) -> Array:
        """Control points that minimise Σ data (row · d − target)² + bending + gauge."""
        shape, k = self.raster.shape, row.shape[1]
        settings = self.settings
        upper, block = np.triu_indices(k), np.zeros((k, k), dtype=np.intp)
        block[upper] = block.T[upper] = np.arange(len(upper[0]))
        grids = (row.T[upper[0]] * row.T[upper[1]] * data).reshape(-1, *shape)
        products = grid_products(grids, self.products_u, self.products_v)[block.ravel()]
        matrix = self.layout.symmetric(products)
        matrix += stiffness * settings.stiffness * self.bending + settings.gauge * self.gauge
        values = (row * (data * target)[:, None]).reshape(*shape, k)
        right = self.layout.right_side(values, self.basis_u[0], self.basis_v[0])
        return self.layout.control_points(solve_banded(matrix, right))

    def _state(self, control_points: Array, weights: Array, points: int, noise: float) -> FitState:
        fields = []
        for a, b in ((0, 0), (1, 0), (0, 1)):
            values = tensor_product(self.basis_u[a], self.basis_v[b], control_points)
            fields.append(values.reshape(-1, values.shape[2]) @ self.directions)
        d, d_x, d_y = fields
        return FitState(d, d_x, d_y, control_points, weights, points, noise)
