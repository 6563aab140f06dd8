# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is known of an arm: its axes, limits and outer shape, and where each figure comes from."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...registration.arrays import Array
from ..kinematics import Chain, Family, family


@dataclass(frozen=True)
class Capsule:
    """A part of a link as all points within ``radius`` mm of a line, as it lies with all joints at zero.

    Attributes
    ----------
    link : the joint (0 to 5) that moves it last
    start, end : (3,) in mm in the base frame
    """

    link: int
    start: Array
    end: Array
    radius: float


@dataclass(frozen=True)
class Arm:
    """An arm.

    Attributes
    ----------
    name, maker : the maker is "kuka", "abb", "ur", "fanuc", "yaskawa", "kawasaki", or "" where none is known
    family : its axes, and how they are solved
    limits : (6, 2) in rad
    speeds, accelerations : (6,) in rad/s and rad/s²
    reach : in mm, as its maker counts it
    capsules : its links
    controller_origin : (3,) in mm: where its controller has the origin of the world, in the base frame
    coupled_third_joint : whether the controller counts joint 3 from the horizontal: J3 − J2 here
    sources, unsure : sentences
    """

    name: str
    maker: str
    family: Family
    limits: Array
    speeds: Array
    accelerations: Array
    reach: float
    capsules: tuple[Capsule, ...]
    controller_origin: Array
    coupled_third_joint: bool
    sources: tuple[str, ...]
    unsure: tuple[str, ...]

    @property
    def chain(self) -> Chain:
        """Its axes."""
        return self.family.chain


@dataclass(frozen=True)
class LinkSizes:
    """How thick the links are, as radii in mm, and how far upper arm and forearm lie beside axis 1, along axis 2."""

    upper_arm: float
    elbow: float
    forearm: float
    wrist: float
    upper_arm_shift: float = 0.0
    forearm_shift: float = 0.0


def capsules_of(chain: Chain, sizes: LinkSizes) -> tuple[Capsule, ...]:
    """The links of an arm from its axes."""
    arm = family(chain)
    y, aside = arm.frame[:, 1], chain.directions[1]
    middle = [point - ((point - chain.points[0]) @ y) * y for point in (arm.shoulder, arm.elbow)]
    upper, lower = sizes.upper_arm_shift * aside, sizes.forearm_shift * aside
    found = [Capsule(1, middle[0] + upper, middle[1] + upper, sizes.upper_arm),
             Capsule(2, middle[1] + upper, middle[1] + lower, sizes.elbow)]
    flange = chain.home[:3, 3]
    if arm.spherical:
        w4 = chain.directions[3]
        corner = arm.wrist + ((middle[1] - arm.wrist) @ w4) * w4
        found += [Capsule(2, middle[1], corner, sizes.elbow), Capsule(3, corner, arm.wrist, sizes.forearm)]
    else:
        end = arm.fourth - ((arm.fourth - chain.points[0]) @ y) * y + lower
        found += [Capsule(2, middle[1] + lower, end, sizes.forearm), Capsule(3, end, arm.fourth, sizes.wrist),
                  Capsule(4, arm.fourth, arm.wrist, sizes.wrist)]
    # The flange is flat: the last ball ends with it.
    out = flange - arm.wrist
    last = max(0.0, 1.0 - sizes.wrist / max(float(np.linalg.norm(out)), 1e-9))
    return (*found, Capsule(5, arm.wrist, arm.wrist + last * out, sizes.wrist))
