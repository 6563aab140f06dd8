# SPDX-License-Identifier: LGPL-2.1-or-later
"""The settings of the two solvers of the robust method, from a request."""
from __future__ import annotations

import math
from dataclasses import replace

from ..registration.face import PROVEN, RobustSettings
from ..registration.joint import JointSettings, SensorProfile
from ..registration.request import RegistrationRequest


def robust_settings(request: RegistrationRequest) -> RobustSettings:
    """Settings of a face by itself."""
    plain = RobustSettings()
    last = plain.schedule[-1].gate
    schedule = tuple(replace(stage, gate=_gate(stage.gate, last, request.gate)) if stage.trusts == PROVEN else stage
                     for stage in plain.schedule)
    return replace(plain, length=plain.length / math.sqrt(request.stiffness), schedule=schedule)


def joint_settings(request: RegistrationRequest) -> JointSettings:
    """Settings of the whole part."""
    plain = JointSettings()
    return replace(plain, curvature_length=plain.curvature_length / math.sqrt(request.stiffness), gate=request.gate,
                   isometry=request.isometry, sensor=request.sensor or SensorProfile())


def _gate(gate: float, last: float, wanted: float | None) -> float:
    """Gates before the last one narrow towards it as they do by default."""
    return gate if wanted is None else gate / last * wanted
