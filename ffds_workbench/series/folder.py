# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a series keeps what it has: a folder for each part that appears whole, by a rename, and stays.

``DIR/NAME/part.json`` is what became of a part; once it is there, the part is done. All else (the index, series.json,
the page) can be made of these anew.
"""
from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

from ..errors import InputError, RefusedError
from .setup import Outcome

PART, REPORT, FIELD, AS_BUILT = "part.json", "report.json", "field.npz", "as_built.step"
PLACES, SERIES, MEAN, PAGE, INDEX = "places.npz", "series.json", "mean_field.csv", "index.html", "index.sqlite"
_WORK, _LOCK = ".work", ".lock"
TAKEN = {PLACES, SERIES, MEAN, PAGE, INDEX, "modes.csv", "parts.csv"}
"""Names in the folder of a series that no part may have."""


def make(folder: Path) -> None:
    """Make the folder of a series (InputError where that cannot be)."""
    try:
        work_folder(folder).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"The output folder {folder} cannot be made: {error.strerror or error}.") from error


def locked(folder: Path) -> TextIO | None:
    """Keep others from working on the same series while the returned file is open; None where there are no locks.

    Raises
    ------
    InputError : another process works on it
    """
    try:
        import fcntl
    except ImportError:
        return None
    stream = (folder / _LOCK).open("w")
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        stream.close()
        raise InputError(f"Another process works on the series in {folder}: wait for it, or end it.") from error
    return stream


def work_folder(folder: Path) -> Path:
    """Where parts are made before they are there."""
    return folder / _WORK


def clear_work(folder: Path) -> None:
    """Take away what interrupted parts have left."""
    shutil.rmtree(work_folder(folder), ignore_errors=True)


def outcome(folder: Path, name: str) -> Outcome | None:
    """What became of a part; None where it is not done."""
    try:
        return Outcome.from_dict(json.loads((folder / name / PART).read_text("utf-8")))
    except (OSError, ValueError, TypeError, KeyError):
        return None


def deliver(folder: Path, found: Outcome, make_files: Callable[[Path], None] = lambda path: None) -> Outcome:
    """Put a part's folder into its place, all of it or nothing; what was there first stays.

    Parameters
    ----------
    folder : of the series
    found : what became of the part
    make_files : writes the part's files into the folder that it is given

    Returns
    -------
    what stands: ``found``, or what another process had delivered before

    Raises
    ------
    RefusedError : the disk is full, or the folder cannot be written
    """
    try:
        work_folder(folder).mkdir(exist_ok=True)
        making = Path(tempfile.mkdtemp(prefix=f"{found.name}-", dir=work_folder(folder)))
        try:
            make_files(making)
            write_whole(making / PART, found.as_dict())
            making.chmod(0o755)  # mkdtemp lets nobody else look
            return _placed(making, folder, found)
        finally:
            shutil.rmtree(making, ignore_errors=True)
    except OSError as error:
        raise RefusedError(f"{folder / found.name} could not be written: {error.strerror or error}.") from error


def _placed(making: Path, folder: Path, found: Outcome) -> Outcome:
    """Rename a finished folder into its place."""
    place = folder / found.name
    with suppress(OSError):
        os.rename(making, place)
        return found
    standing = outcome(folder, found.name)
    if standing is None:  # the place is taken by something that is no part
        raise OSError(0, f"{place} is in the way")
    return standing


def write_whole(path: Path, record: dict[str, Any]) -> None:
    """Write JSON that is on the disk when this returns."""
    with path.open("w", encoding="utf-8") as stream:
        json.dump(record, stream, indent=1, ensure_ascii=False, allow_nan=False)
        stream.write("\n")
        stream.flush()
        os.fsync(stream.fileno())
