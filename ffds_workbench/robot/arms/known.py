# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms from the files in ``resources/robots``, by name; their formats are those of the makers' data sheets.

``opw`` gives the seven-parameter model of arms with a spherical wrist (Brandstötter, Angerer, Hofbaur: *An analytical
solution of the inverse kinematics problem of industrial serial manipulators with an ortho-parallel basis and a
spherical wrist*, 2014) with an offset and a sign per joint; ``dh`` rows d, a, α of Denavit and Hartenberg.
"""
from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from ... import RESOURCES
from ...errors import InputError
from ...registration.motions import motion
from ..kinematics import Chain, chain_of, family
from .arm import Arm, LinkSizes, capsules_of
from .urdf import read_urdf

_FOLDER = RESOURCES / "robots"


def read_arm(name: str | Path) -> Arm:
    """An arm by its name, as "KR 8 R1440-2" or "ur10e", or from a URDF file.

    Raises
    ------
    InputError : no arm has that name, or the file cannot be read or has no closed form
    """
    text = str(name)
    if text.lower().endswith((".urdf", ".xml", ".xacro")):
        return read_urdf(Path(text))
    wanted = _key(text)
    entries = [json.loads(path.read_text("utf-8")) for path in sorted(_FOLDER.glob("*.json"))]
    names = {_key(alias): entry for entry in entries for alias in (entry["name"], *entry["aliases"])}
    if wanted in names:
        return _arm(names[wanted])
    known = ", ".join(entry["name"] for entry in entries)
    raise InputError(f"There is no robot '{text}': name one of {known}, or a URDF file.")


def known_arms() -> tuple[str, ...]:
    """The names of all arms that are known."""
    return tuple(json.loads(path.read_text("utf-8"))["name"] for path in sorted(_FOLDER.glob("*.json")))


def _key(name: str) -> str:
    """Only what tells arms apart: "KUKA KR 8 R1440-2" and "kr8r1440-2" are one name."""
    return re.sub(r"^(kuka|abb|fanuc|yaskawa|motoman|universalrobots)", "", re.sub(r"[^a-z0-9]", "", name.lower()))


def _arm(entry: Mapping[str, Any]) -> Arm:
    chain = _opw_chain(entry) if "opw" in entry else _dh_chain(entry["dh"])
    shifts = {f"{name}_shift": value for name, value in entry.get("shifts", {}).items()}
    speeds = np.radians(entry["speeds"])
    return Arm(entry["name"], entry["maker"], family(chain), np.radians(np.array(entry["limits"], dtype=float)), speeds,
               speeds / entry["seconds_to_full_speed"], entry["reach"],
               capsules_of(chain, LinkSizes(**entry["radii"], **shifts)), np.array(entry["controller_origin"], float),
               entry.get("coupled_third_joint", False), tuple(entry["sources"]), tuple(entry["unsure"]))


def _opw_chain(entry: Mapping[str, Any]) -> Chain:
    """The model stands upright at its own zero: all axes along z or y; the maker's zero is ``offsets`` away."""
    a1, a2, c1, c2, c3, c4 = (entry["opw"][name] for name in ("a1", "a2", "c1", "c2", "c3", "c4"))
    places = [(0, 0, 0), (a1, 0, c1), (a1, 0, c1 + c2), (a1 + a2, 0, c1 + c2), (a1 + a2, 0, c1 + c2 + c3),
              (a1 + a2, 0, c1 + c2 + c3)]
    y, z = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    axes = np.array([z, y, y, z, y, z]) * np.array(entry["signs"], dtype=float)[:, None]
    upright = Chain(axes, np.array(places, dtype=float), motion(np.eye(3), np.array([a1 + a2, 0, c1 + c2 + c3 + c4])))
    # The model's angle is sign · joint − offset: at the maker's zero every joint of the model stands at −offset.
    start = -np.radians(entry["offsets"]) * np.array(entry["signs"], dtype=float)
    links = upright.links(start)
    return Chain(np.einsum("jik,jk->ji", links[:, :3, :3], axes),
                 np.einsum("jik,jk->ji", links[:, :3, :3], upright.points) + links[:, :3, 3], links[5] @ upright.home)


def _dh_chain(rows: list[list[float]]) -> Chain:
    z = np.array([0.0, 0.0, 1.0])
    after, steps = np.eye(4), []
    for d, a, alpha in rows:
        steps.append((after, z))
        after = motion(Rotation.from_euler("x", alpha, degrees=True).as_matrix(), np.array([a, 0.0, d]))
    return chain_of(steps, after)
