# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings of the joint solve. Every weight is the inverse of a variance with a physical meaning."""
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np


@dataclass(frozen=True)
class Stage:
    """One stage of the schedule: stiff first, soft later.

    Attributes
    ----------
    bending : multiplies the bending weight
    gate : scan points farther than this from the model are left out, in mm
    iterations : most Gauss-Newton steps
    enough : the stage is over when no point moves farther in a step, in mm
    soft : the shape can be trusted: strain is judged, and visible borders pull the edges
    all_points : every scan point with Tukey weights per cell, instead of a sample with medians
    body : what the body tells of its faces counts as well, and the priors keep the trust that they have
    allowance : multiplies what the priors, save thickness and sliding, may cost before they are trusted less
    """

    bending: float
    gate: float
    iterations: int
    enough: float
    soft: bool = False
    all_points: bool = False
    body: bool = False
    allowance: float = 1.0


SCHEDULE = (Stage(1e3, 3.0, 6, 0.6), Stage(1e2, 2.0, 6, 0.4), Stage(10, 1.5, 6, 0.3), Stage(1, 1.2, 6, 0.2),
            Stage(1, 1.2, 8, 0.04, soft=True, allowance=0.05), Stage(1, 0.6, 8, 0.02, soft=True, all_points=True),
            Stage(1, 0.6, 4, 0.02, soft=True, all_points=True, body=True))


def stages(schedule: tuple[Stage, ...], reach: float) -> tuple[Stage, ...]:
    """The schedule for a scan up to ``reach`` mm away: wider gates and more steps before the soft stages."""
    scale = max(1.0, reach / schedule[0].gate)
    return tuple(stage if stage.soft else replace(stage, gate=stage.gate * scale,
                                                  iterations=int(np.ceil(stage.iterations * scale)))
                 for stage in schedule)


@dataclass(frozen=True)
class SensorProfile:
    """The noise of a sensor along the surface normal; a property of the sensor, measured once on a flat datum.

    A single scan of a curved part cannot tell noise that neighbouring points share from shape.

    Attributes
    ----------
    sigma : white noise in mm, or None to take it from the scan
    sigma_c : correlated noise in mm: what neighbouring points share
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
    """How the joint solve is to work; the defaults were measured on sheet parts of 50–150 mm.

    Attributes
    ----------
    spans : of a lattice over the size of a solid, where the scan is dense; a bracket of 100 mm gets 12 mm
    turning : largest turn of the normal over a span in rad, of faces as round as their solid is large
    isometry : "auto" decides from the strain found, "on" keeps sheets inextensible, "off" lets them stretch
    curvature, curvature_length : expected change of curvature κ₀ in 1/mm over l in mm; bending weighs 1/(κ₀ l)²
    isometry_weight, isometry_weight_walls : weight of the strain per mm², on walls at most the second
    thickness_sigma : how well a sheet keeps its thickness, in mm
    edge_sigma : how well faces agree along an edge, in mm
    dihedral_sigma : how well an edge keeps its angle, in rad
    pose_sigma : how far a solid may sit from its place, in mm
    schedule : the stages
    sensor : noise of the sensor
    refine : divide the spans of faces whose residual exceeds the noise
    seed : of the random sample of scan points
    """

    spans: float = 11.0
    turning: float = float(np.deg2rad(25))
    isometry: Literal["auto", "on", "off"] = "auto"
    curvature: float = 0.002
    curvature_length: float = 10.0
    isometry_weight: float = 3000.0
    isometry_weight_walls: float = 10.0
    thickness_sigma: float = 0.02
    edge_sigma: float = 3e-4
    dihedral_sigma: float = 0.01
    pose_sigma: float = 1.0
    schedule: tuple[Stage, ...] = SCHEDULE
    sensor: SensorProfile = field(default_factory=SensorProfile)
    refine: bool = True
    seed: int = 0
