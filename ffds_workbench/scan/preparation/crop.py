# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which points of a scan are kept: those in a box, or near the model."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...registration.arrays import Array
from . import library
from .settings import PartSurface


def within(points: Array, box: Sequence[float]) -> NDArray[np.bool_]:
    """Which points (n, 3) are inside the box (6,), its lower corner first."""
    return ((points >= box[:3]) & (points <= box[3:])).all(axis=1)


def near(points: Array, surface: PartSurface, distance: float) -> NDArray[np.bool_]:
    """Which points (n, 3) are no farther than ``distance`` from a surface.

    open3d looks for the nearest triangles in single precision: about the middle of the surface, that is exact to a
    millionth of the surface's size.
    """
    open3d = library.open3d("cropping to the model")
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    middle = 0.5 * (low + high)
    result = within(points, [*(low - distance), *(high + distance)])
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(open3d.core.Tensor((surface.vertices - middle).astype(np.float32)),
                        open3d.core.Tensor(surface.triangles.astype(np.uint32)))
    candidates = points[result] - middle
    nearest = scene.compute_closest_points(open3d.core.Tensor(candidates.astype(np.float32)))["points"].numpy()
    result[result] = np.linalg.norm(candidates - nearest, axis=1) <= distance
    return result
