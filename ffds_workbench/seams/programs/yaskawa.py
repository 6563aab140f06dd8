# SPDX-License-Identifier: LGPL-2.1-or-later
"""Yaskawa INFORM jobs (.jbi): mm, and Rx, Ry, Rz in degrees; R = Rz(Rz) · Ry(Ry) · Rx(Rx).

Its form follows jobs that users of the controllers publish: ``///POSTYPE USER``, ``///RECTAN`` and ``///RCONF``.
"""
from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from .angles import kuka_angles
from .moves import (AIR_VELOCITY, BEFORE, FrameChoice, RobotSettings, SeamMoves, numbers, plain, program_name,
                    table_numbers)

NAME_LIMIT = 32
USUAL_CONFIGURATION = "1,0,0,0,0,0"
"""Where the joints are unknown: no flip, elbow above, front, and R, T and S within 180°."""


def jbi_text(stem: str, seams: Sequence[SeamMoves], settings: RobotSettings) -> str:
    """The text of ``stem``.jbi; V is in mm/s, as controllers have it unless a parameter says cm/min.

    Raises
    ------
    InputError : a tool or base is given by name
    """
    frame, tool = table_numbers("Yaskawa", settings)
    lines = ["'Welds seams of an as-built model", *_said(settings.base, f"USER {frame}"),
             *_said(settings.tool, f"TOOL {tool}")]
    places: list[str] = []
    said = ""
    for number, seam in enumerate(seams, 1):
        first = sum(place.startswith("C") for place in places)
        known = seam.joints_for("yaskawa") is not None
        for i, (pose, turn) in enumerate(zip(seam.whole_way, kuka_angles(seam.whole_way[:, :3, :3]), strict=True)):
            configuration = seam.configurations[i] if known and seam.configurations else USUAL_CONFIGURATION
            if configuration != said:
                places.append(f"///RCONF {configuration}{',0' * 18}")
                said = configuration
            places.append(f"C{first + i:05d}={','.join([*numbers(pose[:3, 3], 4), *numbers(turn[::-1], 5)])}")
        lines += _moves(seam, number, first, settings)
    count = sum(place.startswith("C") for place in places)
    head = ["/JOB", f"//NAME {program_name(stem, NAME_LIMIT).upper()}", "//POS", f"///NPOS {count},0,0,0,0,0",
            f"///USER {frame}", f"///TOOL {tool}", "///POSTYPE USER", "///RECTAN", *places, "//INST",
            f"///DATE {datetime.now():%Y/%m/%d %H:%M}", "///ATTR SC,RW,RJ", f"////FRAME USER {frame}", "///GROUP1 RB1"]
    return "\n".join([*head, "NOP", *lines, "END"]) + "\n"


def _moves(seam: SeamMoves, number: int, first: int, settings: RobotSettings) -> list[str]:
    start = first + len(seam.way) + 1
    lines = [f"'{plain(seam.title)[:31]}", *(f"MOVJ C{i:05d} VJ=20.00" for i in range(first, start)),
             *seam.lines_at(BEFORE, "yaskawa"),
             f"MOVL C{start:05d} V={AIR_VELOCITY:.1f} PL=0", f"'seam {number} starts", *seam.lines_at(0, "yaskawa")]
    for to, by in seam.sections:
        end = f"C{start + to:05d} V={seam.velocity_to(to, settings):.1f}"
        end += "" if to < len(seam.poses) - 1 else " PL=0"
        if by is None:
            lines.append(f"MOVL {end}")
        else:
            # A circle has three points of its own. The first is where the robot is already: the straight move of no
            # length to it parts the circle from one before.
            begin = next(s for s, _, e in seam.arcs if e == to)
            lines.append(f"MOVL C{start + begin:05d} V={seam.velocity_to(to, settings):.1f}")
            lines += [f"MOVC C{start + i:05d} V={seam.velocity_to(to, settings):.1f}" for i in (begin, by)]
            lines.append(f"MOVC {end}")
        lines += seam.lines_at(to, "yaskawa")
    return [*lines, f"'seam {number} ends", f"MOVL C{start + len(seam.poses):05d} V={AIR_VELOCITY:.1f} PL=0"]


def _said(choice: FrameChoice, where: str) -> list[str]:
    """A frame that the controller must have, as remarks: jobs set none."""
    if not isinstance(choice, tuple):
        return []
    x, y, z, rz, ry, rx = choice
    return [f"'{where} must be:", f"'{x:.3f},{y:.3f},{z:.3f}", f"'{rx:.3f},{ry:.3f},{rz:.3f}"]
