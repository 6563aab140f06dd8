# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the cases of the world benchmark are made."""
from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from ...errors import InputError

DEFORMATIONS = ("none", "bent-0.3", "bent-1.5", "bump")
"""Nothing; bent and twisted by that many percent of the part's length; one round bump."""


@dataclass(frozen=True)
class ScanSettings:
    """One way to scan a part.

    Attributes
    ----------
    views : number of directions it is seen from, up to 8
    points : of the scan
    sigma : standard deviation of the noise along the surface's normal in mm, before the scaling
    scale : factor on every length: part, deformation and noise
    seed : of the random numbers
    normals : whether the scan has its surface's normals
    """

    views: int = 6
    points: int = 60_000
    sigma: float = 0.08
    scale: float = 1.0
    seed: int = 1
    normals: bool = False

    def __post_init__(self) -> None:
        if not (1 <= self.views <= 8 and self.points >= 1 and self.sigma >= 0 and self.scale > 0):
            raise InputError("A part is seen from 1 to 8 views, by a point or more, with noise that is not negative, "
                             "at a scale above zero.")


def check_deformations(names: Iterable[str]) -> None:
    """Refuse a name that is no deformation (InputError)."""
    for name in names:
        if name not in DEFORMATIONS and not re.fullmatch(r"bent-\d+(\.\d+)?", name):
            raise InputError(f"The deformation '{name}' is unknown: use none, bump, or bent- and a percentage of the "
                             f"part's length, like bent-1.5.")
