# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms from URDF files: the first six turning joints that follow each other, and the flange beyond them."""
from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from scipy.spatial.transform import Rotation

from ...errors import InputError
from ...registration.arrays import Array
from ...registration.motions import motion
from ...scan.xml_text import parse
from ..kinematics import chain_of, family
from .arm import Arm, LinkSizes, capsules_of

_FLANGES = ("tool0", "flange")
"""What ROS-Industrial calls the flange; without one, it is the last link of the chain."""
_MAKERS = ("kuka", "abb", "fanuc", "yaskawa", "motoman", "kawasaki", "ur")
_SECONDS_TO_FULL_SPEED = 0.5
"""In s, of every joint: URDF has no accelerations (unit: an assumption, as in the files of the known arms)."""
_SLOW = math.radians(90.0)
"""Speed in rad/s of a joint for which the file has none (unit: slower than any joint of the known arms)."""
_SIZES = LinkSizes(105.0, 120.0, 85.0, 65.0)
"""How thick the links are taken to be (unit: as welding arms of 1.4 m reach are in ``resources/robots``)."""


def read_urdf(path: Path) -> Arm:
    """An arm from a URDF file; lengths are in metres there.

    Raises
    ------
    InputError : the file cannot be read, has no six turning joints in a row, or they have no closed form
    """
    way = _from_the_base(_joints(path))
    chain = [joint for joint in way if joint.get("type") in ("revolute", "continuous")]
    if len(chain) != 6:
        raise InputError(f"The robot {path} has {len(chain)} turning joints one after the other: six are needed.")
    steps, at = [], np.eye(4)
    for joint in way:
        at = at @ _origin(joint)
        if joint in chain:
            axis = _vector(joint.find("axis"), "xyz", "1 0 0")
            steps.append((at, axis / np.linalg.norm(axis)))
            at = np.eye(4)
    arm = chain_of(steps, at)
    limits = np.array([_limits(joint) for joint in chain])
    speeds = np.array([_number(joint.find("limit"), "velocity", _SLOW) or _SLOW for joint in chain])
    known = family(arm)
    name = path.stem
    maker = next((maker for maker in _MAKERS if name.lower().startswith(maker)), "")
    reach = float(np.linalg.norm(known.shoulder[:2] - arm.points[0][:2])) + sum(known.lengths)
    return Arm(name, {"motoman": "yaskawa"}.get(maker, maker), known, limits, speeds, speeds / _SECONDS_TO_FULL_SPEED,
               reach, capsules_of(arm, _SIZES), np.zeros(3), False, (f"The file {path.name}.",),
               ("How thick its links are: the file's meshes are not read, usual radii stand in.",
                f"Accelerations: every joint is taken to need {_SECONDS_TO_FULL_SPEED:g} s to its full speed."))


def _joints(path: Path) -> list[ElementTree.Element]:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"The robot {path} cannot be read: {error.strerror}.") from error
    try:
        root = parse(data)
    except ValueError as error:
        raise InputError(f"The robot {path} cannot be read: {error}.") from error
    if root.tag != "robot":
        raise InputError(f"The robot {path} is no URDF: its outermost tag must be <robot>.")
    if any("${" in value for element in root.iter() for value in element.attrib.values()):
        raise InputError(f"The robot {path} is a xacro with open variables: turn it into URDF first (xacro FILE).")
    return root.findall("joint")


def _from_the_base(joints: list[ElementTree.Element]) -> list[ElementTree.Element]:
    """The joints from the base to the flange: of several ways that with the most turning joints."""
    children = {joint: _link(joint, "child") for joint in joints}
    parents = {joint: _link(joint, "parent") for joint in joints}
    if len(set(children.values())) < len(joints):
        raise InputError("The robot's file has a link that two joints move.")
    roots = set(parents.values()) - set(children.values())
    ways: list[list[ElementTree.Element]] = [[]]
    open_ways: list[tuple[str, list[ElementTree.Element]]] = [(root, []) for root in sorted(roots)]
    while open_ways:
        link, way = open_ways.pop()
        onward = [joint for joint in joints if parents[joint] == link and joint not in way]
        open_ways += [(children[joint], [*way, joint]) for joint in onward]
        ways.append(way)

    def worth(way: list[ElementTree.Element]) -> tuple[int, bool, int]:
        turning = sum(joint.get("type") in ("revolute", "continuous") for joint in way)
        return turning, bool(way) and children[way[-1]] in _FLANGES, len(way)

    return max(ways, key=worth)


def _link(joint: ElementTree.Element, which: str) -> str:
    found = joint.find(which)
    return "" if found is None else found.get("link", "")


def _origin(joint: ElementTree.Element) -> Array:
    origin = joint.find("origin")
    turn = Rotation.from_euler("xyz", _vector(origin, "rpy", "0 0 0")).as_matrix()
    return motion(turn, 1000.0 * _vector(origin, "xyz", "0 0 0"))


def _limits(joint: ElementTree.Element) -> tuple[float, float]:
    if joint.get("type") == "continuous":
        return -2.0 * math.pi, 2.0 * math.pi
    limit = joint.find("limit")
    return _number(limit, "lower", -math.pi), _number(limit, "upper", math.pi)


def _number(element: ElementTree.Element | None, name: str, default: float) -> float:
    text = None if element is None else element.get(name)
    try:
        return default if text is None else float(text)
    except ValueError as error:
        raise InputError(f"The robot's file has a {name} that is no number: '{text}'.") from error


def _vector(element: ElementTree.Element | None, name: str, default: str) -> Array:
    text = default if element is None else element.get(name, default)
    try:
        values = np.array(text.split(), dtype=float)
    except ValueError:
        values = np.empty(0)
    if values.shape != (3,) or not np.isfinite(values).all():
        raise InputError(f"The robot's file has a {name} that is not three numbers: '{text}'.")
    return values
