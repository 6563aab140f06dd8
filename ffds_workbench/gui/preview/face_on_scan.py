# SPDX-License-Identifier: LGPL-2.1-or-later
"""One face and the scan points near it: their deviations from it before and after a displacement. No Qt, no Coin."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...brep.face_displacement import FaceDisplacement
from ...registration.face import RobustSettings
from ...registration.face_geometry import FaceGeometry
from ...registration.footpoints import SurfaceCoordinates, surface_coordinates
from ...registration.splines import SplineSurface
from ...registration.uv_raster import Raster, make_raster
from ...report.maps.coloured_faces import at_corners, corners, surface_grid

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_LEAST_FAR, _FAR_MEDIANS = 1.0, 8.0
"""Points farther from the deformed face than this (mm), and than so many times the median, are not its own."""
_OUTLINE = 129
"""Points of a drawn trim."""


class Displacement(Protocol):
    """What moves a face: d(u, v) in mm."""

    def __call__(self, uv: Array) -> Array:
        """At parameters (n, 2), (n, 3)."""

    def on_grid(self, u: Array, v: Array) -> Array:
        """At all pairs of u (m,) and v (n,), (m, n, 3)."""


@dataclass(frozen=True)
class RebuiltDisplacement:
    """The displacement of a face as the rebuild takes it, closed along its edges."""

    surface: SplineSurface
    displacement: FaceDisplacement

    def __call__(self, uv: Array) -> Array:
        """At parameters (n, 2), (n, 3)."""
        u0, u1, v0, v1 = self.surface.range
        inside = np.clip(uv, (u0, v0), (u1, v1))
        return self.displacement.evaluate(inside, self.surface(inside))

    def on_grid(self, u: Array, v: Array) -> Array:
        """At all pairs of u (m,) and v (n,), (m, n, 3)."""
        return self(np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)).reshape(len(u), len(v), 3)


@dataclass(frozen=True)
class Deviations:
    """Of scan points from one face, (k,) each: row in the scan, cell of the raster, and mm before and after."""

    index: Index
    cell: Index
    before: Array
    after: Array

    def part(self, which: NDArray[np.bool_]) -> Deviations:
        """Some of them."""
        return Deviations(self.index[which], self.cell[which], self.before[which], self.after[which])

    def near(self) -> Deviations:
        """Those that may be the face's own."""
        return self.part(np.abs(self.after) < farthest_of(self.after))


def farthest_of(deviations: Array) -> float:
    """Distance in mm at which a point is not the part's own, by the deviations (k,) of all."""
    return max(_LEAST_FAR, _FAR_MEDIANS * float(np.median(np.abs(deviations)))) if len(deviations) else _LEAST_FAR


class FaceOnScan:
    """A face, its raster and the scan points (n, 3) near it."""

    def __init__(self, geometry: FaceGeometry, points: Array) -> None:
        self.geometry = geometry
        self.raster: Raster = make_raster(geometry)
        self.places: SurfaceCoordinates = surface_coordinates(self.raster, points, RobustSettings().reach, 0.0)
        self.triangles = surface_grid(self.raster)

    def deviations(self, displacement: Displacement, every: int = 1) -> Deviations:
        """Before and after a displacement d(u, v), of every so many points."""
        places, raster = self.places.part(slice(None, None, every)), self.raster
        uv = raster.corner + raster.step * np.stack([places.x, places.y], axis=1)
        cell = places.in_cell[0]
        moved = displacement(uv) if len(uv) else np.zeros((0, 3))
        after = places.height - np.einsum("ij,ij->i", moved, raster.normal[cell])
        return Deviations(places.index, cell, places.height, after)

    def deformed(self, displacement: Displacement) -> Array:
        """The corners of the raster's cells on the deformed face, (n, 3) in mm."""
        return (self._nominal + displacement.on_grid(*corners(self.raster))).reshape(-1, 3)

    @cached_property
    def _nominal(self) -> Array:
        """The same corners on the nominal face."""
        return self.geometry.surface.on_grid(*corners(self.raster))

    def outline(self, displacement: Displacement) -> list[Array]:
        """The trims on the deformed face, closed polylines, each (k, 3) in mm."""
        if not self._trims:
            return []
        uv, nominal, ends = self._trims
        return np.split(nominal + displacement(uv), ends)

    @cached_property
    def _trims(self) -> tuple[Array, Array, Index] | tuple[()]:
        """The trims in (u, v) and on the nominal face, one after the other and no finer than they need to be for a
        drawing, and where they end."""
        drawn = [uv[np.linspace(0, len(uv) - 1, min(len(uv), _OUTLINE)).astype(int)] for uv in self.geometry.trims]
        if not drawn:
            return ()
        uv = np.concatenate(drawn)
        return uv, self.geometry.surface(uv), np.cumsum([len(trim) for trim in drawn])[:-1]

    def at_corners(self, deviations: Deviations) -> Array:
        """Mean deviation after at each of them, NaN without data, (n,)."""
        return at_corners(self.raster, deviations.cell, deviations.after)


def own_deviations(faces: Sequence[FaceOnScan], displacements: Sequence[Displacement]) -> list[Deviations]:
    """The deviations of each face, every scan point with the face that it is nearest to after the deformation."""
    found = [face.deviations(displacement) for face, displacement in zip(faces, displacements, strict=True)]
    nearest = np.full(1 + max((int(item.index.max()) for item in found if len(item.index)), default=0), np.inf)
    for item in found:
        nearest[item.index] = np.minimum(nearest[item.index], np.abs(item.after))
    owned = [item.part(np.abs(item.after) <= nearest[item.index]) for item in found]
    farthest = farthest_of(np.concatenate([item.after for item in owned]))
    return [item.part(np.abs(item.after) < farthest) for item in owned]
