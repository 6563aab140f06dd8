# SPDX-License-Identifier: LGPL-2.1-or-later
"""A seam with all its figures: its stations, the nominal ones, the offsets, the trust and the verdict."""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..registration.arrays import Array
from .chains import Seam
from .offsets import Offsets, nominal_stations, offsets
from .settings import SeamSettings
from .stations import Stations, stations
from .trust import NO_REPORT, Trust, doubts, observed_share
from .weldment import Weldment


@dataclass(frozen=True)
class SeamLimits:
    """What a seam may differ from the nominal, as absolute values.

    Attributes
    ----------
    lateral, normal, longitudinal : offsets in mm
    gap : between the parts in mm
    opening, rotation : change of the opening angle, and rotation of the torch frame, in degrees
    """

    lateral: float = 1.0
    normal: float = 1.0
    longitudinal: float = 2.0
    gap: float = 0.5
    opening: float = 5.0
    rotation: float = 5.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(f"The limit for {name} must be a number of at least 0, not {value:g}.")


@dataclass(frozen=True)
class MeasuredSeam:
    """One seam.

    Attributes
    ----------
    stations : on the as-built model
    nominal, offsets : the paired nominal stations and the differences; None without a nominal model
    flags : (n,) "observed", "bridged", "carried" or "nominal"
    bands : (n,) 95 % band in mm, NaN where unknown
    reported : whether the flags come from a registration's report
    """

    stations: Stations
    nominal: Stations | None
    offsets: Offsets | None
    flags: Array
    bands: Array
    reported: bool = False

    @property
    def name(self) -> str:
        """The edges it runs along."""
        return self.stations.seam.name

    @property
    def observed(self) -> float | None:
        """Share of its length that the scan observed, 0…1; None without a registration's report."""
        return observed_share(self.flags, self.stations.places.arc_length) if self.reported else None

    @property
    def doubts(self) -> str | None:
        """A sentence if a part of it was not observed."""
        return doubts(self.name, self.flags, self.stations.places.arc_length) if self.reported else None

    def largest(self) -> dict[str, float]:
        """Largest absolute values by the names of the limits, in mm and degrees; only those that are known."""
        found = {}
        if self.offsets is not None:
            found = {"lateral": self.offsets.lateral, "normal": self.offsets.normal,
                     "longitudinal": self.offsets.longitudinal, "opening": np.degrees(self.offsets.opening_change),
                     "rotation": np.degrees(self.offsets.rotation)}
        if not np.isnan(self.stations.gap).all():
            found["gap"] = self.stations.gap
        return {name: float(np.nanmax(np.abs(values))) for name, values in found.items()}

    def exceeded(self, limits: SeamLimits) -> list[str]:
        """Names of the limits that the seam breaks somewhere; empty: it passes."""
        allowed: Mapping[str, float] = vars(limits)
        return [name for name, value in self.largest().items() if value > allowed[name]]


def measure(as_built: Weldment, seam: Seam, settings: SeamSettings, nominal: Weldment | None = None,
            trust: Trust | None = None) -> MeasuredSeam:
    """Sample a seam, compare it with the nominal one, and look up its flags and bands in a registration's report."""
    found = stations(as_built, seam, settings)
    flags, bands = (trust or NO_REPORT).along(found)
    if nominal is None:
        return MeasuredSeam(found, None, None, flags, bands, trust is not None)
    before = nominal_stations(nominal, as_built, found, settings)
    return MeasuredSeam(found, before, offsets(before, found), flags, bands, trust is not None)
