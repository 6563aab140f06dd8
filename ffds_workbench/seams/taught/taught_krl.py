# SPDX-License-Identifier: LGPL-2.1-or-later
"""A taught path as a KUKA KRL program: its poses found, moved, and all else left as it was written.

Poses are the aggregates with X, Y and Z in .src and .dat. Left alone are tools, bases and relative motions.
"""
from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from ...errors import InputError
from ...registration.arrays import Array
from ...scan.cloud import FARTHEST
from ..programs.angles import from_kuka_angles, kuka_angles
from ..programs.moves import numbers
from .attach import Motion

_AGGREGATE = re.compile(r"\{[^{}]*\}")
_NUMBER = re.compile(r"\b([XYZABC])\s+([-+]?(?:\d+\.?\d*|\.\d+)(?:E[-+]?\d+)?)", re.IGNORECASE)
_NOT_A_POSE = re.compile(r"\$(BASE|TOOL|WORLD|ROBROOT|NULLFRAME)\b|(BASE|TOOL|LOAD|MACHINE)_DATA|\$?LOAD\b|_REL\b",
                         re.IGNORECASE)


@dataclass(frozen=True)
class _Pose:
    file: int
    start: int
    end: int
    values: dict[str, float]


@dataclass(frozen=True)
class TaughtKrl:
    """A program as its texts, the .src first."""

    texts: tuple[str, ...]

    @cached_property
    def _poses(self) -> tuple[_Pose, ...]:
        found = [pose for number, text in enumerate(self.texts) for pose in _poses_of(number, text)]
        if not found:
            raise InputError("The program has no poses with X, Y and Z.")
        return tuple(found)

    @property
    def positions(self) -> Array:
        """(n, 3) in mm."""
        return np.array([[pose.values[key] for key in "XYZ"] for pose in self._poses])

    def moved(self, motion: Motion) -> tuple[str, ...]:
        """The texts with all poses carried along; a pose without A, B and C is moved only."""
        angles = np.array([[pose.values.get(key, 0.0) for key in "ABC"] for pose in self._poses])
        points, turned = motion.points(self.positions), kuka_angles(motion.vectors(from_kuka_angles(angles)))
        texts = list(self.texts)
        for pose, point, turn in reversed(list(zip(self._poses, points, turned, strict=True))):
            new = dict(zip("XYZABC", [*numbers(point, 4), *numbers(turn, 5)], strict=True))
            text = texts[pose.file]
            replaced = _NUMBER.sub(partial(_with_new_number, new), text[pose.start : pose.end])
            texts[pose.file] = text[: pose.start] + replaced + text[pose.end :]
        return tuple(texts)


def _with_new_number(new: Mapping[str, str], match: re.Match[str]) -> str:
    """A component of a position with its new number."""
    return f"{match[1]} {new[match[1].upper()]}"


def renamed(text: str, old: str, new: str) -> str:
    """A text with the program's own name changed where it is declared."""
    return re.sub(rf"(?im)^(\s*(?:GLOBAL\s+)?(?:DEF|DEFDAT)\s+){re.escape(old)}\b", lambda match: match[1] + new, text)


def _poses_of(file: int, text: str) -> list[_Pose]:
    poses = []
    for match in _AGGREGATE.finditer(text):
        before = text[text.rfind("\n", 0, match.start()) + 1 : match.start()]
        values = {key.upper(): float(value) for key, value in _NUMBER.findall(match[0])}
        if ";" in before or _NOT_A_POSE.search(before) or not values.keys() & set("XYZ"):
            continue
        missing = [key for key in "XYZ" if key not in values]
        partly = 0 < len(values.keys() & set("ABC")) < 3
        if missing or partly:
            shown = " ".join(match[0].split())[:80]
            raise InputError(f"{_line(text, match)} gives a part of a pose only, {shown}: write it in full.")
        if not all(abs(value) < FARTHEST for value in values.values()):
            raise InputError(f"{_line(text, match)} has a pose without finite numbers.")
        poses.append(_Pose(file, match.start(), match.end(), values))
    return poses


def _line(text: str, match: re.Match[str]) -> str:
    """Where a match is, in words."""
    return f"Line {text.count(chr(10), 0, match.start()) + 1} of the program"
