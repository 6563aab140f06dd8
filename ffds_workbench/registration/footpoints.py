# SPDX-License-Identifier: LGPL-2.1-or-later
"""Foot points: the (u, v) of the surface point below a scan point, and the signed height of the scan point over it."""
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .arrays import Array
from .uv_raster import Raster

Index = NDArray[np.intp]
Located = tuple[Array, Array, Array, NDArray[np.bool_]]
"""Cell coordinates x and y, height in mm, and whether they can be trusted."""
Locator = Callable[[Array], tuple]
"""Maps points (3, n) to the rows that were kept (None for all) and the `Located` of these."""

_CHUNK = 16384
"""Points that are located together (unit: memory of a processor's cache)."""
_MOST_VOXELS = 262144
"""Voxels around a face (unit: memory)."""
_COLUMNS = ("index", "x", "y", "height")
_LONGEST_STEP = 4.0
"""Cells that a Newton step crosses at the most (theory: the cells' quadratic frames say nothing farther out)."""
_LEAST_SPREAD = 0.2
"""Foot points nearer to the centre of curvature than this share of the radius are not unique enough to be used (theory:
there an error of the radius counts fivefold)."""
_UNKNOWN_VOXEL, _FAR_VOXEL, _NEAR_VOXEL = range(3)
_TRUSTED_CELLS = 1.5
"""A foot point this many cells from the frame it was found in is not trusted (theory: the error grows with the third
power)."""


@dataclass(frozen=True)
class SurfaceCoordinates:
    """The scan points near a face in the face's own coordinates.

    Attributes
    ----------
    index : (k,) into the scan
    x, y : (k,) parameters of the foot points, counted in cells of the raster
    height : (k,) in mm, positive out of the material
    shape : cells of the raster
    """

    index: Index
    x: Array
    y: Array
    height: Array
    shape: tuple[int, int]

    @cached_property
    def in_cell(self) -> tuple[Index, Array, Array]:
        """Cell of each foot point, and its place in it about the centre, −½ … ½."""
        i, j = self.x.astype(np.int32), self.y.astype(np.int32)
        np.minimum(i, self.shape[0] - 1, out=i)
        np.minimum(j, self.shape[1] - 1, out=j)
        cell = i.astype(np.intp)
        cell *= self.shape[1]
        cell += j
        return cell, self.x - i - 0.5, self.y - j - 0.5

    def on_face(self, raster: Raster, margin: float) -> SurfaceCoordinates:
        """Those whose foot point lies inside the trims, at least ``margin`` mm from them."""
        return self.part(np.flatnonzero(self.depth(raster) >= margin))

    def depth(self, raster: Raster) -> Array:
        """How far the foot points lie inside the trims, in mm; negative outside."""
        cell, dx, dy = self.in_cell
        slope_x, slope_y = raster.depth_slopes
        depth = raster.depth[cell]
        depth += slope_x[cell] * dx
        depth += slope_y[cell] * dy
        return depth

    def sample(self, most: int) -> SurfaceCoordinates:
        """At most ``most`` of them, drawn at random but always the same."""
        if len(self.x) <= most:
            return self
        return self.part(np.random.default_rng(0).integers(len(self.x), size=most))

    def chunks(self) -> Iterator[SurfaceCoordinates]:
        """All of them, piece by piece, small enough to stay in the processor's cache."""
        for first in range(0, len(self.x), _CHUNK):
            yield self.part(slice(first, first + _CHUNK))

    def part(self, rows: Index | slice) -> SurfaceCoordinates:
        """Those in the given ``rows``, (k,) indices or a slice."""
        return SurfaceCoordinates(self.index[rows], self.x[rows], self.y[rows], self.height[rows], self.shape)


def surface_coordinates(raster: Raster, points: Array, reach: float, margin: float | None = None) -> SurfaceCoordinates:
    """Foot points of all scan points within ``reach`` of the face's parameter range, linear in the scan.

    Parameters
    ----------
    raster : of the face
    points : (n, 3) in mm
    reach : largest |height| in mm
    margin : if given, foot points off the trimmed face or nearer than this (mm) to a trim are left out

    Notes
    -----
    An affine surface has a closed form. On others each point takes the cell nearest to its voxel and makes Newton steps
    in the quadratic frames of the cells, the last one in the cell it ends in: the height is right to third order of the
    cell size.
    """
    x, y, height = np.empty((3, len(points)))      # pages are allocated only as far as points are found
    found = SurfaceCoordinates(np.empty(len(points), dtype=np.intp), x, y, height, raster.shape)
    count = 0
    for some in located(raster, points, reach, make_locator(raster, reach)):
        if margin is not None:
            some = some.on_face(raster, margin)
        part = slice(count, count + len(some.x))
        for name in _COLUMNS:
            getattr(found, name)[part] = getattr(some, name)
        count = part.stop
    return found.part(slice(count))


def joined(parts: Sequence[SurfaceCoordinates], raster: Raster) -> SurfaceCoordinates:
    """All foot points of several ``parts`` on one ``raster``."""
    index = np.concatenate([part.index for part in parts] or [np.zeros(0, dtype=np.intp)])
    x, y, height = (np.concatenate([getattr(part, name) for part in parts] or [np.zeros(0)]) for name in _COLUMNS[1:])
    return SurfaceCoordinates(index, x, y, height, raster.shape)


def make_locator(raster: Raster, reach: float) -> Locator:
    """What finds the foot points on the face of a ``raster``, of points within ``reach`` mm."""
    return _flat_locator(raster) if raster.flat else _curved_locator(raster, reach)


def located(raster: Raster, points: Array, reach: float, locate: Locator) -> Iterator[SurfaceCoordinates]:
    """The scan points, of ``points`` (n, 3) in mm, within reach and over the parameter range of the ``raster``, piece
    by piece; ``locate`` from `make_locator`."""
    for first in range(0, len(points), _CHUNK):
        index, x, y, height, valid = locate(points[first : first + _CHUNK].T)
        valid &= np.abs(height) <= reach
        for a, cells, periodic in zip((x, y), raster.shape, raster.periodic, strict=True):
            if not periodic:
                valid &= (a >= 0) & (a < cells)
        chosen = np.flatnonzero(valid)
        index = chosen if index is None else index[chosen]
        yield SurfaceCoordinates(index + first, raster.wrapped(x[chosen], 0), raster.wrapped(y[chosen], 1),
                                 height[chosen], raster.shape)


def _flat_locator(raster: Raster) -> Locator:
    tangents = np.stack([raster.tangent_u[0], raster.tangent_v[0]])
    to_cells = np.vstack([np.linalg.pinv(tangents).T, raster.normal[0]])
    origin = np.array([[0.5], [0.5], [0.0]]) - to_cells @ raster.position[0][:, None]

    def locate(points: Array) -> tuple[None, Array, Array, Array, NDArray[np.bool_]]:
        x, y, height = to_cells @ points + origin
        return None, x, y, height, np.ones(len(x), dtype=bool)

    return locate


def _curved_locator(raster: Raster, reach: float) -> Locator:
    """Seeds each point by the linear map of its voxel; voxels are looked up once, when first met."""
    tree = cKDTree(raster.position)
    margin = reach + 2 * raster.size.max()
    low = raster.position.min(axis=0) - margin
    extent = raster.position.max(axis=0) + margin - low
    edge = max((np.prod(extent) / _MOST_VOXELS) ** (1 / 3), 2 * raster.size.min())
    count = np.ceil(extent / edge).astype(np.intp)
    farthest = margin + edge
    known = np.full(int(np.prod(count)), _UNKNOWN_VOXEL, dtype=np.int8)
    seeds = np.empty((8, len(known)))

    def locate(points: Array) -> tuple[Index, Array, Array, Array, NDArray[np.bool_]]:
        near = np.ones(points.shape[1], dtype=bool)
        for a, lowest, length in zip(points, low, extent, strict=True):
            near &= (a >= lowest) & (a < lowest + length)
        index = np.flatnonzero(near)
        points = points.take(index, axis=1)
        i, j, k = ((points - low[:, None]) * (1 / edge)).astype(np.intp)
        voxel = (i * count[1] + j) * count[2] + k
        state = known.take(voxel)
        new = np.unique(voxel[state == _UNKNOWN_VOXEL])
        if len(new):
            centre = low + edge * (np.stack(np.unravel_index(new, tuple(count)), axis=1) + 0.5)
            distance, nearest = tree.query(centre)
            known[new] = np.where(distance <= farthest, _NEAR_VOXEL, _FAR_VOXEL)
            seeds[:, new] = _linear(raster, centre.T, nearest)
            state = known.take(voxel)
        close = np.flatnonzero(state == _NEAR_VOXEL)
        if len(close) < len(state):
            index, points, voxel = index[close], points.take(close, axis=1), voxel[close]
        s = seeds.take(voxel, axis=1)
        x, y = (s[k] + s[k + 1] * points[0] + s[k + 2] * points[1] + s[k + 3] * points[2] for k in (0, 4))
        return index, *newton_in_cells(raster, points, _cell(raster, x, y), 1)

    return locate


def _linear(raster: Raster, points: Array, cell: Index) -> Array:
    """Cell coordinates near the given points as linear functions of the position: x: constant, gradient; y; (8, n)."""
    for _ in range(2):
        x, y, height, _ = newton_in_cells(raster, points, cell, 1)
        cell = _cell(raster, x, y)
    c = raster.table.take(cell, axis=1)
    spread1, spread2 = (np.maximum(1 - height * c[k], _LEAST_SPREAD) for k in (12, 13))
    rows = []
    for a, k in ((x, 14), (y, 16)):
        gradient = c[k] / spread1 * c[3:6] + c[k + 1] / spread2 * c[6:9]
        rows += [a - (gradient * points).sum(axis=0), *gradient]
    return np.stack(rows)


def newton_in_cells(raster: Raster, points: Array, cell: Index, steps: int = 2) -> Located:
    """Foot points from the quadratic frames of the cells.

    Parameters
    ----------
    raster : of the face
    points : (3, n) in mm
    cell : (n,) the cell to start from
    steps : of Newton's method

    Returns
    -------
    x, y, height : (n,) cell coordinates and signed height in mm
    valid : (n,) the foot point settled near its last cell, on this side of the centre of curvature

    Notes
    -----
    In the principal frame of a cell, with (x₁, x₂, z) the point and k₁, k₂ the curvatures, the foot point is at
    sᵢ = xᵢ / (1 − z kᵢ) and the height z − ½ Σ kᵢ xᵢ sᵢ, up to third order.
    """
    for left in range(steps - 1, -1, -1):
        c = raster.table.take(cell, axis=1)
        r = points - c[0:3]
        x1, x2, z = (r[0] * c[k] + r[1] * c[k + 1] + r[2] * c[k + 2] for k in (3, 6, 9))
        spread1, spread2 = 1 - z * c[12], 1 - z * c[13]
        unique = np.minimum(spread1, spread2) > _LEAST_SPREAD
        s1, s2 = x1 / np.maximum(spread1, _LEAST_SPREAD), x2 / np.maximum(spread2, _LEAST_SPREAD)
        dx, dy = c[14] * s1 + c[15] * s2, c[16] * s1 + c[17] * s2
        x = c[18] + np.minimum(np.maximum(dx, -_LONGEST_STEP), _LONGEST_STEP)
        y = c[19] + np.minimum(np.maximum(dy, -_LONGEST_STEP), _LONGEST_STEP)
        if left:
            cell = _cell(raster, x, y)
    height = z - 0.5 * (c[12] * x1 * s1 + c[13] * x2 * s2)
    return x, y, height, unique & (np.maximum(np.abs(dx), np.abs(dy)) <= _TRUSTED_CELLS)


def _cell(raster: Raster, x: Array, y: Array) -> Index:
    """The cell of cell coordinates, the nearest one where they lie outside the range."""
    m, n = raster.shape
    i = np.clip(np.floor(raster.wrapped(x, 0)), 0, m - 1).astype(np.intp)
    j = np.clip(np.floor(raster.wrapped(y, 1)), 0, n - 1).astype(np.intp)
    i *= n
    i += j
    return i
