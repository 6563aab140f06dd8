# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a user may choose about the method `robust`."""
from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RobustSettings:
    """Settings of `register_robust`.

    Attributes
    ----------
    reach : largest distance in mm from the nominal at which a point may belong to the face
    margin : points nearer than this (mm) to a trim, or to half the face's half width, carry no weight
    curvature, length : expected bending of the displacement (1/mm) and the length over which it varies (mm); their
        product squared is the variance that weighs the bending energy
    gauge : 1/mm⁴, weight of the tangential displacement, which the scan does not see
    stiff : bending multiplier and gate in mm of the first steps, on all layers of the scan
    soft : the same for the next ones, on the layers that hang together
    final : the same for the last ones, on points instead of layers
    sample : number of scan points that all steps but the last look at
    """

    reach: float = 15.0
    margin: float = 0.7
    curvature: float = 0.002
    length: float = 10.0
    gauge: float = 1e-2
    stiff: tuple[tuple[float, float], ...] = ((1e4, 5.0), (1e4, 2.6), (1e3, 2.0))
    soft: tuple[tuple[float, float], ...] = ((1e2, 1.5), (30, 1.2), (10, 1.0))
    final: tuple[tuple[float, float], ...] = ((3, 0.8), (1, 0.6), (1, 0.6))
    sample: int = 12000

    @property
    def stiffness(self) -> float:
        """Weight of the bending energy in chi-square units."""
        return 1 / (self.curvature * self.length) ** 2
