# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a face was deformed onto the far side of its sheet: then the scan may show the other skin."""
from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..arrays import Array
from ..face_geometry import FaceGeometry
from ..footpoints import surface_coordinates
from ..uv_raster import dot, make_raster
from .face_result import FaceRegistration

_RASTER_CELLS = 256
"""Cells of a face (unit: time)."""
_OPPOSITE_COSINE = -0.7
"""Cosine of the outward normals from which two faces are the sides of one sheet, or of one slot (unit: 45°)."""
_COVERED_SHARE = 0.5
"""Share of the observed part of the face that has to lie on the other one (unit: most of it)."""
_LEAST_MOVEMENT_IN_NOISE = 3.0
"""Standard deviations of the noise that a face has to have moved by to be suspected (theory: normal noise seldom
reaches farther)."""


def far_side(face: FaceGeometry, registration: FaceRegistration, others: Iterable[FaceGeometry]) -> tuple[str, float]:
    """The face that the scan may show instead of a registered one, and how many times nearer to the scan it is.

    A sheet that moved by its own thickness also lies on its far side, so this is a suspicion, not a verdict.

    Parameters
    ----------
    face : the nominal face
    registration : its displacement
    others : the nominal faces that may have been mistaken for it; those with the same normals are ignored

    Returns
    -------
    Name, and the ratio of both root mean square distances; ("", 0.0) if there is no such face
    """
    raster = make_raster(face, _RASTER_CELLS)
    inside = np.flatnonzero(raster.inside)
    cells = np.stack(np.unravel_index(inside, raster.shape), axis=1) + 0.5
    displacement = registration.displacement(raster.corner + cells * raster.step)
    moved = np.linalg.norm(displacement, axis=1)
    best = ("", 0.0)
    if not len(moved) or _rms(moved) < _LEAST_MOVEMENT_IN_NOISE * registration.noise:
        return best
    points, normal = raster.position[inside] + displacement, raster.normal[inside]
    for other in others:
        there = make_raster(other, _RASTER_CELLS)
        found = surface_coordinates(there, points, float(moved.max()), 0.0)
        found = found.part(np.flatnonzero(dot(there.normal[found.in_cell[0]], normal[found.index]) < _OPPOSITE_COSINE))
        if len(found.x) >= max(1.0, _COVERED_SHARE * registration.coverage * len(points)):
            best = max(best, (other.name, _rms(moved[found.index]) / max(_rms(found.height), 1e-9)), key=lambda b: b[1])
    return best


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
