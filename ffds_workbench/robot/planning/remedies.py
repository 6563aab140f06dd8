# SPDX-License-Identifier: LGPL-2.1-or-later
"""What would help where a seam cannot be welded: the nearest of some changes that gets the torch to where it failed."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...registration.arrays import Array
from ...registration.motions import twist_motion
from ..cells import Cell
from ..clearance import Moving
from .course import Course
from .failure import COLLISION, LIMIT, REACH, Failure
from .holds import LEAST_SINGULARITY, holds_of, leans_of

_PLACES = 7
"""Stations that are tried: with the failing one the ends, and some in between (unit: what time is worth)."""
_TURNS = (15.0, -15.0, 30.0, -30.0, 45.0, -45.0, 60.0, -60.0, 90.0, -90.0, 135.0, -135.0, 180.0)
_SHIFTS = (100.0, 200.0, 300.0, 500.0)
_STICK_OUTS = (3.0, 5.0, 8.0)
"""Turns of the part in degrees, shifts of the robot and what the wire sticks out more in mm, in the order in which they
are tried (unit: round numbers that people can set up)."""


def remedy(moving: Moving, cell: Cell, course: Course, failure: Failure) -> str | None:
    """The first change that leaves some hold at the station that failed and along the seam; in words, or None."""
    which = np.unique(np.append(np.linspace(0, len(course.positions) - 1, _PLACES).astype(int), failure.station))
    torch, positions = course.torch[which], course.positions[which]
    for said, changed, new in _changes(moving, cell, failure.reason, positions.mean(axis=0)):
        leans = np.zeros((1, 2))
        if failure.reason == COLLISION and len(wide := leans_of(changed, new, torch, positions)):
            leans = wide
        holds = holds_of(changed, new, torch, positions, leans)
        held = holds.within & (holds.singularity >= LEAST_SINGULARITY) & (holds.torch >= new.clearance)[..., None]
        if held.any(axis=(1, 2)).all(axis=0).any():
            return said
    return None


def _changes(moving: Moving, cell: Cell, reason: str, middle: Array) -> Iterator[tuple[str, Moving, Cell]]:
    if reason == COLLISION:
        for longer in _STICK_OUTS:
            torch = replace(cell.torch, stick_out=cell.torch.stick_out + longer)
            longer_one = replace(moving, tcp=torch.tcp, about_the_wire=torch.about_the_wire,
                                 beside_the_wire=torch.beside_the_wire)
            yield f"a stick-out of {torch.stick_out:g} mm", longer_one, cell
        thinner = replace(cell.torch, nozzle_radius=0.75 * cell.torch.nozzle_radius)
        yield (f"a nozzle of {thinner.nozzle_radius:g} mm radius",
               replace(moving, about_the_wire=thinner.about_the_wire), cell)
    if reason in (REACH, LIMIT):
        towards = (middle - cell.base[:3, 3]) * (1.0, 1.0, 0.0)
        towards /= max(float(np.linalg.norm(towards)), 1e-9)
        for shift in _SHIFTS:
            for way, word in ((1.0, "nearer"), (-1.0, "farther")):
                base = cell.base.copy()
                base[:3, 3] += way * shift * towards
                yield f"the robot {shift:g} mm {word}", replace(moving, base=base), cell
    for degrees in _TURNS:
        # The part turned by an angle is the robot turned back about it; the cell's solids turn with the robot.
        back = twist_motion(np.array([0.0, 0.0, -np.radians(degrees), 0.0, 0.0, 0.0]), middle)
        yield f"the part turned by {degrees:g}° about z", replace(moving, base=back @ cell.base), cell
