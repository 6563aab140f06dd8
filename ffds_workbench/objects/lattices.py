# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control lattices as they are drawn: the control points of a face's displacement, before and after."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import Part
from numpy.typing import NDArray

from ..brep import workpiece
from ..registration.face import FaceRegistration
from ..registration.splines import SplineSurface, greville

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lattice:
    """One face's control lattice, (N_i, N_j, 3) each, in mm."""

    nominal: Array
    deformed: Array


def draw_lattice(surface: SplineSurface, displacement: SplineSurface) -> Lattice:
    """The lattice of a displacement on a nominal surface: its control points stand at the Greville points of S₀.

    On a plane these are the control points of the surface itself; elsewhere they lie on it instead of beside it.
    """
    u0, u1, v0, v1 = surface.range
    u = np.clip(greville(displacement.knots_u), u0, u1)
    v = np.clip(greville(displacement.knots_v), v0, v1)
    nominal = surface.on_grid(u, v)
    return Lattice(nominal, nominal + displacement.control_points)


def draw_lattices(shape: Part.Shape, registrations: Sequence[FaceRegistration]) -> list[Lattice]:
    """The lattices of the registered faces of a shape."""
    part = workpiece.read(shape)
    return [draw_lattice(part.geometry(part.index(item.name)).surface, item.displacement) for item in registrations]
