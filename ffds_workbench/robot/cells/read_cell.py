# SPDX-License-Identifier: LGPL-2.1-or-later
"""``cell.json``: read, and refused in one sentence where it makes no sense."""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from ...registration.motions import motion
from ...seams.programs.angles import from_kuka_angles
from ..arms import Arm, read_arm
from ..clearance import Box, Cylinder, Solid, Facets, triangles_of_file
from ..entries import checked_object, read_object
from .cell import FREE, Cell, default_base
from .torch import Torch

_KEYS = ("robot", "base", "torch", "table", "solids", "clearance", "yaw", "work_angle", "travel_angle", "home")
_TORCH = tuple(field.name for field in fields(Torch))


def read_cell(path: Path | None, robot: str | Path | None) -> Cell:
    """The cell of a file, or without one the default: the robot behind the model, with nothing around.

    Parameters
    ----------
    path : of cell.json, see ``resources/docs/robot.md``
    robot : its name or URDF file; None: the file's

    Raises
    ------
    InputError : the file cannot be read, has unknown keys or values that make no sense
    """
    entries: Mapping[str, Any] = {} if path is None else checked_object(
        read_object(path, "cell"), _KEYS, "cell")
    if robot is None and "robot" not in entries:
        raise InputError("No robot was named: give --robot, or name it in the cell.")
    arm = read_arm(entries["robot"] if robot is None else robot)
    said: dict[str, Any] = {}
    if "clearance" in entries:
        said["clearance"] = _number(entries["clearance"], "clearance")
    for key, name in (("work_angle", "work"), ("travel_angle", "travel")):
        if key in entries:
            said[name] = _range(entries[key], key, math.pi / 2.0)
    if "yaw" in entries:
        said["yaw"] = FREE if entries["yaw"] == "free" else _range(entries["yaw"], "yaw", math.pi)
    if "home" in entries:
        said["home"] = _home(entries["home"], arm)
    folder = Path() if path is None else path.parent
    found = [_solid(item, folder, number) for number, item in enumerate(_solids(entries), 1)]
    return Cell(arm, _pose(entries["base"], "base") if "base" in entries else default_base(arm),
                _torch(entries.get("torch", {})),
                tuple((name, item) for name, item in found if not isinstance(item, Facets)),
                tuple((name, item) for name, item in found if isinstance(item, Facets)), **said)


def _numbers(value: object, count: int, what: str) -> Array:
    try:
        found = np.array(value, dtype=float)
    except (TypeError, ValueError):
        found = np.empty(0)
    if found.shape != (count,) or not (np.abs(found) < 1e6).all():
        raise InputError(f"The cell's {what} must be {count} numbers.")
    return found


def _number(value: object, what: str) -> float:
    found = float(_numbers([value], 1, what)[0])
    if found < 0.0:
        raise InputError(f"The cell's {what} must not be negative.")
    return found


def _range(value: object, what: str, widest: float) -> tuple[float, float]:
    """From and to in rad of one angle or two in degrees."""
    pair = [value, value] if isinstance(value, (int, float)) else value
    low, high = np.radians(_numbers(pair, 2, what)).tolist()
    if not -widest - 1e-9 <= low <= high <= widest + 1e-9:
        raise InputError(f"The cell's {what} must rise, within ±{math.degrees(widest):g}°.")
    return low, high


def _pose(value: object, what: str) -> Array:
    """Of X, Y, Z, A, B, C in mm and degrees."""
    numbers = _numbers(value, 6, f"{what} (X, Y, Z, A, B, C)")
    return motion(from_kuka_angles(numbers[None, 3:])[0], numbers[:3])


def _home(value: object, arm: Arm) -> Array:
    joints = np.radians(_numbers(value, 6, "home"))
    if ((joints < arm.limits[:, 0]) | (joints > arm.limits[:, 1])).any():
        raise InputError(f"The cell's home lies beyond the limits of the {arm.name}.")
    return joints


def _torch(entry: object) -> Torch:
    return Torch(**{name: float(_numbers([value], 1, f"torch's {name}")[0])
                    for name, value in checked_object(entry, _TORCH, "torch").items()})


def _solids(entries: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    found = entries.get("solids", [])
    if not isinstance(found, list):
        raise InputError("The cell's solids must be a list.")
    table = [{"name": "table", **entries["table"]}] if isinstance(entries.get("table"), Mapping) else []
    if "table" in entries and not table:
        raise InputError("The cell's table must be a solid: {\"box\": [X0, Y0, Z0, X1, Y1, Z1]}.")
    return [*table, *found]


def _solid(entry: object, folder: Path, number: int) -> tuple[str, Solid | Facets]:
    entry = checked_object(entry, ("name", "box", "cylinder", "step", "at"), f"solid {number} of the cell")
    name = str(entry.get("name", f"solid {number}"))
    pose = _pose(entry["at"], f"{name}'s at") if "at" in entry else np.eye(4)
    if "box" in entry:
        box = _numbers(entry["box"], 6, f"{name}'s box (X0, Y0, Z0, X1, Y1, Z1)")
        if not (box[:3] < box[3:]).all():
            raise InputError(f"The cell's {name} must have its smaller corner first.")
        return name, Box(box[:3], box[3:], pose)
    if "cylinder" in entry:
        numbers = _numbers(entry["cylinder"], 7, f"{name}'s cylinder (X0, Y0, Z0, X1, Y1, Z1, RADIUS)")
        start, end = (pose[:3, :3] @ point + pose[:3, 3] for point in (numbers[:3], numbers[3:6]))
        if numbers[6] <= 0.0 or not (start != end).any():
            raise InputError(f"The cell's {name} must have a length and a radius.")
        return name, Cylinder(start, end, float(numbers[6]))
    if "step" in entry:
        return name, triangles_of_file(folder / str(entry["step"]), pose)
    raise InputError(f"The cell's {name} must be a box, a cylinder or a step file.")
