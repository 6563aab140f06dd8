# SPDX-License-Identifier: LGPL-2.1-or-later
"""FANUC TP as a listing (.ls): mm, and W, P, R in degrees; R = Rz(R) · Ry(P) · Rx(W).

Its form follows files of controllers as ros-industrial/fanuc (``fanuc_driver/tpe``) and welding users publish them.
"""
from __future__ import annotations

from collections.abc import Sequence

from ...registration.arrays import Array
from .angles import kuka_angles
from .moves import (AIR_VELOCITY, BEFORE, FrameChoice, RobotSettings, SeamMoves, numbers, plain, program_name,
                    table_numbers)

NAME_LIMIT = 32
USUAL_CONFIGURATION = "N U T, 0, 0, 0"
"""Where the joints are unknown: wrist not flipped, elbow up, arm towards the front, no turns."""
_HEAD = """/PROG  {name}
/ATTR
OWNER = MNEDITOR;
COMMENT = "FFDS";
PROG_SIZE = 0;
FILE_NAME = ;
VERSION = 0;
LINE_COUNT = {lines};
MEMORY_SIZE = 0;
PROTECT = READ_WRITE;
TCD:  STACK_SIZE = 0,
      TASK_PRIORITY = 50,
      TIME_SLICE = 0,
      BUSY_LAMP_OFF = 0,
      ABORT_REQUEST = 0,
      PAUSE_REQUEST = 0;
DEFAULT_GROUP = 1,*,*,*,*;
CONTROL_CODE = 00000000 00000000;
/APPL
/MN"""


def ls_text(stem: str, seams: Sequence[SeamMoves], settings: RobotSettings) -> str:
    """The text of ``stem``.ls.

    Raises
    ------
    InputError : a tool or base is given by name
    """
    frame, tool = table_numbers("FANUC", settings)
    lines = ["  !Welds seams of an as-built model ;", *_said(settings.base, f"UFRAME {frame}"),
             *_said(settings.tool, f"UTOOL {tool}"), f"  UFRAME_NUM={frame} ;", f"  UTOOL_NUM={tool} ;"]
    places: list[str] = []
    for number, seam in enumerate(seams, 1):
        first = len(places) + 1
        places += _places(seam, first, frame, tool)
        start = first + len(seam.way) + 1
        last = start + len(seam.poses) - 1
        lines += [f"  !{plain(seam.title)[:28]} ;", *(f"J P[{i}] 20% FINE    ;" for i in range(first, start)),
                  *seam.lines_at(BEFORE, "fanuc", "  {} ;"),
                  f"L P[{start}] {AIR_VELOCITY:g}mm/sec FINE    ;", f"  !seam {number} starts ;",
                  *seam.lines_at(0, "fanuc", "  {} ;")]
        for to, by in seam.sections:
            rounding = "CNT100" if to < last - start else "FINE"
            end = f"P[{start + to}] {seam.velocity_to(to, settings):g}mm/sec {rounding}"
            lines += [f"L {end}    ;"] if by is None else [f"C P[{start + by}]", f"  {end}    ;"]
            lines += seam.lines_at(to, "fanuc", "  {} ;")
        lines += [f"  !seam {number} ends ;", f"L P[{last + 1}] {AIR_VELOCITY:g}mm/sec FINE    ;"]
    numbered, count = [], 0
    for before, line in zip(["", *lines], lines, strict=False):
        # The second line of a circle has no number of its own.
        continues = before.startswith("C P[") and not before.endswith(";")
        count += not continues
        numbered.append(f"    :{line}" if continues else f"{count:4d}:{line}")
    head = _HEAD.format(name=program_name(stem, NAME_LIMIT).upper(), lines=count)
    return "\n".join([head, *numbered, "/POS", *places, "/END"]) + "\n"


def _said(choice: FrameChoice, where: str) -> list[str]:
    """A frame that the controller must have in its table, as remarks: its language sets none."""
    if not isinstance(choice, tuple):
        return []
    w, p, r = choice[5], choice[4], choice[3]
    return [f"  !{where} must be: ;", f"  !X{choice[0]:.3f} Y{choice[1]:.3f} Z{choice[2]:.3f} ;",
            f"  !W{w:.3f} P{p:.3f} R{r:.3f} ;"]


def _places(seam: SeamMoves, first: int, frame: int, tool: int) -> list[str]:
    """One record per place; the way through the air in joints lines they are the controller's."""
    poses = seam.whole_way
    angles = kuka_angles(poses[:, :3, :3])[:, ::-1]
    joints = seam.joints_for("fanuc")
    found = []
    for i, (pose, turn) in enumerate(zip(poses, angles, strict=True)):
        if joints is not None and i < len(joints):
            lines = _joints(joints[i])
            head = f"\tUF : {frame}, UT : {tool},"
        else:
            x, y, z = numbers(pose[:3, 3], 4)
            w, p, r = numbers(turn, 5)
            known = joints is not None and seam.configurations
            configuration = seam.configurations[i] if known else USUAL_CONFIGURATION
            head = f"\tUF : {frame}, UT : {tool},\t\tCONFIG : '{configuration}',"
            lines = [f"\tX = {x}  mm,\tY = {y}  mm,\tZ = {z}  mm,", f"\tW = {w} deg,\tP = {p} deg,\tR = {r} deg"]
        found.append("\n".join([f"P[{first + i}]{{", "   GP1:", head, *lines, "};"]))
    return found


def _joints(joints: Array) -> list[str]:
    texts = [f"\tJ{i}= {angle} deg" for i, angle in enumerate(numbers(joints, 5), 1)]
    return [",".join(texts[:3]) + ",", ",".join(texts[3:])]
