# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lengths of one solve, computed once: everything with a unit of length that is not a property of the shape."""
from __future__ import annotations

from dataclasses import dataclass

from ..robust_weights import NOISE_ENDS_SIGMAS

_STIFF = 30.0
"""The reach over the scatter of the points about the shape while it is still stiff (unit)."""
_BESIDE_EDGE = 0.01
"""The same beside an edge, where no points hold the shape, over the reach (unit)."""
_MODEL = 3e-4
"""Of the reach: what a lattice and linear matching leave of a displacement at best (unit: one in a thousand of it)."""
_CLEAN = 3e-3
"""Of the reach: noise below which a scan counts as clean (unit: ten times what the model leaves at best)."""
_POSE = 1 / 3
"""Of the reach: how far a solid may sit from its place as a whole (unit)."""
_EDGE_AGREEMENT = 3e-3
"""Standard deviation with which faces agree along an edge, over the noise (unit: far below it)."""
_NOT_CONVERGED = 1 / 6
"""Of the reach: a last step from which on nothing is known (unit)."""


@dataclass(frozen=True)
class Lengths:
    """In mm.

    Attributes
    ----------
    size : twice the largest distance of the part from its middle
    spacing : between neighbouring points of the scan
    noise : standard deviation of the scan's points, and their ``resolution``
    reach : how far the scan may lie from the nominal part
    farthest : how far from the part the points may lie that judge a face at the end; the ``reach`` or more
    """

    size: float
    spacing: float
    noise: float
    resolution: float
    reach: float
    farthest: float

    @property
    def start(self) -> float:
        """Standard deviation of a point about the part before it is deformed."""
        return max(self.noise, self.reach / _STIFF)

    @property
    def border(self) -> float:
        """Least standard deviation of the points about the shape beside an edge, where the cells hold none."""
        return max(self.noise, self.reach * _BESIDE_EDGE)

    @property
    def model(self) -> float:
        """Least standard deviation of what the points of a patch share."""
        return self.reach * _MODEL

    @property
    def point(self) -> float:
        """Standard deviation of a point about the part at the end."""
        return max(self.noise, self.reach * _CLEAN)

    @property
    def border_margin(self) -> float:
        """Distance from a border that points of the face keep: the neighbour's have their feet nearer to it."""
        return NOISE_ENDS_SIGMAS * self.border

    @property
    def farthest_noise(self) -> float:
        """How far from the part noise alone carries points."""
        return NOISE_ENDS_SIGMAS * self.noise

    @property
    def pose(self) -> float:
        """Standard deviation of the place of a solid before it is seen."""
        return self.reach * _POSE

    @property
    def edge_agreement(self) -> float:
        """Standard deviation with which faces agree along an edge."""
        return self.point * _EDGE_AGREEMENT

    @property
    def not_converged(self) -> float:
        """Last step from which on the solve has not converged."""
        return self.reach * _NOT_CONVERGED
