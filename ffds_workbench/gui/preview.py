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
from scipy.ndimage import uniform_filter

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
from ..registration.splines import SplineSurface

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
    """

    lattice: Lattice
    points: Array
    triangles: NDArray[np.intp]
    values: Array
    before: Array
    after: Array
    coverage: float


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
        displaced = self.raster.position + found.displacement.on_grid(self.raster.u, self.raster.v).reshape(-1, 3)
        values = _means(self.raster, cell, after)
        lattice = draw_lattice(self.geometry.surface, found.displacement)
        return Patch(lattice, displaced, self.grid, values, before, after, found.coverage)


def figures(patches: Sequence[Patch]) -> tuple[float, float, float, float, float]:
    """(mean before, p95 before, mean after, p95 after, coverage) of |deviation| over all patches, in mm."""
    before, after = (np.abs(np.concatenate([getattr(patch, state) for patch in patches]))
                     for state in ("before", "after"))
    coverage = float(np.mean([patch.coverage for patch in patches]))
    return (float(before.mean()), float(np.percentile(before, 95)), float(after.mean()),
            float(np.percentile(after, 95)), coverage)


def cell_values(raster: Raster, points: Array, deviations: Array) -> Array:
    """Mean deviation of each cell's points, NaN without any; points (k, 3) in mm that lie on the face."""
    found = surface_coordinates(raster, points, np.inf)
    return _means(raster, found.in_cell[0], deviations[found.index])


def _means(raster: Raster, cell: NDArray[np.intp], values: Array) -> Array:
    """Mean of the values of each cell and the cells around it, NaN where there are none."""
    count, total = (uniform_filter(np.bincount(cell, weights, len(raster.position)).reshape(raster.shape).astype(float),
                                   3, mode="constant").ravel() for weights in (None, values))
    return np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0.01)


def _register(geometry: FaceGeometry, points: Array, settings: Settings, coarse: bool) -> FaceRegistration:
    if settings.method == "robust":
        lattice = None if settings.lattice == "auto" else settings.lattice
        return register_robust(geometry, points, lattice, _COARSE_STEPS if coarse else RobustSettings())
    published = register_ffds if settings.method == "ffds" else register_ffd
    lattice = _PAPER_LATTICE if settings.lattice == "auto" else settings.lattice
    return published(geometry, points, lattice, settings.source_points)


def _after(raster: Raster, places: SurfaceCoordinates, displacement: SplineSurface) -> Array:
    uv = raster.corner + raster.step * np.stack([places.x, places.y], axis=1)
    return places.height - np.einsum("ij,ij->i", displacement(uv), raster.normal[places.in_cell[0]])


def surface_grid(raster: Raster) -> NDArray[np.intp]:
    """Triangles between the centres of neighbouring cells that carry material; closed directions join up."""
    index = np.arange(len(raster.position)).reshape(raster.shape)
    inside = raster.inside.reshape(raster.shape)
    for axis, closed in enumerate(raster.periodic):
        if closed:
            index, inside = (np.concatenate([a, a.take([0], axis=axis)], axis=axis) for a in (index, inside))
    a, b, c, d = (grid.ravel() for grid in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    whole = (inside[:-1, :-1] & inside[1:, :-1] & inside[1:, 1:] & inside[:-1, 1:]).ravel()
    return np.concatenate([np.stack([a, b, c], axis=1)[whole], np.stack([a, c, d], axis=1)[whole]])
