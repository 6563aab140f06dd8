# SPDX-License-Identifier: LGPL-2.1-or-later
"""ABB RAPID: a module (.mod) with its targets, in mm and quaternions of which q1 is the scalar."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from .angles import abb_quaternions, from_kuka_angles
from .moves import AIR_VELOCITY, BEFORE, FrameChoice, RobotSettings, SeamMoves, numbers, plain, program_name

NAME_LIMIT = 24
_NO_EXTERNAL = "[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]"
_NO_AXES = f"[0,0,0,0],{_NO_EXTERNAL}"


def rapid_text(stem: str, seams: Sequence[SeamMoves], settings: RobotSettings) -> str:
    """The text of ``stem``.mod.

    Raises
    ------
    InputError : a tool or base is given by number
    """
    name = program_name(stem, NAME_LIMIT)
    tool, tool_data = _choice("tool", settings.tool, "tool0", "tFfdsTorch")
    base, base_data = _choice("base", settings.base, "wobj0", "wFfdsModel")
    lines = [f"MODULE {name}_m",
             "  ! Welds seams of an as-built model. Targets: mm and quaternions [q1,q2,q3,q4], q1 the scalar.",
             "  ! Torch frame: z out of the nozzle into the joint, x along the travel.",
             "  ! The work object is the frame of the model."]
    if tool_data:
        lines.append(f"  PERS tooldata {tool}:=[TRUE,{tool_data},[1,[0,0,100],[1,0,0,0],0,0,0]];")
    if base_data:
        lines.append(f"  PERS wobjdata {base}:=[FALSE,TRUE,\"\",{base_data},[[0,0,0],[1,0,0,0]]];")
    lines += [f"  CONST speeddata vFfdsWeld:=[{settings.velocity:g},100,1000,1000];",
              f"  CONST speeddata vFfdsAir:=[{AIR_VELOCITY:g},100,1000,1000];"]
    body: list[str] = []
    for number, seam in enumerate(seams, 1):
        zone = f"zFfds{number}"
        points = [f"pS{number}_{i}" for i in range(1, len(seam.poses) + 1)]
        ways = [f"pS{number}_w{i}" for i in range(1, len(seam.way) + 1)]
        names = [*ways, f"pS{number}_in", *points, f"pS{number}_out"]
        joints = seam.joints_for("abb")
        targets = [] if joints is None else [",".join(numbers(row, 5)) for row in joints]
        lines += [f"  CONST jointtarget {point}:=[[{target}],{_NO_EXTERNAL}];"
                  for point, target in zip(names, targets, strict=False)]
        lines += [f"  CONST robtarget {point}:=[{pose[1:-1]},{_NO_AXES}];" for point, pose in zip(
            names[len(targets) :], pose_texts(seam.whole_way[len(targets) :]), strict=True)]
        blend = f"{seam.blend:.3f}"
        lines.append(f"  CONST zonedata {zone}:=[FALSE,{blend},{blend},{blend},0.5,{blend},0.5];")
        at = f"{tool}\\WObj:={base};"
        move = "MoveAbsJ" if targets else "MoveJ"
        body += [f"    ! {plain(seam.title)}", *(f"    {move} {way},vFfdsAir,fine,{at}" for way in ways),
                 f"    {move} pS{number}_in,vFfdsAir,fine,{at}", *seam.lines_at(BEFORE, "abb", "    {}"),
                 f"    MoveL {points[0]},vFfdsAir,fine,{at}",
                 f"    ! seam {number} starts"]
        body += seam.lines_at(0, "abb", "    {}")
        for to, by in seam.sections:
            speed = seam.velocity_to(to, settings)
            data = "vFfdsWeld" if speed == settings.velocity else f"[{speed:g},100,1000,1000]"
            body += [("    MoveL " if by is None else f"    MoveC {points[by]},")
                     + f"{points[to]},{data},{zone if to < len(points) - 1 else 'fine'},{at}",
                     *seam.lines_at(to, "abb", "    {}")]
        body += [f"    ! seam {number} ends",
                 f"    MoveL pS{number}_out,vFfdsAir,fine,{at}"]
    lines += [f"  PROC {name}()", "    ConfJ\\Off;", "    ConfL\\Off;", *body, "  ENDPROC", "ENDMODULE"]
    return "\n".join(lines) + "\n"


def pose_texts(poses: Array) -> list[str]:
    """Poses (n, 4, 4) as RAPID's, "[[x,y,z],[q1,q2,q3,q4]]"."""
    q = abb_quaternions(poses[:, :3, :3])
    return [f"[[{','.join(numbers(pose[:3, 3], 4))}],[{','.join(numbers(turn, 9))}]]"
            for pose, turn in zip(poses, q, strict=True)]


def _choice(what: str, choice: FrameChoice, default: str, own: str) -> tuple[str, str]:
    """The name to move with, and the pose to declare it with, if it is not the controller's."""
    if choice is None:
        return default, ""
    if isinstance(choice, int):
        raise InputError(f"ABB controllers name their {what}s: give a name or X,Y,Z,A,B,C instead of {choice}.")
    if isinstance(choice, str):
        return choice, ""
    pose = np.eye(4)[None]
    pose[0, :3, :3], pose[0, :3, 3] = from_kuka_angles(np.array([choice[3:]]))[0], choice[:3]
    return own, pose_texts(pose)[0]
