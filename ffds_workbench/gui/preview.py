# SPDX-License-Identifier: LGPL-2.1-or-later
"""The numbers behind the live preview: faces registered each by itself, fast, without a rebuild. Free of Qt and Coin.

The deviation after is read to first order along the normal of the nominal face; the as-built part's own is exact.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import Part
from numpy.typing import NDArray

from ..brep import workpiece
from ..errors import RefusedError
from ..objects.job import Settings
from ..objects.lattices import Lattice, draw_lattice
from ..registration.face import FaceGeometry
from ..registration.ffd import register_ffd
from ..registration.ffds import register_ffds
from ..registration.footpoints import SurfaceCoordinates, surface_coordinates
from ..registration.raster import Raster, make_raster
from ..registration.result import FaceRegistration
from ..registration.robust import RobustSettings, register_robust
from ..registration.splines import DEGREE, SplineSurface

Array = NDArray[np.float64]

COARSE = 6000
"""Scan points per face that are looked at while a control is being moved."""
_COARSE_STEPS = RobustSettings(sample=4000, stiff=((1e4, 5.0), (1e3, 2.0)), soft=((30, 1.2),), final=((1, 0.6),))
_PAPER_LATTICE = (10, 10)
_FAR, _FAR_MEDIANS = 1.0, 8.0
"""Points farther from the deformed face than this (mm), and than so many times the median, are not its own."""


@dataclass(frozen=True)
class Patch:
    """One previewed face.

    Attributes
    ----------
    lattice : its control lattice before and after
    points, triangles : the deformed face, (n, 3) in mm and (m, 3)
    values : (n,) mean deviation of the scan there in mm, NaN without data
    before, after : (k,) deviations of its scan points in mm
    coverage : share of the face that the scan observes
    size : (N_i, N_j), control points in u and v; repeated ones of a closed direction do not count
    """

    lattice: Lattice
    points: Array
    triangles: NDArray[np.intp]
    values: Array
    before: Array
    after: Array
    coverage: float
    size: tuple[int, int]


class Preview:
    """The faces of one part and one scan, made ready to be registered again and again.

    Parameters
    ----------
    shape : the nominal part in its own frame
    points : the scan in the same frame, (n, 3) in mm
    """

    def __init__(self, shape: Part.Shape, points: Array) -> None:
        self._part = workpiece.read(shape)
        self._points = points
        self._faces: dict[str, _Face] = {}

    def patches(self, settings: Settings, coarse: bool) -> list[Patch]:
        """Register the faces that the settings name: on all points, or coarsely and fast. Any thread may call it.

        Raises
        ------
        InputError, RefusedError : as the registration of the face does
        """
        return [self._face(name).patch(settings, coarse) for name in settings.faces or ()]

    def _face(self, name: str) -> _Face:
        if name not in self._faces:
            self._faces[name] = _Face(self._part.geometry(self._part.index(name)), self._points)
        return self._faces[name]


class _Face:
    def __init__(self, geometry: FaceGeometry, points: Array) -> None:
        self.geometry = geometry
        self.raster: Raster = make_raster(geometry)
        found = surface_coordinates(self.raster, points, RobustSettings().reach, 0.0)
        if not len(found.index):
            raise RefusedError(f"The scan does not lie on {geometry.name}: check its unit and its alignment, or choose "
                               f"another face.")
        self.points = points[found.index]
        self.places = found
        self.grid = surface_grid(self.raster)

    def patch(self, settings: Settings, coarse: bool) -> Patch:
        """See `Preview.patches`."""
        skip = max(1, -(-len(self.points) // COARSE)) if coarse else 1
        points = self.points[::skip]
        places = self.places.part(slice(None, None, skip))
        found = _register(self.geometry, points, settings, coarse)
        before, after = places.height, _after(self.raster, places, found.displacement)
        own = np.abs(after) < max(_FAR, _FAR_MEDIANS * float(np.median(np.abs(after))))
        before, after, cell = before[own], after[own], places.in_cell[0][own]
        u, v = corners(self.raster)
        displaced = (self.geometry.surface.on_grid(u, v) + found.displacement.on_grid(u, v)).reshape(-1, 3)
        values = _at_corners(self.raster, cell, after)
        lattice = draw_lattice(self.geometry.surface, found.displacement)
        return Patch(lattice, displaced, self.grid, values, before, after, found.coverage,
                     _size(found.displacement))


def figures(patches: Sequence[Patch]) -> tuple[float, float, float, float, float]:
    """(mean before, p95 before, mean after, p95 after, coverage) of |deviation| over all patches, in mm."""
    before, after = (np.abs(np.concatenate([getattr(patch, state) for patch in patches]))
                     for state in ("before", "after"))
    coverage = float(np.mean([patch.coverage for patch in patches]))
    return (float(before.mean()), float(np.percentile(before, 95)), float(after.mean()),
            float(np.percentile(after, 95)), coverage)


def corner_values(raster: Raster, points: Array, deviations: Array) -> Array:
    """Mean deviation around each corner of the cells, NaN without data; points (k, 3) in mm that lie on the face."""
    if not len(points):
        return np.full((raster.shape[0] + 1) * (raster.shape[1] + 1), np.nan)
    found = surface_coordinates(raster, points, float(np.abs(deviations).max()) + 1.0)
    return _at_corners(raster, found.in_cell[0], deviations[found.index])


def corners(raster: Raster) -> tuple[Array, Array]:
    """Parameters of the cells' corners, (m + 1,) in u and (n + 1,) in v."""
    return (raster.corner[0] + raster.step[0] * np.arange(raster.shape[0] + 1),
            raster.corner[1] + raster.step[1] * np.arange(raster.shape[1] + 1))


def _at_corners(raster: Raster, cell: NDArray[np.intp], values: Array) -> Array:
    """Mean at each corner of the values in the cells around it, NaN where there are none; ((m + 1)·(n + 1),)."""
    sums = []
    for weights in (None, values):
        cells = np.bincount(cell, weights, len(raster.position)).reshape(raster.shape).astype(float)
        around = sum(np.pad(cells, (rows, columns)) for rows in ((0, 1), (1, 0)) for columns in ((0, 1), (1, 0)))
        for axis, closed in enumerate(raster.periodic):
            if closed:
                ends = np.moveaxis(around, axis, 0)
                ends[0] += ends[-1]
                ends[-1] = ends[0]
        sums.append(around.ravel())
    count, total = sums
    return np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)


def _register(geometry: FaceGeometry, points: Array, settings: Settings, coarse: bool) -> FaceRegistration:
    if settings.method == "robust":
        lattice = None if settings.lattice == "auto" else settings.lattice
        return register_robust(geometry, points, lattice, _COARSE_STEPS if coarse else RobustSettings())
    published = register_ffds if settings.method == "ffds" else register_ffd
    lattice = _PAPER_LATTICE if settings.lattice == "auto" else settings.lattice
    return published(geometry, points, lattice, settings.source_points)


def _size(displacement: SplineSurface) -> tuple[int, int]:
    rows, columns = displacement.control_points.shape[:2]
    return rows - DEGREE * displacement.periodic_u, columns - DEGREE * displacement.periodic_v


def _after(raster: Raster, places: SurfaceCoordinates, displacement: SplineSurface) -> Array:
    uv = raster.corner + raster.step * np.stack([places.x, places.y], axis=1)
    return places.height - np.einsum("ij,ij->i", displacement(uv), raster.normal[places.in_cell[0]])


def surface_grid(raster: Raster) -> NDArray[np.intp]:
    """Triangles (k, 3) between the corners of the cells that carry material."""
    m, n = raster.shape
    index = np.arange((m + 1) * (n + 1)).reshape(m + 1, n + 1)
    corner = (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:])
    a, b, c, d = (grid.ravel()[raster.inside] for grid in corner)
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
