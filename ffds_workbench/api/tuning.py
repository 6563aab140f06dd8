# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a user may turn where the defaults of the robust method do not suit a scan."""
from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..errors import InputError
from ..registration.face import RobustSettings
from ..registration.joint import JointSettings

STIFFEST = 1e4
"""Stiffness may be up to this, or down to its inverse."""


@dataclass(frozen=True)
class Tuning:
    """Two settings that mean the same for one face and for the whole part.

    Attributes
    ----------
    stiffness : multiplies the bending energy: above 1 smoother, below 1 closer to the scan
    gate : scan points farther than this from the as-built surface carry no weight, in mm, though never nearer than the
        noise asks for; None for the default

    Raises
    ------
    InputError : a value makes no sense
    """

    stiffness: float = 1.0
    gate: float | None = None

    def __post_init__(self) -> None:
        if not 1 / STIFFEST <= self.stiffness <= STIFFEST:
            raise InputError(f"The stiffness {self.stiffness:g} makes no sense: 1 is the default, use {1 / STIFFEST:g} "
                             f"to {STIFFEST:g}.")
        if self.gate is not None and not (math.isfinite(self.gate) and self.gate > 0):
            raise InputError(f"Outliers beyond {self.gate:g} mm make no sense: give a distance above 0.")

    def robust(self) -> RobustSettings:
        """Settings of a face by itself."""
        plain = RobustSettings()
        final = tuple((factor, self._gate(gate, plain.final[-1][1])) for factor, gate in plain.final)
        return replace(plain, length=plain.length / math.sqrt(self.stiffness), final=final)

    def joint(self) -> JointSettings:
        """Settings of the whole part."""
        plain = JointSettings()
        schedule = tuple(replace(stage, gate=self._gate(stage.gate, plain.schedule[-1].gate)) if stage.soft else stage
                         for stage in plain.schedule)
        return replace(plain, curvature_length=plain.curvature_length / math.sqrt(self.stiffness), schedule=schedule)

    def _gate(self, gate: float, last: float) -> float:
        """Those before the last gate narrow towards it as they do by default."""
        return gate if self.gate is None else gate / last * self.gate
