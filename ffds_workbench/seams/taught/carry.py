# SPDX-License-Identifier: LGPL-2.1-or-later
"""A path taught on the nominal model, carried along to the as-built one: file in, file out."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import Part

from ...brep.model_files import Model
from ...errors import InputError
from ...output import check_writable, replacing
from ..offsets import check_pair
from ..programs.krl import NAME_LIMIT
from ..programs.moves import program_name
from ..weldment import Weldment
from .attach import Motion, motion
from .taught_csv import TaughtCsv, read_csv
from .taught_krl import TaughtKrl, renamed

FORMATS = (".csv", ".src", ".dat")


@dataclass(frozen=True)
class CarriedPath:
    """A path that was carried along.

    Attributes
    ----------
    poses : number of poses
    left : how many were too far from the model and stay where they were
    largest_shift : in mm; ``largest_turn``: in rad
    """

    poses: int
    left: int
    largest_shift: float
    largest_turn: float

    def table(self) -> str:
        """In words."""
        left = f"; {self.left} too far from the model to move with it, left where they were" if self.left else ""
        return (f"{self.poses} poses carried along: moved by up to {self.largest_shift:.3f} mm, turned by up to "
                f"{np.degrees(self.largest_turn):.3f}°{left}.")


def carry(nominal: Model | Part.Shape | object, as_built: Model | Part.Shape | object, path: Path, out: Path,
          inputs: Sequence[Path] = ()) -> CarriedPath:
    """Carry a CSV or KRL path along and write it in its own format; a .src takes its .dat with it.

    Parameters
    ----------
    nominal, as_built : models, shapes or document objects
    path, out : files of the same format
    inputs : files that were read and must not be written over

    Raises
    ------
    InputError : the path cannot be read, or the models are no pair
    RefusedError : the path is nowhere near the model, or the disk is full
    """
    sources, targets = _files(Path(path), Path(out))
    for target in targets:
        check_writable(target, (*inputs, *sources))
    taught = _read(sources)
    before, after = Weldment.of(nominal), Weldment.of(as_built)
    check_pair(before, after)
    moved = motion(before, after, taught.positions)
    with replacing(*targets) as temporary:
        for file, text in zip(temporary, _texts(taught, moved, path, out), strict=True):
            file.write_bytes(text.encode("utf-8" if isinstance(taught, TaughtCsv) else "latin-1"))
    shifts = np.linalg.norm(moved.points(taught.positions) - taught.positions, axis=1)
    cosines = np.clip(0.5 * (np.trace(moved.rotation, axis1=1, axis2=2) - 1.0), -1.0, 1.0)
    return CarriedPath(len(shifts), int((~moved.held).sum()), float(shifts.max()), float(np.arccos(cosines).max()))


def _files(path: Path, out: Path) -> tuple[list[Path], list[Path]]:
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise InputError(f"The path {path} is of an unknown format: use .csv, or .src and .dat of a KUKA.")
    if out.suffix.lower() != suffix:
        name = out.with_suffix(suffix).name
        raise InputError(f"The path is carried along in its own format: name the output {name}.")
    data = path.with_suffix(".dat")
    if suffix == ".src" and data.exists():
        return [path, data], [out, out.with_suffix(".dat")]
    return [path], [out]


def _read(sources: Sequence[Path]) -> TaughtCsv | TaughtKrl:
    try:
        contents = [source.read_bytes() for source in sources]
    except OSError as error:
        raise InputError(f"The path {sources[0]} cannot be read: {error.strerror}.") from error
    if sources[0].suffix.lower() != ".csv":
        return TaughtKrl(tuple(content.decode("latin-1") for content in contents))
    try:
        return read_csv(contents[0].decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise InputError(f"The path {sources[0]} is no text.") from error


def _texts(taught: TaughtCsv | TaughtKrl, moved: Motion, path: Path, out: Path) -> tuple[str, ...]:
    if isinstance(taught, TaughtCsv):
        return (taught.moved(moved),)
    return tuple(renamed(text, path.stem, program_name(out.stem, NAME_LIMIT)) for text in taught.moved(moved))
