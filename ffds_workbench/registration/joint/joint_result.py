# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the joint solve returns."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..splines import SplineSurface

Flag = Literal["observed", "bridged", "carried"]
"""Seen by the scan; in a gap of it; or moved along by what is seen elsewhere."""


@dataclass(frozen=True)
class JointFace:
    """One face.

    Attributes
    ----------
    name : "Face6"
    displacement : d(u, v) in mm over the face's own (u, v)
    points : scan points that carry weight
    coverage : share of the face's area that the scan observes, 0…1
    noise : standard deviation in mm of the scan about the face
    flag : what most of the face rests on
    band : half width of the 95 % band of the distance from the true surface in mm, root mean square over the face
    uv : (m, 2) places spread over the face
    bands : (m,) half width of the 95 % band at each of them, in mm
    flags : (m,) flag at each of them
    """

    name: str
    displacement: SplineSurface
    points: int
    coverage: float
    noise: float
    flag: Flag
    band: float
    uv: Array
    bands: Array
    flags: NDArray[np.str_]

    @property
    def lattice(self) -> tuple[int, int]:
        """(N_i, N_j), the number of control points in u and in v."""
        count_u, count_v = self.displacement.control_points.shape[:2]
        return count_u, count_v


@dataclass(frozen=True)
class EdgeRegistration:
    """One edge.

    Attributes
    ----------
    name : "Edge12"
    points : (m, 3) on the as-built edge, in mm, at equal steps of its parameter
    bands : (m,) half width of the 95 % band there, across the edge, in mm
    flags : (m,) flag there
    flag : what most of the edge rests on
    band : root mean square of the bands, in mm
    """

    name: str
    points: Array
    bands: Array
    flags: NDArray[np.str_]
    flag: Flag
    band: float


@dataclass(frozen=True)
class SolidMotion:
    """How a solid moved as a whole, ``T_asbuilt_nominal`` (4, 4), and the rms in mm of the deformation that is left."""

    T_asbuilt_nominal: Array
    deformation: float


@dataclass(frozen=True)
class JointRegistration:
    """The registration of the whole part.

    Attributes
    ----------
    displacements : d(u, v) of every face in FreeCAD's order, in mm over the face's own (u, v)
    assess : computes the bands and flags of faces and edges, which the shape does not need
    solids : rigid motion of each solid of the part
    thickness : as-built mean thickness in mm of each solid that is a sheet, else None
    strain : rms strain of the mid surface that was found on observed faces
    isometric : whether the part was held inextensible
    iterations : Gauss-Newton steps
    last_step : largest change of a surface point in mm in the last step
    used : number of scan points that carry weight
    unsure : thickness in mm of a sheet of which the scan may show the other skin, included in the bands; usually 0
    torn : names of small faces that did not settle on their scan points; their neighbours carry them
    free_motions : in which solids move within their own surface, and so stay where they were, one phrase each
    """

    displacements: tuple[SplineSurface, ...]
    assess: Callable[[], tuple[tuple[JointFace, ...], tuple[EdgeRegistration, ...]]]
    solids: tuple[SolidMotion, ...]
    thickness: tuple[float | None, ...]
    strain: float
    isometric: bool
    iterations: int
    last_step: float
    used: int
    unsure: float = 0.0
    free_motions: tuple[str, ...] = ()
    torn: tuple[str, ...] = ()

    @property
    def faces(self) -> tuple[JointFace, ...]:
        """The faces in FreeCAD's order."""
        return self._assessed[0]

    @property
    def edges(self) -> tuple[EdgeRegistration, ...]:
        """The edges in FreeCAD's order."""
        return self._assessed[1]

    @cached_property
    def _assessed(self) -> tuple[tuple[JointFace, ...], tuple[EdgeRegistration, ...]]:
        return self.assess()
