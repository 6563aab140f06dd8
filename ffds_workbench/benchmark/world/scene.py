# SPDX-License-Identifier: LGPL-2.1-or-later
"""What cameras far away see of a part that was warped, and what hides what."""
from __future__ import annotations

import numpy as np
import Part
from numpy.typing import NDArray

from ...registration.arrays import Array
from ..simulated import warps
from ..simulated.warps import Warp
from .exact_samples import ExactSamples, Triangles

VIEWS = np.array([[0.6, 0.5, 0.7], [-0.7, -0.4, 0.6], [0.5, -0.8, -0.4], [-0.4, 0.7, -0.7], [0.9, -0.2, 0.3],
                  [-0.3, -0.3, -0.9], [-0.9, 0.4, 0.2], [0.1, 1.0, -0.1]])
"""Directions to cameras far away; the first four are the corners of a tetrahedron, askew."""
_GRAZING = 0.2
"""Cosine to the line of sight below which a surface gives no points."""
_PIXELS = 450
"""Pixels of a depth picture along the diagonal of the part's box."""
_DENSITY = 0.7
"""Distance of the points behind a depth picture, in pixels: below 1/√2 none of its pixels on the part stays empty."""
_SLOPE = 1.5
"""Pixels across which a surface covers its own depth: √2 and what the mesh adds."""


class WarpedScene:
    """A warped part in front of its cameras.

    Parameters
    ----------
    triangles, shape : the part before it is warped
    views : number of cameras, up to as many as there are `VIEWS`
    warp : the deformation
    """

    def __init__(self, triangles: Triangles, shape: Part.Shape, views: int, warp: Warp = warps.still) -> None:
        size, in_solid = shape.BoundBox.DiagonalLength, {f.hashCode() for s in shape.Solids for f in s.Faces}
        self.warp = warp
        self._two_sided = np.array([face.hashCode() not in in_solid for face in shape.Faces])
        self._step = 1e-6 * size
        corners = warp(triangles.points.reshape(-1, 3)).reshape(-1, 3, 3)
        dense = _lattice(corners, _DENSITY * size / _PIXELS)
        self._pictures = [_DepthPicture(view / np.linalg.norm(view), dense, size / _PIXELS) for view in VIEWS[:views]]

    def normals(self, samples: ExactSamples) -> Array:
        """Outward unit normals after the warp, (n, 3): a normal goes with the inverse transpose of the gradient."""
        steps = self._step * np.eye(3)
        gradient = np.stack([self.warp(samples.points + step) - self.warp(samples.points - step) for step in steps],
                            axis=2) / (2 * self._step)
        normals = np.linalg.solve(gradient.transpose(0, 2, 1), samples.normals[..., None])[..., 0]
        return normals / np.linalg.norm(normals, axis=1)[:, None]

    def seen(self, samples: ExactSamples) -> NDArray[np.bool_]:
        """Which points at least one camera sees, (n,)."""
        points, normals = self.warp(samples.points), self.normals(samples)
        found = np.zeros(len(points), dtype=bool)
        for picture in self._pictures:
            cosine = normals @ picture.view
            cosine = np.where(self._two_sided[samples.face], np.abs(cosine), cosine)
            found |= (cosine > _GRAZING) & picture.shows(points, cosine)
        return found


def _levels(depth: Array) -> NDArray[np.uint16]:
    """Depths in 65,536 levels, a hundredth of a pixel each, which numpy sorts four times as fast as they are."""
    low, high = depth.min(), depth.max()
    return ((depth - low) * (np.iinfo(np.uint16).max / max(high - low, 1e-300))).astype(np.uint16)


class _DepthPicture:
    """The nearest depth in every pixel, from points so close that none on the part stays empty."""

    def __init__(self, view: Array, points: Array, pixel: float) -> None:
        self.view, self._pixel = view, pixel
        self._across = np.linalg.svd(view[None])[2][1:]
        self._corner = (points @ self._across.T).min(axis=0) - pixel
        cell, depth = self._cell(points), points @ view
        self._columns = int(cell[:, 1].max()) + 2
        cell, order = cell @ [self._columns, 1], np.argsort(_levels(depth), kind="stable")
        self._nearest = np.full(cell.max() + self._columns + 2, -np.inf)
        self._nearest[cell[order]] = depth[order]  # of several points in a pixel numpy keeps the last one

    def shows(self, points: Array, cosine: Array) -> NDArray[np.bool_]:
        """Whether nothing is nearer than the points (n, 3) by more than the depth that their own surface, seen at that
        cosine (n,), covers in a pixel."""
        slope = np.sqrt(1 - np.clip(cosine, _GRAZING, 1) ** 2) / np.clip(cosine, _GRAZING, 1)
        nearest = self._nearest[self._cell(points) @ [self._columns, 1]]
        return points @ self.view > nearest - self._pixel * (1 + _SLOPE * slope)

    def _cell(self, points: Array) -> NDArray[np.intp]:
        return ((points @ self._across.T - self._corner) / self._pixel).clip(0).astype(np.intp)


def _lattice(corners: Array, step: float) -> Array:
    """Points on triangles (m, 3, 3), no farther apart than ``step`` mm; (n, 3)."""
    sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
    pieces = np.maximum(1, np.ceil(sides / step)).astype(int)
    found = []
    for count in np.unique(pieces):
        i, j = np.indices((count + 1, count + 1)).reshape(2, -1)
        weights = np.stack([i, j, count - i - j])[:, i + j <= count] / count
        found.append(np.einsum("ck,mcd->mkd", weights, corners[pieces == count]).reshape(-1, 3))
    return np.concatenate(found)
