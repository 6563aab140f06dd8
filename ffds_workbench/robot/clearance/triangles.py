# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of solids: the nearest points of many triangles to as many points, and on which side these lie.

The side of a point whose nearest point lies on an edge or a corner is told by the normals of all faces there, weighted
by their angles (Bærentzen and Aanæs, *Signed distance computation using the angle weighted pseudonormal*, 2005).
FreeCAD measures one pair of shapes at a time; open3d, whose scenes measure many points in single precision, is loaded
by the scans' preparation alone.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...registration.arrays import Array, Index

_AREA = 1e-10
"""Twice the area in mm² below which a triangle counts for nothing (unit: sides of 0.01 µm)."""


@dataclass(frozen=True)
class Facets:
    """Triangles with outward normals.

    Attributes
    ----------
    corners : (n, 3, 3) in mm
    faces : (n,) the index of the face of the model that each belongs to
    normals : (n, 7, 3) of the inside, the three sides (from corner i to i + 1) and the three corners; not unit
    """

    corners: Array
    faces: Index
    normals: Array


def triangles(points: Array, indices: Index, faces: Index) -> Facets:
    """Triangles of one closed solid.

    Parameters
    ----------
    points : (m, 3) in mm; equal ones are taken as one
    indices : (n, 3), counter-clockwise seen from outside
    faces : (n,)
    """
    _, first, same = np.unique(np.round(points, 6), axis=0, return_index=True, return_inverse=True)
    indices = first[same.ravel()][indices]
    normal = np.cross(points[indices[:, 1]] - points[indices[:, 0]], points[indices[:, 2]] - points[indices[:, 0]])
    length = np.linalg.norm(normal, axis=1)
    sound = length > _AREA
    indices, faces, normal = indices[sound], faces[sound], normal[sound] / length[sound, None]
    corners = points[indices]
    at_corners = np.zeros((len(points), 3))
    sides = corners[:, [1, 2, 0]] - corners
    for i in range(3):
        ahead, back = sides[:, i], -sides[:, i - 1]
        angle = np.arctan2(np.linalg.norm(np.cross(ahead, back), axis=1), np.einsum("ij,ij->i", ahead, back))
        np.add.at(at_corners, indices[:, i], angle[:, None] * normal)
    ends = np.sort(np.stack([indices, indices[:, [1, 2, 0]]], axis=2), axis=2).reshape(-1, 2)
    _, side = np.unique(ends[:, 0] * len(points) + ends[:, 1], return_inverse=True)
    at_sides = np.zeros((side.max(initial=-1) + 1, 3))
    np.add.at(at_sides, side, np.repeat(normal, 3, axis=0))
    normals = np.concatenate([normal[:, None], at_sides[side].reshape(-1, 3, 3), at_corners[indices]], axis=1)
    return Facets(corners, faces, normals)


def joined(parts: list[Facets]) -> Facets:
    """Triangles of several solids."""
    return Facets(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("corners", "faces",
                                                                                          "normals")))


def signed_distances(surface: Facets, which: Index, points: Array) -> Array:
    """Distances (…) in mm of points (…, 3) from the triangles ``which`` (…), negative behind them."""
    a, b, c = np.moveaxis(surface.corners[which], -2, 0)
    starts, sides = np.stack([a, b, c], axis=-2), np.stack([b - a, c - b, a - c], axis=-2)
    off = points[..., None, :] - starts
    along = np.clip(np.einsum("...ij,...ij->...i", off, sides) / np.einsum("...ij,...ij->...i", sides, sides), 0.0, 1.0)
    apart = off - along[..., None] * sides
    squares = np.einsum("...ij,...ij->...i", apart, apart)
    side = squares.argmin(axis=-1)
    normal = surface.normals[which, 0]
    inside = (np.einsum("...ij,...ij->...i", np.cross(normal[..., None, :], sides), off) >= 0.0).all(axis=-1)
    at = np.take_along_axis(along, side[..., None], axis=-1)[..., 0]
    feature = np.where(inside, 0, np.where(at <= 0.0, 4 + side, np.where(at >= 1.0, 4 + (side + 1) % 3, 1 + side)))
    height = np.einsum("...i,...i->...", off[..., 0, :], normal)
    out = np.where(inside[..., None], height[..., None] * normal,
                   np.take_along_axis(apart, side[..., None, None], axis=-2)[..., 0, :])
    sign = np.where(np.einsum("...i,...i->...", out, surface.normals[which, feature]) < 0.0, -1.0, 1.0)
    return sign * np.where(inside, np.abs(height), np.sqrt(squares.min(axis=-1)))


def spread(surface: Facets, spacing: float) -> tuple[Array, Index]:
    """Points (n, 3) on all triangles, nowhere farther apart than about ``spacing`` mm, and the triangle of each.

    They lie in rows along the longest side, so that slim triangles get no more than they need.
    """
    lengths = np.linalg.norm(surface.corners[:, [1, 2, 0]] - surface.corners, axis=2)
    longest, rows = lengths.argmax(axis=1), np.arange(len(lengths))
    a, b, c = (surface.corners[rows, (longest + i) % 3] for i in range(3))
    heights = np.linalg.norm(np.cross(b - a, c - a), axis=1) / lengths.max(axis=1)
    steps = np.maximum(1, np.ceil(np.stack([lengths.max(axis=1), heights], axis=1) / spacing)).astype(int)
    points, owners = [], []
    for across, up in np.unique(steps, axis=0):
        which = np.flatnonzero((steps == (across, up)).all(axis=1))
        v = np.repeat(np.arange(up + 1) / up, across + 1)
        u = np.tile(np.arange(across + 1) / across, up + 1) * (1.0 - v)
        start = a[which, None]
        points.append((start + u[:, None] * (b[which, None] - start) + v[:, None] * (c[which, None] - start)
                       ).reshape(-1, 3))
        owners.append(np.repeat(which, len(u)))
    return np.concatenate(points), np.concatenate(owners)
