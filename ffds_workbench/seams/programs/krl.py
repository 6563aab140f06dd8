# SPDX-License-Identifier: LGPL-2.1-or-later
"""KUKA KRL: a program (.src) and its points (.dat), in mm and A, B, C in degrees."""
from __future__ import annotations

from collections.abc import Sequence

from ...errors import InputError
from ...registration.arrays import Array
from .angles import from_kuka_angles, kuka_angles
from .moves import AIR_VELOCITY, BEFORE, FrameChoice, RobotSettings, SeamMoves, numbers, plain, program_name

NAME_LIMIT = 24
_KEYS = ("X", "Y", "Z", "A", "B", "C")


def krl_texts(stem: str, seams: Sequence[SeamMoves], settings: RobotSettings) -> tuple[str, str]:
    """The texts of ``stem``.src and ``stem``.dat.

    Raises
    ------
    InputError : a tool or base is given by name
    """
    name = program_name(stem, NAME_LIMIT)
    source = ["&ACCESS RVP", f"DEF {name}()",
              "; Welds seams of an as-built model. Poses: mm, A B C = turns about Z, Y', X'' in degrees.",
              "; Torch frame: Z out of the nozzle into the joint, X along the travel. $BASE is the frame of the model.",
              "BAS(#INITMOV,0)", "BAS(#VEL_PTP,20)", "BAS(#ACC_PTP,20)",
              f"$TOOL={_frame('TOOL_DATA', settings.tool, 'TOOL_DATA[1]')}",
              f"$BASE={_frame('BASE_DATA', settings.base, '$NULLFRAME')}", "PTP $AXIS_ACT"]
    data = ["&ACCESS RVP", f"DEFDAT {name}"]
    for number, seam in enumerate(seams, 1):
        points = [f"XS{number}P{i}" for i in range(1, len(seam.poses) + 1)]
        ways = [f"XS{number}W{i}" for i in range(1, len(seam.way) + 1)]
        source += [f"; {plain(seam.title)}", *(f"PTP {way}" for way in ways), f"PTP XS{number}IN",
                   *seam.lines_at(BEFORE, "kuka"),
                   f"$VEL.CP={_metres_per_second(AIR_VELOCITY)}", f"LIN {points[0]}",
                   f"; seam {number} starts", f"$VEL.CP={_metres_per_second(settings.velocity)}",
                   f"$APO.CDIS={seam.blend:.3f}"]
        source += seam.lines_at(0, "kuka")
        speed = settings.velocity
        for to, by in seam.sections:
            if speed != (speed := seam.velocity_to(to, settings)):
                source.append(f"$VEL.CP={_metres_per_second(speed)}")
            source.append((f"LIN {points[to]}" if by is None else f"CIRC {points[by]},{points[to]}")
                          + (" C_DIS" if to < len(points) - 1 else ""))
            source += seam.lines_at(to, "kuka")
        source += [f"; seam {number} ends", f"$VEL.CP={_metres_per_second(AIR_VELOCITY)}", f"LIN XS{number}OUT"]
        names = [*ways, f"XS{number}IN", *points, f"XS{number}OUT"]
        texts = [f"DECL FRAME {point}={text}" for point, text in zip(names, pose_texts(seam.whole_way), strict=True)]
        if (joints := seam.joints_for("kuka")) is not None:
            texts[: len(joints)] = [f"DECL AXIS {name}={_axes(row)}" for name, row in zip(names, joints, strict=False)]
        data += texts
    return "\n".join([*source, "END"]) + "\n", "\n".join([*data, "ENDDAT"]) + "\n"


def pose_texts(poses: Array) -> list[str]:
    """Poses (n, 4, 4) as KRL's frames, "{X 1.0000,Y …,C …}"."""
    angles = kuka_angles(poses[:, :3, :3])
    return [_aggregate([*numbers(pose[:3, 3], 4), *numbers(turn, 5)]) for pose, turn in zip(poses, angles, strict=True)]


def rotation(angles: Array) -> Array:
    """Rotation (3, 3) of A, B, C in degrees."""
    return from_kuka_angles(angles[None])[0]


def _aggregate(values: Sequence[str]) -> str:
    return "{" + ",".join(f"{key} {value}" for key, value in zip(_KEYS, values, strict=True)) + "}"


def _axes(joints: Array) -> str:
    return "{" + ",".join(f"A{i} {angle}" for i, angle in enumerate(numbers(joints, 5), 1)) + "}"


def _metres_per_second(velocity: float) -> str:
    return f"{velocity / 1000.0:.6g}"


def _frame(table: str, choice: FrameChoice, default: str) -> str:
    if choice is None:
        return default
    if isinstance(choice, int):
        return f"{table}[{choice}]"
    if isinstance(choice, str):
        raise InputError("KUKA controllers number tools and bases: give a number or X,Y,Z,A,B,C instead of "
                         f"'{choice}'.")
    return _aggregate([*numbers(choice[:3], 4), *numbers(choice[3:], 5)])
