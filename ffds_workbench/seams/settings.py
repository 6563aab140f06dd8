# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a user may choose about seams, with the defaults."""
from __future__ import annotations

import math
from dataclasses import dataclass

from ..errors import InputError


@dataclass(frozen=True)
class SeamSettings:
    """How seams are found, joined and sampled.

    Attributes
    ----------
    step : largest distance of two stations in mm, along the seam
    chord : largest distance in mm of the seam from the straight line between two stations
    work_angle : the torch leans by this (rad) about the travel direction, right-handed, from the bisector of the faces
    travel_angle : the torch leans by this (rad) along the seam: positive points forwards (push), negative back (drag)
    corner : edges form one seam where their directions differ by less than this (rad)
    min_length : a seam shorter than this (mm) is refused where it was named, and reported where it was found
    start : a point in mm: a closed seam starts at its nearest point, an open one at its nearer end
    reverse : run against the direction of the seam's lowest-numbered edge (or back towards ``start``)
    """

    step: float = 5.0
    chord: float = 0.05
    work_angle: float = 0.0
    travel_angle: float = 0.0
    corner: float = math.radians(15.0)
    min_length: float = 2.0
    start: tuple[float, float, float] | None = None
    reverse: bool = False

    def __post_init__(self) -> None:
        for name in ("step", "chord"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 1e-3):
                raise InputError(f"The {name} of a seam must be at least 0.001 mm, not {value:g}.")
        for name in ("work_angle", "travel_angle"):
            value = getattr(self, name)
            if not abs(value) <= math.radians(80.0):
                raise InputError(f"The {name.replace('_', ' ')} must lie within ±80°, not {math.degrees(value):g}°.")
        if self.start is not None and not all(map(math.isfinite, self.start)):
            raise InputError("The start of a seam must be a point: three numbers in mm.")
