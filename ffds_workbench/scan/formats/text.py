# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points as text: xyz, asc, txt, csv and pts, with whatever separator, header and decimal mark they come.

What is recognised: comment lines (``#``, ``//``, ``%``, ``!``), a header that names the columns, a first line with the
number of points (pts), separators blank, tab, comma and semicolon, a decimal comma where the separator is not a comma,
and missing values, which count as rows that are not finite. Normals are the columns named so or, where none are named,
the fourth to sixth; their values show whether these are normals or colours.
"""
from __future__ import annotations

import io
import re
from array import array
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from .. import normals

_COMMENTS = ("#", "//", "%", "!")
_MISSING = {"", "-", "--", "nan", "null", "none", "n/a", "na", "nodata"}
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?$|[-+]?(nan|inf|infinity)$", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?$")
_PROMISE = re.compile("[0-9]{1,18}")
_HEADER_LINES, _SAMPLE_LINES = 50, 200
_LINE_START = 4096
"""Characters of a line that are looked at to tell the layout; a row of points is no longer."""


@dataclass(frozen=True)
class _Beginning:
    """What the first lines of a file state.

    Attributes
    ----------
    header : the line that names the columns, "" without
    promised : the number of points, None where the file does not say it
    start, lines : what goes before the points: so many bytes, in so many lines
    sample : the first rows of points
    """

    header: str
    promised: int | None
    start: int
    lines: int
    sample: list[str]


def read(path: Path) -> NDArray[np.float64]:
    """The first three columns, or those named x, y and z, as the file holds them, (n, 3), or (n, 6) with normals.

    Raises
    ------
    InputError : not a text of points, or fewer points than its first line promises
    """
    data = _text(path)
    beginning = _beginning(data)
    if not beginning.sample:
        raise InputError(f"The scan {path} is not a text file of points: no line starts with a number.")
    separator, decimal_comma = _layout(beginning.sample)
    columns, of_normals = _columns(beginning.header, separator, beginning.sample[0])
    body = data[beginning.start :]
    if decimal_comma:
        body = body.replace(b",", b".")
    rows = _parse(path, body, beginning.lines, separator, columns, of_normals)
    if beginning.promised is not None and len(rows) < beginning.promised:
        raise InputError(f"The scan {path} is cut off: its first line promises {beginning.promised} points, "
                         f"{len(rows)} are there.")
    return rows


def _text(path: Path) -> bytes:
    """The text in UTF-8, its lines ending as they do in Unix."""
    data = path.read_bytes()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = data.decode("utf-16", errors="replace").encode("utf-8", errors="replace")
    elif b"\x00" in data[:4096]:
        raise InputError(f"The scan {path} is not a text file of points: it contains binary data.")
    data = data.removeprefix(b"\xef\xbb\xbf")
    return data if b"\n" in data else data.replace(b"\r", b"\n")


def _beginning(data: bytes) -> _Beginning:
    """The header may be a comment itself ("//X Y Z"): the last line before the points that names x, y and z."""
    stream = io.BytesIO(data)
    header, promised = "", None
    sample: list[str] = []
    start = lines = place = 0
    for number, raw in enumerate(stream):
        place += len(raw)
        line = raw[:_LINE_START].decode("utf-8", errors="replace").strip()
        is_comment = line.startswith(_COMMENTS)
        if not sample and number < _HEADER_LINES and (is_comment or (line and not _starts_like_a_point(line))):
            names = line.lstrip("#/%! ")
            header = names if {"x", "y", "z"} <= set(_names(names)) else header
        elif line and not is_comment:
            sample.append(line)
        if not sample or (len(sample) == 1 and promised is None and _PROMISE.fullmatch(line)):
            promised = int(sample.pop()) if sample else promised
            start, lines = place, number + 1
        if len(sample) == _SAMPLE_LINES:
            break
    return _Beginning(header, promised, start, lines, sample)


def _starts_like_a_point(line: str) -> bool:
    first = re.split(r"[\s;,]+", line, maxsplit=1)[0].strip("\"'").lower()
    return first in _MISSING or _NUMBER.match(first) is not None


def _names(header: str) -> list[str]:
    """Lower-case column names, units and quotes removed: "X [mm]" is "x"."""
    fields = re.split(r"[;,\t]", header) if re.search(r"[;,\t]", header) else header.split()
    return [re.sub(r"[\[(].*|[\"']|_?(mm|cm)$", "", field.strip().lower()).strip() for field in fields]


def _layout(lines: list[str]) -> tuple[str | None, bool]:
    """(separator, decimal comma?); separator None stands for blanks and tabs."""
    sample = [line.strip() for line in lines[:200]]
    if any(";" in line for line in sample):
        return ";", not any("." in line for line in sample) and any("," in line for line in sample)
    if not any("," in line for line in sample):
        return None, False
    fields = [field for line in sample for field in line.split()]
    blank_separated = all(len(line.split()) >= 3 for line in sample)
    if blank_separated and all(_DECIMAL_COMMA.match(field) or _NUMBER.match(field) for field in fields):
        return None, True
    return ",", False


def _columns(header: str, separator: str | None, first: str) -> tuple[list[int], list[int]]:
    """Columns of x, y and z and those that may hold normals, by their names or by how many the first line has."""
    names = _names(header)
    if {"x", "y", "z"} <= set(names):
        return [names.index(axis) for axis in "xyz"], normals.columns(names)
    return [0, 1, 2], [3, 4, 5] if len(first.split(separator)) >= 6 else []


def _parse(path: Path, body: bytes, first: int, separator: str | None, columns: list[int],
           of_normals: list[int]) -> NDArray[np.float64]:
    """The rows of points that follow the ``first`` lines of the file."""
    with_comments = any(mark.encode() in body for mark in _COMMENTS)
    for wanted in ([*columns, *of_normals], columns):
        lines: Iterable[str] = io.TextIOWrapper(io.BytesIO(body), "utf-8", errors="replace")
        if with_comments:
            lines = (line for line in lines if not line.lstrip().startswith(_COMMENTS))
        try:
            return np.loadtxt(lines, delimiter=separator, usecols=wanted, ndmin=2, comments=None)
        except ValueError:
            continue
    return _parse_slowly(path, body, first, separator, columns)


def _parse_slowly(path: Path, body: bytes, first: int, separator: str | None,
                  columns: list[int]) -> NDArray[np.float64]:
    """Line by line: missing values become NaN, and the line of anything that is not a point is named."""
    values = array("d")
    last = max(columns)
    for number, line in enumerate(io.TextIOWrapper(io.BytesIO(body), "utf-8", errors="replace"), first + 1):
        if not line.strip() or line.lstrip().startswith(_COMMENTS):
            continue
        fields = line.split(separator, last + 1)
        if len(fields) <= last:
            raise InputError(f"The scan {path} is damaged or not a text file of points: line {number} has fewer than "
                             f"{last + 1} values.")
        values.extend(_number(path, fields[column].strip().strip("\"'"), number) for column in columns)
    return np.frombuffer(values, dtype=float).reshape(-1, len(columns))


def _number(path: Path, field: str, line_number: int) -> float:
    if field.lower() in _MISSING:
        return np.nan
    try:
        return float(field)
    except ValueError as error:
        raise InputError(f"The scan {path} is damaged or not a text file of points: line {line_number} has "
                         f"'{field[:30]}' instead of a number.") from error
