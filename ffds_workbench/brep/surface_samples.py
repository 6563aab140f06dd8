# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points spread evenly over a shape, for a quick look at what lies on it."""
from __future__ import annotations

import numpy as np
import Part

from ..registration.arrays import Array

_COUNT = 20_000
_SAG = 0.002
"""Largest distance of the triangles from the shape, as a part of its size: far below what is taken to lie on it."""


def surface_samples(shape: Part.Shape) -> tuple[Array, Array]:
    """Points (n, 3) in mm on the triangles of a shape, as many on each as it is large, and unit normals (n, 3)."""
    vertices, triangles = shape.copy().tessellate(_SAG * shape.BoundBox.DiagonalLength)  # the shape keeps no mesh
    a, b, c = np.array([tuple(vertex) for vertex in vertices])[np.array(triangles)].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    random = np.random.default_rng(0)
    chosen = np.searchsorted(np.cumsum(areas) / areas.sum(), random.random(_COUNT)).clip(max=len(areas) - 1)
    weights = random.random((_COUNT, 2))
    weights = np.where(weights.sum(axis=1, keepdims=True) > 1.0, 1.0 - weights, weights)
    points = a[chosen] + weights[:, :1] * (b - a)[chosen] + weights[:, 1:] * (c - a)[chosen]
    return points, normals[chosen] / np.maximum(areas[chosen, None], 1e-300)
