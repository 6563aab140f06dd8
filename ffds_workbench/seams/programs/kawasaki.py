# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kawasaki AS (.as): mm, and O, A, T in degrees; R = Rz(O) · Ry(A) · Rz(T)."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from ...registration.motions import motion
from .angles import from_kuka_angles, kawasaki_angles
from .moves import AIR_VELOCITY, BEFORE, FrameChoice, RobotSettings, SeamMoves, numbers, plain, program_name

NAME_LIMIT = 15


def as_text(stem: str, seams: Sequence[SeamMoves], settings: RobotSettings) -> str:
    """The text of ``stem``.as: the program, its places, and joints where they are the controller's.

    Raises
    ------
    InputError : a tool or base is given by number
    """
    lines = [f".PROGRAM {program_name(stem, NAME_LIMIT).lower()}()",
             "  ; Welds seams of an as-built model. Places: mm, O A T in degrees, in the frame of the model.",
             *_frame("BASE", settings.base), *_frame("TOOL", settings.tool)]
    places, joints = [], []
    for number, seam in enumerate(seams, 1):
        ways = [f"s{number}w{i}" for i in range(1, len(seam.way) + 1)] + [f"s{number}in"]
        points = [f"s{number}p{i}" for i in range(1, len(seam.poses) + 1)]
        names = [*ways, *points, f"s{number}out"]
        places += [f"{name} {text}" for name, text in zip(names, pose_texts(seam.whole_way), strict=True)]
        if (known := seam.joints_for("kawasaki")) is not None:
            joints += [f"#{name} {' '.join(numbers(row, 5))}" for name, row in zip(ways, known, strict=True)]
            ways = [f"#{name}" for name in ways]
        lines += [f"  ; {plain(seam.title)}", "  SPEED 20 ALWAYS", *(f"  JMOVE {way}" for way in ways),
                  *seam.lines_at(BEFORE, "kawasaki", "  {}"), f"  SPEED {AIR_VELOCITY:g} MM/S ALWAYS",
                  f"  LMOVE {points[0]}", f"  ; seam {number} starts",
                  *seam.lines_at(0, "kawasaki", "  {}"), f"  ACCURACY {seam.blend:.3f} ALWAYS"]
        speed = None
        for to, by in seam.sections:
            if speed != (speed := seam.velocity_to(to, settings)):
                lines.append(f"  SPEED {speed:g} MM/S ALWAYS")
            lines += ([f"  LMOVE {points[to]}"] if by is None else
                      [f"  C1MOVE {points[by]}", f"  C2MOVE {points[to]}"])
            lines += seam.lines_at(to, "kawasaki", "  {}")
        lines += ["  BREAK", f"  ; seam {number} ends", f"  SPEED {AIR_VELOCITY:g} MM/S ALWAYS",
                  f"  LMOVE s{number}out"]
    more = [".JOINTS", *joints, ".END"] if joints else []
    return "\n".join([*lines, ".END", ".TRANS", *places, ".END", *more]) + "\n"


def pose_texts(poses: Array) -> list[str]:
    """Poses (n, 4, 4) as "x y z o a t"."""
    angles = kawasaki_angles(poses[:, :3, :3])
    return [" ".join([*numbers(pose[:3, 3], 4), *numbers(turn, 5)]) for pose, turn in zip(poses, angles, strict=True)]


def _frame(word: str, choice: FrameChoice) -> list[str]:
    if choice is None:
        return []
    if isinstance(choice, int):
        raise InputError(f"AS names its frames: give a name or X,Y,Z,A,B,C instead of {choice}.")
    if isinstance(choice, str):
        return [f"  {word} {choice}"]
    pose = motion(from_kuka_angles(np.array([choice[3:]])), np.array([choice[:3]]))
    return [f"  {word} TRANS({pose_texts(pose)[0].replace(' ', ',')})"]
