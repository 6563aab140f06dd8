# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the robot must keep away from: the part's triangles, and boxes and cylinders of the cell; balls against them.

Balls far away are told from a coarse grid of distances, of which a lower bound follows as distance changes no faster
than the place; the others are measured exactly against the nearest triangles.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from ...registration.arrays import Array, Index
from .solids import Solid
from .triangles import Facets, signed_distances, spread

_CELLS = 1_500_000
_FINEST_CELL = 4.0
_SAMPLES = 250_000
_FINEST_SAMPLES = 2.0
_NEAREST_SAMPLES = 8
"""Cells of the grid and their least size in mm; samples of the surface and their least distance in mm; of how many
samples the triangles are tried for the exact distance (unit: what time and memory are worth)."""
_AROUND = 60.0
"""How far in mm the grid reaches beyond the part (unit: what memory is worth)."""
_CHUNK = 100_000
"""Points that are measured at once (unit: what memory is worth)."""


@dataclass(frozen=True)
class Nearness:
    """How near balls come: ``distances`` (n,) in mm between the surfaces, and to what (n,), an index of ``names``."""

    distances: Array
    what: Index


class MeshDistance:
    """Distances from triangles; see the module.

    Parameters
    ----------
    surface : of closed solids
    bands : (faces,) how uncertain each face is in mm: it is taken to stand out by that; NaN where nothing is known
    """

    def __init__(self, surface: Facets, bands: Array) -> None:
        self.surface = surface
        self.bands = np.nan_to_num(bands)[surface.faces]
        area = 0.5 * np.linalg.norm(np.cross(surface.corners[:, 1] - surface.corners[:, 0],
                                             surface.corners[:, 2] - surface.corners[:, 0]), axis=1).sum()
        self._spacing = max(_FINEST_SAMPLES, float(np.sqrt(2.0 * area / _SAMPLES)))
        samples, self._owners = spread(surface, self._spacing)
        self._tree = cKDTree(samples)
        low, high = samples.min(axis=0) - _AROUND, samples.max(axis=0) + _AROUND
        self._cell = max(_FINEST_CELL, float(np.prod(high - low) / _CELLS) ** (1.0 / 3.0))
        self._low, shape = low, np.ceil((high - low) / self._cell).astype(int) + 1
        free = np.ones(shape, dtype=bool)
        free[tuple(self._indices(samples).T)] = False
        # A sample and a place lie within half a diagonal of their cells' middles, and a surface point near a sample.
        self._grid = self._cell * distance_transform_edt(free) - np.sqrt(3.0) * self._cell - self._spacing

    def _indices(self, points: Array) -> Index:
        return np.floor((points - self._low) / self._cell).astype(int)

    def bounds(self, points: Array) -> tuple[Array, Array]:
        """Lower and upper bounds (n,) in mm of the distances of points (n, 3) from the surface; inf beyond the grid."""
        at = self._indices(points)
        last = np.array(self._grid.shape) - 1
        kept = np.clip(at, 0, last)
        outside = (kept != at).any(axis=1)
        beyond = np.linalg.norm(self._cell * np.maximum(np.maximum(-at, at - last) - 1, 0), axis=1)
        coarse = self._grid[tuple(kept.T)]
        slack = 2.0 * np.sqrt(3.0) * self._cell + self._spacing
        return np.maximum(coarse, beyond), np.where(outside, np.inf, coarse + slack)

    def exact(self, points: Array) -> tuple[Array, Index]:
        """Signed distances (n,) of points (n, 3) in mm, less the bands, and the faces (n,) that they are from."""
        distances, faces = np.empty(len(points)), np.empty(len(points), dtype=np.intp)
        for start in range(0, len(points), _CHUNK):
            part = slice(start, start + _CHUNK)
            _, near = self._tree.query(points[part], _NEAREST_SAMPLES)
            which = self._owners[near]
            found = signed_distances(self.surface, which, points[part, None])
            # Where solids touch, a place inside one lies outside the other: inside counts.
            best = (np.abs(found) + np.where(found < 0.0, 0.0, 1e-9)).argmin(axis=1)[:, None]
            triangle = np.take_along_axis(which, best, axis=1)[:, 0]
            distances[part] = np.take_along_axis(found, best, axis=1)[:, 0] - self.bands[triangle]
            faces[part] = self.surface.faces[triangle]
        return distances, faces


class Surroundings:
    """The part and the cell.

    Parameters
    ----------
    mesh : the part and what else is given by triangles, None where there is nothing
    names : what the numbers of the triangles' faces stand for: "Face12", "clamp"
    solids : the cell's boxes and cylinders with their names, in the frame of the model
    """

    def __init__(self, mesh: MeshDistance | None, names: Sequence[str] = (), solids: Sequence[tuple[str, Solid]] = ()
                 ) -> None:
        self._mesh, self._solids = mesh, [solid for _, solid in solids]
        self._names = [*names, *(name for name, _ in solids)]
        self._first_solid = len(names)
        self._widest = 0.0 if mesh is None else float(mesh.bands.max())

    def name(self, what: int) -> str:
        """What an index of `Nearness` stands for."""
        return self._names[what]

    def nearness(self, centres: Array, radii: Array, cap: float) -> Nearness:
        """How near sets of balls come to anything; distances from ``cap`` mm on are given as that, to −1.

        Only balls that may be the nearest of their set are measured exactly.

        Parameters
        ----------
        centres : (n, k, 3) in mm in the frame of the model; ``radii`` : (k,) in mm
        """
        count, many = centres.shape[:2]
        distances, what = np.full(count, float(cap)), np.full(count, -1, dtype=np.intp)
        flat = centres.reshape(-1, 3)
        for number, solid in enumerate(self._solids, self._first_solid):
            _keep_nearer(distances, what, (solid.distances(flat).reshape(count, many) - radii).min(axis=1), number)
        if self._mesh is not None:
            lower, upper = (bound.reshape(count, many) - radii for bound in self._mesh.bounds(flat))
            may = lower - self._widest < np.minimum(upper.min(axis=1), distances)[:, None]
            found = np.full((count, many), np.inf)
            faces = np.full((count, many), -1, dtype=np.intp)
            found[may], faces[may] = self._mesh.exact(centres[may])
            found -= radii
            least = found.argmin(axis=1)[:, None]
            _keep_nearer(distances, what, np.take_along_axis(found, least, axis=1)[:, 0],
                         np.take_along_axis(faces, least, axis=1)[:, 0])
        return Nearness(distances, what)


def _keep_nearer(distances: Array, what: Index, found: Array, names: Index | int) -> None:
    nearer = found < distances
    distances[nearer] = found[nearer]
    what[nearer] = names if isinstance(names, int) else names[nearer]
