# SPDX-License-Identifier: LGPL-2.1-or-later
"""The camera of the virtual sensor: central projection, and a depth picture that says what hides what.

Picture coordinates are mm at the stand-off distance, so that a pixel there measures what it says.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...registration.arrays import Array
from .settings import View

_PIXEL = 0.4
_MOST_PIXELS = 1500
_JUMP = 2.0


@dataclass(frozen=True)
class Camera:
    """A pinhole camera.

    Attributes
    ----------
    position : (3,) in mm
    axes : (3, 3), rows: to the right, upwards, and from the part to the camera
    standoff : distance in mm at which picture coordinates are true to scale
    """

    position: Array
    axes: Array
    standoff: float

    def project(self, points: Array) -> tuple[Array, Array]:
        """Picture coordinates (n, 2) in mm and depth (n,) in mm, along the axis, of points (n, 3)."""
        local = (points - self.position) @ self.axes.T
        depth = -local[:, 2]
        scale = np.divide(self.standoff, depth, out=np.full_like(depth, np.inf), where=depth > 0)
        return local[:, :2] * scale[:, None], depth

    def towards(self, points: Array) -> Array:
        """Unit vectors from the points to the camera, (n, 3)."""
        rays = self.position - points
        return rays / np.linalg.norm(rays, axis=1)[:, None]

    def magnification(self, points: Array, normals: Array) -> Array:
        """Area in the picture per area of the surface at points (n, 3) with unit normals (n, 3); (n,)."""
        rays = self.position - points
        depth = rays @ self.axes[2]
        return self.standoff**2 * np.einsum("ij,ij->i", normals, rays) / np.maximum(depth, 1e-9) ** 3

    def on_plane(self, picture: Array, distance: float) -> Array:
        """Points (n, 3) seen at the picture coordinates (n, 2) on the plane square to the axis at that depth."""
        local = np.column_stack([picture * (distance / self.standoff), np.full(len(picture), -distance)])
        return self.position + local @ self.axes


def place(view: View, middle: Array, standoff: float) -> Camera:
    """The camera of a view: upright, its longer side level where the view allows."""
    back = np.asarray(view.direction, dtype=float)
    back = back / np.linalg.norm(back)
    helper = np.array([0.0, 0.0, 1.0]) if abs(back[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    right = np.cross(helper, back)
    right /= np.linalg.norm(right)
    aim = middle if view.aim is None else np.asarray(view.aim, dtype=float)
    return Camera(aim + standoff * back, np.stack([right, np.cross(back, right), back]), standoff)


@dataclass(frozen=True)
class DepthPicture:
    """Nearest depth per pixel (rows, columns) in mm, inf where nothing is seen; ``corner`` (2,) and ``pixel`` in mm."""

    depth: Array
    corner: Array
    pixel: float

    def at(self, picture: Array) -> Array:
        """Depth at picture coordinates, (n, 2) to (n,); inf outside."""
        cell, inside = self._cell(picture)
        return np.where(inside, self.depth[cell[:, 0], cell[:, 1]], np.inf)

    def beside_jump(self, picture: Array, band: float) -> NDArray[np.bool_]:
        """Whether a jump in depth, or the silhouette, is closer than ``band`` mm in the picture; (n, 2) to (n,)."""
        filled = np.where(np.isfinite(self.depth), self.depth, 1e9)
        jump = ndimage.maximum_filter(filled, 3) - ndimage.minimum_filter(filled, 3) > _JUMP
        distance = ndimage.distance_transform_edt(~jump) * self.pixel if jump.any() else np.full(jump.shape, np.inf)
        cell, inside = self._cell(picture)
        return np.where(inside, distance[cell[:, 0], cell[:, 1]] < band, True)

    def _cell(self, picture: Array) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
        cell = np.floor((picture - self.corner) / self.pixel).astype(np.intp)
        inside = ((cell >= 0) & (cell < self.depth.shape)).all(axis=1)
        return np.clip(cell, 0, np.array(self.depth.shape) - 1), inside


def pixel_size(diagonal: float) -> float:
    """Pixel in mm of the depth picture of a part of that size."""
    return max(_PIXEL, diagonal / _MOST_PIXELS)


def depth_picture(camera: Camera, points: Array, pixel: float, field: tuple[float, float]) -> DepthPicture:
    """Depth picture, inside the field of view, of points that lie closer together than half a pixel."""
    picture, depth = camera.project(points)
    within = (depth > 0) & (np.abs(picture) <= 0.5 * np.array(field) + 2 * pixel).all(axis=1)
    if not within.any():
        return DepthPicture(np.full((1, 1), np.inf), np.zeros(2), pixel)
    picture, depth = picture[within], depth[within]
    corner = picture.min(axis=0) - 2 * pixel
    shape = np.ceil((picture.max(axis=0) + 2 * pixel - corner) / pixel).astype(int) + 1
    cell = np.floor((picture - corner) / pixel).astype(np.intp)
    nearest = np.full(shape, np.inf)
    np.minimum.at(nearest, (cell[:, 0], cell[:, 1]), depth)
    return DepthPicture(nearest, corner, pixel)


def sees(camera: Camera, depths: DepthPicture, points: Array, normals: Array, grazing: float) -> NDArray[np.bool_]:
    """Which of the points (n, 3) with outward normals (n, 3) the camera sees; (n,).

    A point is hidden if it looks away, is seen at a grazing angle, or something in its pixel is nearer by more than
    the depth that its own surface covers inside a pixel.
    """
    cosine = np.einsum("ij,ij->i", normals, camera.towards(points))
    picture, depth = camera.project(points)
    slope = np.sqrt(1 - np.clip(cosine, 0, 1) ** 2) / np.maximum(cosine, 1e-3)
    allowance = 0.3 + 1.5 * depths.pixel * slope * depth / camera.standoff
    return (cosine > np.sin(grazing)) & (depth > 0) & (depth < depths.at(picture) + allowance)
