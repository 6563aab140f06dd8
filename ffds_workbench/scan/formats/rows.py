# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of numbers as PLY and PCD files hold them.

What a header promises is held against the size of the file before any memory is set aside for it.
"""
from __future__ import annotations

import io
import re
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError

Array = NDArray[np.float64]


def count_of(word: str) -> int:
    """A number of rows as headers have them: digits alone, and no more than a file can hold (ValueError)."""
    if re.fullmatch("[0-9]{1,18}", word) is None:
        raise ValueError(f"{word[:20]} is no number of rows")
    return int(word)


def binary(path: Path, data: bytes, start: int, count: int, stride: int, fields: Sequence[tuple[int, str]]) -> Array:
    """Some numbers of each of ``count`` rows of ``stride`` bytes, the first of them at ``start``.

    Parameters
    ----------
    fields : place in the row, in bytes, and type of each number that is wanted

    Returns
    -------
    (count, len(fields))

    Raises
    ------
    InputError : there are fewer rows
    """
    found = max(0, len(data) - start) // stride
    if found < count:
        raise truncated(path, count, found)
    result = np.empty((count, len(fields)))
    for column, (place, kind) in enumerate(fields):
        result[:, column] = np.ndarray((count,), kind, data, start + place, (stride,))
    return result


def text(path: Path, data: bytes, start: int, count: int, width: int, columns: Sequence[int], skip: int = 0) -> Array:
    """Some columns of ``count`` rows of ``width`` numbers parted by blanks, after ``skip`` other lines.

    Returns
    -------
    (count, len(columns))

    Raises
    ------
    InputError : there are fewer rows, or what is there is no number
    """
    body = _whole_rows(data[start:], width)
    shortest = 2 * width
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # "input contained no data"
            rows = np.loadtxt(io.TextIOWrapper(io.BytesIO(body), "latin-1"), usecols=columns, ndmin=2, comments=None,
                              skiprows=min(skip, len(body)), max_rows=min(count, len(body) // shortest + 1))
    except ValueError as error:
        raise InputError(f"The scan {path} is damaged: a point is not made of numbers.") from error
    if len(rows) < count:
        raise truncated(path, count, len(rows))
    return rows


def _whole_rows(body: bytes, width: int) -> bytes:
    """Without the last line where that is cut off."""
    body = body.rstrip()
    end = max(body.rfind(b"\n"), body.rfind(b"\r"))
    return body if len(body[end + 1 :].split(None, width)) >= width else body[: max(end, 0)]


def truncated(path: Path, promised: int, found: int) -> InputError:
    """What is said of a file with fewer points than its header promises."""
    return InputError(f"The scan {path} is cut off: its header promises {promised} points, {found} are there.")
