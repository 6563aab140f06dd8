# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces of a rebuilt shape for registration, from their control points instead of new samples."""
from __future__ import annotations

import numpy as np
import Part

from ..registration.arrays import Array
from ..registration.face_geometry import FaceGeometry
from ..registration.splines import SplineSurface
from .workpiece import Workpiece


def built_geometry(nominal: Workpiece, index: int, face: Part.Face) -> FaceGeometry:
    """Face ``index`` of a rebuilt shape: its own surface, and the trims, which a rebuild keeps."""
    own = face.Surface
    before = nominal.geometry(index)
    if not isinstance(own, Part.BSplineSurface) or own.isURational() or own.isVRational():
        return before
    return FaceGeometry(before.name, "BSplineSurface", spline_surface(own), before.trims, before.outward)


def spline_surface(surface: Part.BSplineSurface) -> SplineSurface:
    """A non-rational B-spline surface, exactly; its periodic directions unrolled."""
    points = np.array([[tuple(pole) for pole in row] for row in surface.getPoles()])
    knots_u, points = _direction(points, surface.getUKnots(), surface.getUMultiplicities(), surface.UDegree,
                                 surface.isUPeriodic())
    knots_v, turned = _direction(points.swapaxes(0, 1), surface.getVKnots(), surface.getVMultiplicities(),
                                 surface.VDegree, surface.isVPeriodic())
    return SplineSurface(knots_u, knots_v, turned.swapaxes(0, 1), surface.UDegree, surface.VDegree,
                         surface.isUPeriodic(), surface.isVPeriodic())


def _direction(points: Array, knots: list[float], multiplicities: list[int], degree: int, periodic: bool
               ) -> tuple[Array, Array]:
    """Flat knots and control points (n, …) along the first axis.

    OCCT lists one period of a periodic direction; its first pole belongs to flat knots that end with the first knot.
    """
    if not periodic:
        return np.repeat(knots, multiplicities), points
    cycle = np.repeat(knots[:-1], multiplicities[:-1])
    period = knots[-1] - knots[0]
    flat = np.concatenate([cycle + turn * period for turn in range(-degree, degree + 2)])
    start = int(np.flatnonzero(flat == knots[0])[-1]) - degree
    return flat[start : start + len(points) + 2 * degree + 1], np.concatenate([points, points[:degree]])
