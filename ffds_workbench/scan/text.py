# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points as text: xyz, asc, txt, csv and pts, with whatever separator, header and decimal mark they come.

What is recognised: comment lines (``#``, ``//``, ``%``, ``!``), a header that names the columns, a first line with the
number of points (pts), separators blank, tab, comma and semicolon, a decimal comma where the separator is not a comma,
and missing values, which count as rows that are not finite. Normals are the columns named so or, where none are named,
the fourth to sixth; whether those are normals or colours, their numbers tell.
"""
from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from . import normals

_COMMENTS = ("#", "//", "%", "!")
_MISSING = {"", "-", "--", "nan", "null", "none", "n/a", "na", "nodata"}
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$|[-+]?(nan|inf|infinity)$", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?$")


def read(path: Path) -> NDArray[np.float64]:
    """The first three columns, or those named x, y and z, as the file holds them, (n, 3), or (n, 6) with normals.

    Raises
    ------
    InputError : not a text of points, or fewer points than its first line promises
    """
    numbered = [(number, line) for number, line in enumerate(_text(path).splitlines(), 1) if line.strip()]
    header, numbered = _split_header(numbered)
    promised = None
    if len(numbered) > 1 and numbered[0][1].strip().isdigit():
        promised = int(numbered[0][1])
        numbered = numbered[1:]
    if not numbered:
        raise InputError(f"The scan {path} is no text of points: no line starts with a number.")
    lines = [line for _, line in numbered]
    separator, decimal_comma = _layout(lines)
    columns, of_normals = _columns(header, separator, lines[0])
    if decimal_comma:
        lines = [line.replace(",", ".") for line in lines]
    rows = _parse(path, lines, [number for number, _ in numbered], separator, columns, of_normals)
    if promised is not None and len(rows) < promised:
        raise InputError(f"The scan {path} is cut off: its first line promises {promised} points, "
                         f"{len(rows)} are there.")
    return rows


def _text(path: Path) -> str:
    data = path.read_bytes()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", errors="replace")
    if b"\x00" in data[:4096]:
        raise InputError(f"The scan {path} is not a text of points: it holds binary data.")
    return data.decode("utf-8-sig", errors="replace")


def _split_header(numbered: list[tuple[int, str]]) -> tuple[str, list[tuple[int, str]]]:
    """The line that names the columns ("" without), and the lines of points; comments are dropped.

    The header may be a comment itself ("//X Y Z"): the last line before the points that names x, y and z.
    """
    header = ""
    first = len(numbered)
    for index, (_, line) in enumerate(numbered):
        stripped = line.strip()
        if stripped.startswith(_COMMENTS) or not _starts_like_a_point(stripped):
            names = _names(stripped.lstrip("#/%! "))
            if {"x", "y", "z"} <= set(names):
                header = stripped.lstrip("#/%! ")
            if index < 50:
                continue
        first = index
        break
    body = [(number, line) for number, line in numbered[first:] if not line.lstrip().startswith(_COMMENTS)]
    return header, body


def _starts_like_a_point(line: str) -> bool:
    first = re.split(r"[\s;,]+", line)[0].strip("\"'").lower()
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


def _parse(path: Path, lines: list[str], numbers: list[int], separator: str | None,
           columns: list[int], of_normals: list[int]) -> NDArray[np.float64]:
    for wanted in ([*columns, *of_normals], columns):
        try:
            return np.loadtxt(lines, delimiter=separator, usecols=wanted, ndmin=2, comments=None)
        except ValueError:
            continue
    return _parse_slowly(path, lines, numbers, separator, columns)


def _parse_slowly(path: Path, lines: list[str], numbers: list[int], separator: str | None,
                  columns: list[int]) -> NDArray[np.float64]:
    """Line by line: missing values become NaN, and what is no point is named with its line."""
    rows = np.empty((len(lines), 3))
    for row, (line, number) in enumerate(zip(lines, numbers, strict=True)):
        fields = [field.strip().strip("\"'") for field in line.split(separator)]
        if len(fields) <= max(columns):
            raise InputError(f"The scan {path} is damaged or no text of points: line {number} has fewer than "
                             f"{max(columns) + 1} values.")
        for axis, column in enumerate(columns):
            rows[row, axis] = _number(path, fields[column], number)
    return rows


def _number(path: Path, field: str, line_number: int) -> float:
    if field.lower() in _MISSING:
        return np.nan
    try:
        return float(field)
    except ValueError as error:
        raise InputError(f"The scan {path} is damaged or no text of points: line {line_number} holds "
                         f"'{field[:30]}' where a number belongs.") from error
