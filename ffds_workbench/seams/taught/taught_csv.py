# SPDX-License-Identifier: LGPL-2.1-or-later
"""A taught path as a CSV file: read, moved, and written with all its other columns as they were.

Columns are recognised by their names: x, y, z in mm, and for the orientation qx, qy, qz, qw or a, b, c (KUKA's angles,
in degrees). Without a header there are 3 (x, y, z), 6 (and a, b, c) or 7 columns (and qx, qy, qz, qw).
"""
from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from ...errors import InputError
from ...registration.arrays import Array
from ...scan.cloud import FARTHEST
from ..programs.angles import from_kuka_angles, kuka_angles
from .attach import Motion

_WITHOUT_HEADER = {3: "x y z", 6: "x y z a b c", 7: "x y z qx qy qz qw"}
_POSITION, _QUATERNION, _ANGLES = ("x", "y", "z"), ("qx", "qy", "qz", "qw"), ("a", "b", "c")
_DIRECTIONS = (("tx", "ty", "tz"), ("n1x", "n1y", "n1z"), ("n2x", "n2y", "n2z"))
_OF_THE_NOMINAL = ("gap", "band", "flag", "curvature", "work_angle", "lateral", "normal", "longitudinal",
                   "opening_angle", "torch_rotation", "opening")
"""Figures of a seam table that no longer hold; they are emptied."""


@dataclass(frozen=True)
class TaughtCsv:
    """The rows of a file as text.

    Attributes
    ----------
    names : of the columns, in lower case
    header : whether the file has them
    rows : all cells
    delimiter, decimal : as the file has them
    """

    names: tuple[str, ...]
    header: tuple[str, ...] | None
    rows: tuple[tuple[str, ...], ...]
    delimiter: str
    decimal: str

    @cached_property
    def positions(self) -> Array:
        """(n, 3) in mm."""
        return self._numbers(_POSITION)

    def moved(self, motion: Motion) -> str:
        """The file's text with all poses carried along."""
        cells = [list(row) for row in self.rows]
        after = motion.points(self.positions)
        self._put(cells, _POSITION, after, 6)
        for group in _DIRECTIONS:
            if set(group) <= set(self.names):
                self._put(cells, group, motion.vectors(self._numbers(group)), 9)
        if set(_QUATERNION) <= set(self.names):
            before = self._numbers(_QUATERNION)
            turned = Rotation.from_matrix(motion.vectors(Rotation.from_quat(before).as_matrix())).as_quat()
            same = np.einsum("ij,ij->i", turned, before) >= 0.0
            self._put(cells, _QUATERNION, np.where(same[:, None], turned, -turned), 9)
        elif set(_ANGLES) <= set(self.names):
            self._put(cells, _ANGLES, kuka_angles(motion.vectors(from_kuka_angles(self._numbers(_ANGLES)))), 6)
        if "s" in self.names:
            self._put(cells, ("s",), self._stretched(after)[:, None], 6)
        for name in set(_OF_THE_NOMINAL) & set(self.names):
            column = self.names.index(name)
            for row in cells:
                row[column : column + 1] = [""] * (column < len(row))
        stream = io.StringIO()
        writer = csv.writer(stream, delimiter=self.delimiter, lineterminator="\n")
        writer.writerows([*([self.header] if self.header else []), *cells])
        return stream.getvalue()

    def _stretched(self, after: Array) -> Array:
        """Arc lengths, each interval as much longer as its chord; starting anew where they fall back."""
        before = self._numbers(("s",))[:, 0]
        chords = [np.linalg.norm(np.diff(points, axis=0), axis=1) for points in (self.positions, after)]
        steps = np.diff(before) * np.divide(chords[1], chords[0], out=np.ones_like(chords[0]), where=chords[0] > 1e-9)
        result = before.copy()
        for i, step in enumerate(steps):
            result[i + 1] = result[i] + step if before[i + 1] > before[i] else before[i + 1]
        return result

    def _numbers(self, group: tuple[str, ...]) -> Array:
        columns = [self.names.index(name) for name in group]
        try:
            values = np.array([[float(row[column].replace(self.decimal, ".")) for column in columns]
                               for row in self.rows])
        except (ValueError, IndexError) as error:
            raise InputError(f"The path has a row without numbers for {', '.join(group)}.") from error
        if not (np.abs(values) < FARTHEST).all():
            raise InputError(f"The path has a row without finite numbers for {', '.join(group)}.")
        return values

    def _put(self, cells: list[list[str]], group: tuple[str, ...], values: Array, digits: int) -> None:
        columns = [self.names.index(name) for name in group]
        for row, numbers in zip(cells, values.tolist(), strict=True):
            for column, value in zip(columns, numbers, strict=True):
                row[column] = f"{round(value, digits) + 0.0:.{digits}f}".replace(".", self.decimal)


def read_csv(text: str) -> TaughtCsv:
    """Read the text of a CSV path; the cells are parted by comma, semicolon (decimal commas allowed) or tab.

    Raises
    ------
    InputError : there are no poses, or the columns are not told
    """
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not lines:
        raise InputError("The path is empty.")
    delimiter = max(";\t,", key=lambda mark: (mark in lines[0], -";\t,".index(mark)))
    try:
        rows = [tuple(cell.strip() for cell in row) for row in csv.reader(lines, delimiter=delimiter)]
    except csv.Error as error:
        raise InputError("The path is damaged: it has a cell that does not end.") from error
    decimal = "," if delimiter != "," and any("," in cell for row in rows[1:] for cell in row) else "."
    words = [cell for cell in rows[0] if any(map(str.isalpha, cell)) and not _is_number(cell, decimal)]
    header = rows[0] if words else None
    body = rows[1:] if header else rows
    names = tuple(cell.lower() for cell in header) if header else tuple(_WITHOUT_HEADER.get(len(rows[0]), "").split())
    if not set(_POSITION) <= set(names):
        raise InputError("The path's columns are not known: it needs a header with x, y and z, or 3, 6 or 7 columns.")
    if not body:
        raise InputError("The path has a header and no poses.")
    path = TaughtCsv(names, header, tuple(body), delimiter, decimal)
    if set(_QUATERNION) <= set(names) and np.linalg.norm(path._numbers(_QUATERNION), axis=1).min() < 0.5:
        raise InputError("The path has a row whose quaternion is zero.")
    return path


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(cell.replace(decimal, "."))
    except ValueError:
        return False
    return True
