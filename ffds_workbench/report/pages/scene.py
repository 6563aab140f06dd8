# SPDX-License-Identifier: LGPL-2.1-or-later
"""The as-built part as one coloured mesh: what the report's pictures and its page in the browser draw."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...registration.arrays import Array
from ...registration.face_geometry import FaceGeometry
from ...registration.uv_raster import Raster, make_raster
from ..maps.coloured_faces import corner_values, corners, surface_grid
from ..deviation import FaceDeviation
from ..maps.lone_points import lone_points

_CELLS = 36_000
"""Of the whole mesh: a page stays below five megabytes with the library that turns it."""
_FEWEST_CELLS, _CELLS_PER_FACE = 64, 4096


@dataclass(frozen=True)
class ColouredPart:
    """A mesh and its lines, in mm.

    Attributes
    ----------
    points : (n, 3) corners
    triangles : (m, 3) rows of points
    before, after : (n,) mean deviation of the scan there from the nominal and from the as-built part, its lone points
        left out; NaN without data
    face_of : (m,) row of ``names`` of each triangle
    names : of the faces
    edges : polylines, each (k, 3)
    """

    points: Array
    triangles: NDArray[np.intp]
    before: Array
    after: Array
    face_of: NDArray[np.intp]
    names: tuple[str, ...]
    edges: Sequence[Array]

    @property
    def limit(self) -> float:
        """Half the colour scale: nearly all of the deviations before, rounded up to a readable number of mm."""
        known = np.abs(self.before[np.isfinite(self.before)])
        size = max(float(np.percentile(known, 97)) if len(known) else 1.0, 1e-6)
        step = 10.0 ** np.floor(np.log10(size))
        return float(np.ceil(size / step * 2) / 2 * step)


def _means(raster: Raster, scan: Array, item: FaceDeviation, kept: NDArray[np.bool_]) -> Array:
    """Mean deviation about the corners of a face's cells."""
    return corner_values(raster, scan[item.points[kept]], item.deviations[kept])


def make_scene(built: Sequence[FaceGeometry], states: Sequence[Sequence[FaceDeviation]], scan: Array,
               edges: Sequence[Array]) -> ColouredPart:
    """The mesh of as-built faces.

    Parameters
    ----------
    built : all faces of the as-built part
    states : the deviations before and after, of all faces or of some
    scan : (n, 3) in mm
    edges : polylines of the as-built part, each (k, 3) in mm
    """
    cells = int(np.clip(_CELLS / max(len(built), 1), _FEWEST_CELLS, _CELLS_PER_FACE))
    points, triangles, face_of, count = [], [], [], 0
    values: tuple[list[Array], list[Array]] = ([], [])
    known = [{item.name: item for item in state} for state in states]
    lone = lone_points(scan)
    for number, face in enumerate(built):
        raster = make_raster(face, cells)
        grid = surface_grid(raster)
        points.append(face.surface.on_grid(*corners(raster)).reshape(-1, 3))
        triangles.append(grid + count)
        face_of.append(np.full(len(grid), number))
        count += len(points[-1])
        for found, state in zip(values, known, strict=True):
            item = state.get(face.name)
            found.append(np.full(len(points[-1]), np.nan) if item is None else
                         _means(raster, scan, item, ~lone[item.points]))
    everything = np.concatenate(points)
    used, inverse = np.unique(np.concatenate(triangles), return_inverse=True)
    before, after = (np.concatenate(found)[used] for found in values)
    return ColouredPart(everything[used], inverse.reshape(-1, 3), before, after, np.concatenate(face_of),
                        tuple(face.name for face in built), edges)
