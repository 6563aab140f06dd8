# SPDX-License-Identifier: LGPL-2.1-or-later
"""FIELD.csv: ``x,y,z,dx,dy,dz`` and, where known, ``sigma``, in mm; ``#`` begins a comment.

A comment that is the name of a face alone, ``# Face6``, says on which face the rows after it lie; ``#`` alone ends it.
numpy's readers skip such comments and take one separator, and do not say which row is wrong: hence the one here.
"""
from __future__ import annotations

import re
from pathlib import Path
from typing import TextIO

import numpy as np

from ..errors import InputError
from ..output import replacing
from .field import VectorField

COLUMNS = ("x", "y", "z", "dx", "dy", "dz")
SIGMA = "sigma"
_FACE = re.compile(r"#\s*Face(\d+)\s*$")
_PARTED = re.compile(r"[,;\s]+")


def write_field(field: VectorField, path: str | Path) -> None:
    """Write a field (RefusedError where the disk is full)."""
    with replacing(Path(path)) as (temporary,), temporary.open("w", encoding="utf-8", newline="") as stream:
        _write(field, stream)


def _write(field: VectorField, stream: TextIO) -> None:
    columns = [field.positions, field.displacements]
    names = list(COLUMNS)
    if field.sigma is not None:
        columns.append(field.sigma[:, None])
        names.append(SIGMA)
    table = np.hstack(columns) + 0.0  # never -0
    stream.write(",".join(names) + "\n")
    faces = np.zeros(len(field), dtype=int) if field.faces is None else field.faces
    ends = [*(np.flatnonzero(np.diff(faces)) + 1).tolist(), len(field)]
    start = 0
    for end in ends:
        if faces[start] or start:
            stream.write(f"# Face{faces[start]}\n" if faces[start] else "#\n")
        np.savetxt(stream, table[start:end], "%.10g", ",")
        start = end


def read_field(path: str | Path) -> VectorField:
    """Read a field.

    Parameters
    ----------
    path : of the file

    Raises
    ------
    InputError : the file cannot be read, lacks a column, or a row does not hold its numbers
    """
    names, table, faces = read_table(Path(path), "field")
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        raise InputError(f"The field {path} has no column {missing[0]}: a field has x,y,z,dx,dy,dz and maybe sigma.")
    columns = [table[:, names.index(name)] for name in COLUMNS]
    sigma = table[:, names.index(SIGMA)] if SIGMA in names else None
    known = np.array(faces, dtype=np.intp)
    places, moves = (np.stack(three, axis=1) for three in (columns[:3], columns[3:]))
    return VectorField(places, moves, sigma, known if known.any() else None)


def read_table(path: Path, what: str, defaults: tuple[str, ...] = (*COLUMNS, SIGMA)
               ) -> tuple[list[str], np.ndarray, list[int]]:
    """Names of the columns, the rows (n, columns), and the face that a comment names for each, 0 for none.

    Parameters
    ----------
    path : of the file
    what : it is called in sentences
    defaults : names of the columns of a file without a header

    Raises
    ------
    InputError : the file cannot be read, holds no rows, or a row does not hold as many numbers as the first
    """
    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except OSError as error:
        raise InputError(f"The {what} {path} cannot be read: {error.strerror}.") from None
    except UnicodeDecodeError:
        raise InputError(f"The {what} {path} is no text: it is a table of numbers parted by commas.") from None
    names: list[str] = []
    rows: list[list[float]] = []
    faces: list[int] = []
    face = 0
    for number, line in enumerate(lines, 1):
        text = line.strip()
        if text.startswith("#"):
            found = _FACE.match(text)
            face = int(found[1]) if found else 0 if text == "#" else face
            continue
        parts = _PARTED.split(text.partition("#")[0].strip().strip(","))
        if parts == [""]:
            continue
        if not names:
            header = not _is_number(parts[0])
            names = [part.strip('"').lower() for part in parts] if header else list(defaults[: len(parts)])
            if header:
                continue
        rows.append(_row(parts, len(names), f"Row {number} of the {what} {path}"))
        faces.append(face)
    if not rows:
        raise InputError(f"The {what} {path} holds no rows of numbers.")
    return names, np.array(rows), faces


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _row(parts: list[str], count: int, where: str) -> list[float]:
    try:
        row = [float(part) for part in parts]
    except ValueError:
        raise InputError(f"{where} holds something else than numbers.") from None
    if len(row) != count:
        raise InputError(f"{where} holds {len(row)} numbers, and the first one {count}.")
    return row
