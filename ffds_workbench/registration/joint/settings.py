# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings of the joint solve. Every weight is the inverse of a variance with a physical meaning."""
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from .lengths import Lengths


@dataclass(frozen=True)
class Stage:
    """One stage of the schedule: stiff first, soft later.

    Attributes
    ----------
    bending : multiplies the bending weight
    gate : scan points farther than this from the model are left out, over the reach; in mm of `JointSettings.stages`
    iterations : most Gauss-Newton steps
    enough : the stage ends when no point moves farther in a step, over the gate or, in a soft stage, over the noise;
        in mm of `JointSettings.stages`
    soft : the shape can be trusted: strain is judged, and visible borders pull the edges
    all_points : every scan point with Tukey weights per cell, instead of a sample with medians
    body : the body field counts as well, and the priors keep the trust that they have
    allowance : multiplies the expected cost of the priors other than thickness and sliding
    """

    bending: float
    gate: float
    iterations: int
    enough: float
    soft: bool = False
    all_points: bool = False
    body: bool = False
    allowance: float = 1.0


SCHEDULE = (Stage(1e3, 1.0, 6, 0.2), Stage(1e2, 0.67, 6, 0.2), Stage(10, 0.5, 6, 0.2), Stage(1, 0.4, 6, 0.2),
            Stage(1, 0.4, 8, 0.4, soft=True, allowance=0.05), Stage(1, 0.2, 8, 0.2, soft=True, all_points=True),
            Stage(1, 0.2, 4, 0.2, soft=True, all_points=True, body=True))
"""From stiff to soft: the bending weight falls from 1e3 to 1 and the gate from the reach to a fifth of it. Steps
suffice with which a bracket converges (calibrated: by hand, on the families of ``./ffds benchmark accuracy``)."""
_USUAL_REACH = 0.025
"""Of the size of the part: a scan that is farther away takes more steps in the stiff stages (unit)."""


@dataclass(frozen=True)
class SensorProfile:
    """The noise of a sensor along the surface normal; a property of the sensor, measured once on a flat datum.

    A single scan of a curved part cannot separate correlated noise from shape.

    Attributes
    ----------
    sigma : white noise in mm, or None to take it from the scan
    sigma_c : correlated noise in mm, which neighbouring points share
    correlation_length : in mm: the correlation falls as exp(−r²/2l²)
    name : of the sensor
    """

    sigma: float | None = None
    sigma_c: float = 0.0
    correlation_length: float = 0.0
    name: str = "white noise"

    @property
    def shared(self) -> float:
        """∫ of the correlated noise's covariance over the surface, 2π l² σ_c², in mm⁴."""
        return 2 * np.pi * self.correlation_length**2 * self.sigma_c**2


@dataclass(frozen=True)
class JointSettings:
    """How the joint solve works; no default has a unit of length except the curvature and its length, whose product is
    dimensionless.

    Attributes
    ----------
    spans : of a lattice over the size of a solid, where the scan is dense; a bracket of 100 mm gets 12 mm
    turning : largest turn of the normal over a span in rad, of faces as round as their solid is large
    isometry : "auto" decides from the strain found, "on" keeps sheets inextensible, "off" lets them stretch
    curvature, curvature_length : expected change of curvature κ₀ in 1/mm over l in mm; bending weighs 1/(κ₀ l)²
    strain, strain_walls : expected strain of skins, and the least that walls are expected to have
    strain_length : over which it varies, over the size of the solid; strain weighs 1/(strain · length)² per area
    thickness_change : expected change of the thickness of a sheet, over the thickness
    dihedral_sigma : how well an edge keeps its angle, in rad
    schedule : the stages
    gate : in mm, of the last stages in place of the schedule's; earlier soft ones narrow towards it
    sensor : noise of the sensor
    refine : divide the spans of faces whose residual exceeds the noise
    seed : of the random sample of scan points
    """

    # Where it says "by hand": on the families of ``./ffds benchmark accuracy``.
    spans: float = 11.0                          # calibrated: by hand
    turning: float = float(np.deg2rad(25))       # theory: a cubic follows such an arc to 1e-4 of its radius
    isometry: Literal["auto", "on", "off"] = "auto"
    curvature: float = 0.002                     # 1/mm; unit: 1 mm over 60 mm
    curvature_length: float = 10.0               # mm; unit: shorter waves are no deformation of sheet metal
    strain: float = 0.0015                       # unit: metal yields by 0.2 %
    strain_walls: float = 0.0285                 # calibrated: by hand
    strain_length: float = 0.09                  # sizes of the solid; unit: about a span
    thickness_change: float = 0.0067             # of the thickness; calibrated: by hand
    dihedral_sigma: float = 0.01                 # rad; calibrated: by hand
    schedule: tuple[Stage, ...] = SCHEDULE
    gate: float | None = None
    sensor: SensorProfile = field(default_factory=SensorProfile)
    refine: bool = True
    seed: int = 0                                # unit: any number will do

    def stages(self, lengths: Lengths) -> tuple[Stage, ...]:
        """The schedule with its gates and what is enough in mm; the farther away the scan, the more stiff steps.

        Parameters
        ----------
        lengths : of the solve
        """
        more = max(1.0, lengths.reach / (_USUAL_REACH * lengths.size))
        last = self.schedule[-1].gate
        result = []
        for stage in self.schedule:
            gate = stage.gate * (lengths.reach if self.gate is None or not stage.soft else self.gate / last)
            result.append(replace(stage, gate=max(gate, lengths.farthest_noise),
                                  enough=stage.enough * (lengths.point if stage.soft else gate),
                                  iterations=stage.iterations if stage.soft else int(np.ceil(stage.iterations * more))))
        return tuple(result)
