# SPDX-License-Identifier: LGPL-2.1-or-later
"""How to weld, from ``process.json``: only the numbers that the user gave, chosen by the joint and by its gap.

A row of a table holds up to its gap: a station takes the first row whose gap is not below its own. Where the gap is
beyond the last row, that stretch is not welded.
"""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import RESOURCES
from ..errors import InputError
from ..registration.arrays import Index
from ..seams.measured import MeasuredSeam
from ..seams.programs.moves import RobotSettings
from .entries import checked_object, read_object
from .searches import Search

_TEMPLATES = RESOURCES / "robots" / "templates" / "process.json"
_KEYS = ("tables", "tolerance", "stitch", "templates")
_ROW = ("gap", "speed", "job", "weave")
_WEAVE = ("schedule", "pattern", "width", "frequency")
USUAL_TOLERANCE = 0.5
"""In mm: about half a wire; how far off a seam may be for which the process names no tolerance (unit)."""


@dataclass(frozen=True)
class TableRow:
    """Up to a gap in mm: the speed in mm/s, and what the templates write; ``values`` holds job and weave."""

    gap: float
    speed: float
    values: Mapping[str, Any]
    weaves: bool


@dataclass(frozen=True)
class Process:
    """A process.

    Attributes
    ----------
    tables : joints, and rows by rising gap; "any" stands for all joints
    tolerance : in mm: where a seam's band is wider, it is searched for
    stitch : length of a weld and of the way to the next in mm; None: one weld
    templates : dialect, then event, then the lines to write
    """

    tables: Sequence[tuple[frozenset[str], tuple[TableRow, ...]]]
    tolerance: float
    stitch: tuple[float, float] | None
    templates: Mapping[str, Mapping[str, Sequence[str]]]

    def rows_for(self, kind: str) -> tuple[TableRow, ...]:
        """The table for a joint ("T", "pipe", …), empty where there is none."""
        kinds = set(kind.split("+"))
        fitting = [rows for joints, rows in self.tables if joints & kinds or "any" in joints]
        return fitting[0] if fitting else ()


@dataclass(frozen=True)
class Welding:
    """How one seam is welded.

    Attributes
    ----------
    rows : the table
    row : (n − 1,) index of the row from each station to the next, −1 where nothing is welded
    refused : stations from and to, and why
    """

    rows: tuple[TableRow, ...]
    row: Index
    refused: tuple[tuple[int, int, str], ...]


def read_process(path: Path) -> Process:
    """The process of a file, see ``resources/docs/robot.md``.

    Raises
    ------
    InputError : the file cannot be read, lacks what is needed or holds what is unknown
    """
    entries = checked_object(read_object(path, "process"), _KEYS, "process")
    tables = entries.get("tables")
    if not isinstance(tables, list) or not tables:
        raise InputError("The process must have tables: a list of objects with joint and rows.")
    stitch = entries.get("stitch")
    if stitch is not None:
        stitch = checked_object(stitch, ("length", "gap"), "process's stitch")
        stitch = _number(stitch, "length", "stitch"), _number(stitch, "gap", "stitch")
    templates = usual_templates()
    if "templates" in entries:
        own = read_object(path.parent / str(entries["templates"]), "templates")
        templates = {dialect: {**templates.get(dialect, {}), **own.get(dialect, {})} for dialect in {*templates, *own}
                     if not dialect.startswith("$")}
    tolerance = _number(entries, "tolerance", "process") if "tolerance" in entries else USUAL_TOLERANCE
    return Process([_table(entry) for entry in tables], tolerance, stitch, templates)


def usual_templates() -> Mapping[str, Any]:
    """By dialect and event: the lines to write."""
    return {name: lines for name, lines in read_object(_TEMPLATES, "templates").items() if not name.startswith("$")}


def _number(entry: Mapping[str, Any], key: str, what: str) -> float:
    value = entry.get(key)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or value < 0.0:
        raise InputError(f"The {what}'s {key} must be a number of at least 0.")
    return float(value)


def _table(entry: object) -> tuple[frozenset[str], tuple[TableRow, ...]]:
    entry = checked_object(entry, ("joint", "rows"), "process's table")
    joints = entry.get("joint", "any")
    rows = entry.get("rows")
    if not isinstance(rows, list) or not rows:
        raise InputError("A table of the process must have rows: objects with gap, speed and job.")
    found = sorted((_row(row) for row in rows), key=lambda row: row.gap)
    return frozenset([joints] if isinstance(joints, str) else map(str, joints)), tuple(found)


def _row(entry: object) -> TableRow:
    entry = checked_object(entry, _ROW, "process's row")
    speed = _number(entry, "speed", "row")
    RobotSettings(velocity=speed)  # says what is wrong with it
    if "job" not in entry:
        raise InputError("A row of the process must name a job: the number of the schedule to weld with.")
    weave = checked_object(entry.get("weave", {}), _WEAVE, "process's weave")
    return TableRow(_number(entry, "gap", "row"), speed, {"job": entry["job"], "speed": speed, **weave}, bool(weave))


def welding_of(process: Process, seam: MeasuredSeam) -> Welding:
    """Which row each part of a seam is welded with; an unknown gap counts as none.

    Parameters
    ----------
    seam : with its gaps and its kind of joint
    """
    stations = seam.stations
    rows = process.rows_for(stations.seam.kind)
    if not rows:
        last = len(stations) - 1
        why = f"the process has no table for a {stations.seam.kind} joint"
        return Welding((), np.full(last, -1), ((0, last, why),))
    gap = np.maximum(np.nan_to_num(stations.gap), 0.0)
    gap = np.maximum(gap[1:], gap[:-1])
    row = np.searchsorted([row.gap for row in rows], gap - 1e-9)
    row[row == len(rows)] = -1
    refused = tuple((int(run[0]), int(run[-1]) + 1, f"a gap of {gap[run].max():.2f} mm is beyond the table's "
                     f"{rows[-1].gap:g} mm") for run in runs(row < 0))
    if process.stitch is not None:
        length, pause = process.stitch
        middle = 0.5 * (stations.places.arc_length[1:] + stations.places.arc_length[:-1])
        row[np.mod(middle, length + pause) >= length] = -1
    return Welding(rows, row, refused)


def runs(flags: NDArray[np.bool_]) -> list[Index]:
    """The indices of each run of True in flags (n,)."""
    on = np.flatnonzero(flags)
    return [] if not len(on) else np.split(on, np.flatnonzero(np.diff(on) > 1) + 1)


def statements(process: Process, welding: Welding, first: int, last: int) -> dict[str, dict[int, tuple[str, ...]]]:
    """What to write, by dialect and station counted from ``first``, along the stations ``first`` to ``last``.

    Raises
    ------
    InputError : a template asks for a value that the process does not give
    """
    along = [*welding.row[first:last].tolist(), -1]
    found: dict[str, dict[int, tuple[str, ...]]] = {}
    for dialect, lines in process.templates.items():
        at: dict[int, tuple[str, ...]] = {}
        before = -1
        for station, now in enumerate(along):
            if now != before:
                at[station] = (*_ending(dialect, lines, welding.rows, before),
                               *_beginning(dialect, lines, welding.rows, now))
            before = now
        found[dialect] = at
    return found


def search_lines(dialect: str, lines: Mapping[str, Sequence[str]], number: int, search: Search) -> list[str]:
    """What to write for a touch, the ``number``-th of its seam; places in mm in the frame of the model."""
    start, step = search.start[:3, 3], search.end[:3, 3] - search.start[:3, 3]
    values: dict[str, Any] = {"number": number, **{name: f"{value:.3f}" for name, value in zip(
        ("x", "y", "z", "dx", "dy", "dz"), [*start.tolist(), *step.tolist()], strict=True)}}
    return _filled(dialect, lines, "search", values)


def _beginning(dialect: str, lines: Mapping[str, Sequence[str]], rows: Sequence[TableRow], row: int) -> list[str]:
    if row < 0:
        return []
    return [*_written(dialect, lines, "arc_on", rows[row]),
            *(_written(dialect, lines, "weave_on", rows[row]) if rows[row].weaves else [])]


def _ending(dialect: str, lines: Mapping[str, Sequence[str]], rows: Sequence[TableRow], row: int) -> list[str]:
    if row < 0:
        return []
    return [*(_written(dialect, lines, "weave_off", rows[row]) if rows[row].weaves else []),
            *_written(dialect, lines, "arc_off", rows[row])]


def _written(dialect: str, lines: Mapping[str, Sequence[str]], event: str, row: TableRow) -> list[str]:
    return _filled(dialect, lines, event, row.values)


def _filled(dialect: str, lines: Mapping[str, Sequence[str]], event: str, values: Mapping[str, Any]) -> list[str]:
    try:
        return [str(line).format(**values) for line in lines.get(event, ())]
    except (KeyError, IndexError, ValueError) as error:
        raise InputError(f"The {dialect} template's {event} asks for {error}, which the process does not give."
                         ) from error
