# SPDX-License-Identifier: LGPL-2.1-or-later
"""Universal Robots URScript (.script), in metres and rotation vectors in rad."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from .angles import from_kuka_angles, ur_rotation_vectors
from .moves import AIR_VELOCITY, BEFORE, FrameChoice, RobotSettings, SeamMoves, numbers, plain, program_name

NAME_LIMIT = 32
_ACCELERATION = 0.5
"""In m/s²; joints likewise in rad/s², at 0.3 rad/s."""


def urscript_text(stem: str, seams: Sequence[SeamMoves], settings: RobotSettings) -> str:
    """The text of ``stem``.script.

    Raises
    ------
    InputError : a tool or base is given by number or name
    """
    name = program_name(stem, NAME_LIMIT)
    tool, base = _pose("tool", settings.tool), _pose("base", settings.base)
    lines = [f"def {name}():",
             "  # Welds seams of an as-built model. Poses: metres and a rotation vector in rad.",
             "  # Torch frame: z out of the nozzle into the joint, x along the travel.",
             "  # Poses are in the frame of the model."]
    lines += [f"  set_tcp({tool})"] * (tool is not None) + [f"  model_frame = {base}"] * (base is not None)
    air = _speed(AIR_VELOCITY)
    for number, seam in enumerate(seams, 1):
        texts = [_in_model(pose, base) for pose in pose_texts(seam.whole_way)]
        places, (*poses, retract) = texts[: len(seam.way) + 1], texts[len(seam.way) + 1 :]
        if (joints := seam.joints_for("ur")) is not None:
            places = [f"[{','.join(numbers(np.radians(row), 8))}]" for row in joints]
        lines += [f"  # {plain(seam.title)}", *(f"  movej({place}, a={_ACCELERATION:g}, v=0.3)" for place in places),
                  *seam.lines_at(BEFORE, "ur", "  {}"),
                  f"  movel({poses[0]}, {air})", f"  # seam {number} starts"]
        lines += seam.lines_at(0, "ur", "  {}")
        for to, by in seam.sections:
            at = _speed(seam.velocity_to(to, settings))
            lines += [(f"  movel({poses[to]}, {at}" if by is None else f"  movec({poses[by]}, {poses[to]}, {at}")
                      + (f", r={seam.blend / 1000.0:.6f})" if to < len(poses) - 1 else ")"),
                      *seam.lines_at(to, "ur", "  {}")]
        lines += [f"  # seam {number} ends", f"  movel({retract}, {air})"]
    return "\n".join([*lines, "end", f"{name}()"]) + "\n"


def pose_texts(poses: Array) -> list[str]:
    """Poses (n, 4, 4) as URScript's, "p[x,y,z,rx,ry,rz]"."""
    vectors = ur_rotation_vectors(poses[:, :3, :3])
    return [f"p[{','.join([*numbers(pose[:3, 3] / 1000.0, 8), *numbers(turn, 8)])}]"
            for pose, turn in zip(poses, vectors, strict=True)]


def _speed(velocity: float) -> str:
    return f"a={_ACCELERATION:g}, v={velocity / 1000.0:.6g}"


def _in_model(pose: str, base: str | None) -> str:
    return f"pose_trans(model_frame, {pose})" if base else pose


def _pose(what: str, choice: FrameChoice) -> str | None:
    if choice is None:
        return None
    if not isinstance(choice, tuple):
        raise InputError(f"A URScript has no numbered or named {what}s: give X,Y,Z,A,B,C instead of {choice}.")
    pose = np.eye(4)[None]
    pose[0, :3, :3], pose[0, :3, 3] = from_kuka_angles(np.array([choice[3:]]))[0], choice[:3]
    return pose_texts(pose)[0]
