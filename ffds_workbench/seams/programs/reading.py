# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs read back: the poses in the order in which they are passed; joint targets have none and are left out."""
from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from ...registration.motions import motion
from .angles import from_kawasaki_angles, from_kuka_angles

_NUMBER = r"(-?\d*\.?\d+)"
_LS_PLACE = re.compile(r"P\[(\d+)[^\]]*\]\s*\{(.*?)\};", re.DOTALL)
_LS_MOVE = re.compile(r"^\s*\d*\s*:\s*(?:[JLC]\s+)?P\[(\d+)", re.MULTILINE)
_JBI_PLACE = re.compile(rf"^[CP](\d+)={','.join([_NUMBER] * 6)}", re.MULTILINE)
_JBI_MOVE = re.compile(r"^MOV(?:J|L|C)\s+[CP](\d+)", re.MULTILINE)
_AS_PLACE = re.compile(rf"^\s*(\w+){''.join([rf'[ ,]+{_NUMBER}'] * 6)}\s*$", re.MULTILINE)
_AS_MOVE = re.compile(r"^\s*(?:JMOVE|LMOVE|C1MOVE|C2MOVE|LWS|LWC|LWE|C1WC|C2WC)\s+(#?\w+)", re.MULTILINE)


def read_program(path: Path) -> Array:
    """Poses (n, 4, 4) of a program in the frame that it is written in.

    Parameters
    ----------
    path : .ls (FANUC), .jbi (Yaskawa) or .as (Kawasaki)

    Raises
    ------
    InputError : the file cannot be read, is in another language, or moves to a place that it does not have
    """
    readers = {".ls": _ls, ".jbi": _jbi, ".as": _as}
    if path.suffix.lower() not in readers:
        raise InputError(f"The program {path} is in a language that is not read here: use .ls, .jbi or .as.")
    try:
        text = path.read_text("latin-1")
    except OSError as error:
        raise InputError(f"The program {path} cannot be read: {error.strerror}.") from error
    places, moves = readers[path.suffix.lower()](text)
    missing = [name for name in moves if name not in places]
    if missing:
        raise InputError(f"The program {path} moves to {missing[0]}, which it does not have.")
    found = [places[name] for name in moves]
    return np.array([pose for pose in found if pose is not None]).reshape(-1, 4, 4)


def _ls(text: str) -> tuple[Mapping[str, Array | None], list[str]]:
    main, _, positions = text.partition("/POS")
    places: dict[str, Array | None] = {}
    for name, record in _LS_PLACE.findall(positions):
        values = {key: float(value) for key, value in re.findall(rf"\b([XYZWPR])\s*=\s*{_NUMBER}", record)}
        places[name] = None if len(values) < 6 else _pose([values[key] for key in "XYZ"], from_kuka_angles(
            np.array([[values[key] for key in "RPW"]])))
    return places, _LS_MOVE.findall(main)


def _jbi(text: str) -> tuple[Mapping[str, Array | None], list[str]]:
    places: dict[str, Array | None] = {
        name: _pose(list(map(float, values[:3])), from_kuka_angles(np.array([list(map(float, values[:2:-1]))])))
        for name, *values in _JBI_PLACE.findall(text)}
    return places, _JBI_MOVE.findall(text)


def _as(text: str) -> tuple[Mapping[str, Array | None], list[str]]:
    places: dict[str, Array | None] = {
        name: _pose(list(map(float, values[:3])), from_kawasaki_angles(np.array([list(map(float, values[3:]))])))
        for name, *values in _AS_PLACE.findall(text)}
    moves = _AS_MOVE.findall(text)
    return {**places, **{name: None for name in moves if name.startswith("#")}}, moves


def _pose(position: list[float], rotation: Array) -> Array:
    return motion(rotation[0], np.array(position))
