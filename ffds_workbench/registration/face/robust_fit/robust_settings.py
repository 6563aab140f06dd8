# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a user may choose about the method `robust`."""
from __future__ import annotations

from dataclasses import dataclass

LAYERS, MAIN_PATCHES, PROVEN = "layers", "main patches", "proven"
"""What a stage trusts to be the face: all that the scan shows, the heaviest connected patches, or these with whatever
lies on the surface through them."""


@dataclass(frozen=True)
class RobustStage:
    """One step of the fit.

    Attributes
    ----------
    bending : multiplies the bending weight
    gate : distance in mm at which a point or a layer loses its weight
    trusts : `LAYERS`, `MAIN_PATCHES` or `PROVEN`; from the last one on, points count instead of layers
    every_point : of the scan, instead of a sample
    """

    bending: float
    gate: float
    trusts: str
    every_point: bool = False


SCHEDULE = (RobustStage(1e4, 5.0, LAYERS), RobustStage(1e4, 2.6, LAYERS), RobustStage(1e3, 2.0, LAYERS),
            RobustStage(1e2, 1.5, MAIN_PATCHES), RobustStage(30, 1.2, MAIN_PATCHES), RobustStage(10, 1.0, MAIN_PATCHES),
            RobustStage(3, 0.8, PROVEN), RobustStage(1, 0.6, PROVEN), RobustStage(1, 0.6, PROVEN, every_point=True))
"""From stiff to soft: the bending weight falls from 1e4 to 1, the gate from what a part warps by to four times the
usual noise (calibrated: by hand, on the synthetic sheets of ``./ffds benchmark accuracy``)."""


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
    schedule : the steps
    sample : number of scan points that all steps but the last look at
    """

    reach: float = 15.0                  # mm; unit: parts of some decimetres warp by less
    margin: float = 0.7                  # mm; unit: what noise and edge radii blur beside an edge
    curvature: float = 0.002             # 1/mm; unit: 1 mm over 60 mm
    length: float = 10.0                 # mm; unit: shorter waves are no deformation of sheet metal
    gauge: float = 1e-2                  # 1/mm⁴; theory: far below a point's weight, far above rounding
    schedule: tuple[RobustStage, ...] = SCHEDULE
    sample: int = 12000                  # unit: time

    @property
    def stiffness(self) -> float:
        """Weight of the bending energy in chi-square units."""
        return 1 / (self.curvature * self.length) ** 2
