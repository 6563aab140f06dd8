# SPDX-License-Identifier: LGPL-2.1-or-later
"""The torch on the flange: a body along the flange's axis, a neck bent towards its x, a nozzle, and the wire."""
from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np
from scipy.spatial.transform import Rotation

from ...errors import InputError
from ...registration.arrays import Array
from ...registration.motions import motion
from ..clearance import Balls, along, cylinder, joined_balls


@dataclass(frozen=True)
class Torch:
    """Lengths and radii in mm, the neck's angle in degrees. The defaults are of no maker's torch, but of an
    ordinary one with a slim nozzle (unit: an assumption; who welds gives the own torch's).

    Attributes
    ----------
    body_length, body_radius : from the flange to where the neck bends
    neck_length, neck_radius, neck_angle : from there to the nozzle, straight, bent off the flange's axis by the angle
    nozzle_length, nozzle_radius : a cylinder
    stick_out : of the wire, from the nozzle's end to the tip, which is the tool's point
    """

    body_length: float = 220.0
    body_radius: float = 28.0
    neck_length: float = 80.0
    neck_radius: float = 12.0
    neck_angle: float = 36.0
    nozzle_length: float = 60.0
    nozzle_radius: float = 8.0
    stick_out: float = 20.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not math.isfinite(value) or not (value > 0.0 or field.name == "neck_angle"):
                raise InputError(f"The torch's {field.name} must be a number above 0, not {value:g}.")
        if not abs(self.neck_angle) <= 120.0:
            raise InputError(f"The torch's neck_angle must lie within ±120°, not {self.neck_angle:g}.")

    @property
    def tcp(self) -> Array:
        """Pose (4, 4) of the wire's tip on the flange: z along the wire, out of the nozzle; y is the flange's."""
        turn = Rotation.from_euler("y", self.neck_angle, degrees=True).as_matrix()
        return motion(turn, (0.0, 0.0, self.body_length) + self._straight * turn[:, 2])

    @property
    def _straight(self) -> float:
        return self.neck_length + self.nozzle_length + self.stick_out

    @property
    def about_the_wire(self) -> Balls:
        """Neck and nozzle, in the frame of the tip: they look the same however the torch is turned about its wire."""
        end, middle, bend = (np.array([0.0, 0.0, -away]) for away in (
            self.stick_out, self.stick_out + self.nozzle_length, self._straight))
        return joined_balls([cylinder(middle, end, self.nozzle_radius), along(bend, middle, self.neck_radius)])

    @property
    def beside_the_wire(self) -> Balls:
        """The body, in the frame of the tip."""
        inverse = np.linalg.inv(self.tcp)
        flange, bend = ((inverse @ (0.0, 0.0, away, 1.0))[:3] for away in (0.0, self.body_length))
        return along(flange, bend, self.body_radius)
