# SPDX-License-Identifier: LGPL-2.1-or-later
"""Output files that appear complete or not at all.

Everything is written beside its destination under a temporary name, flushed to the disk, and moved into place only
when all of it is there: a failure, a full disk or an interruption leaves earlier files as they were.
"""
from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError, RefusedError


def check_writable(path: Path, inputs: Sequence[Path] = ()) -> None:
    """Refuse a destination early, before any work is spent on it.

    Raises
    ------
    InputError : the folder is missing or cannot be written, the path is a folder, or it is one of the inputs
    """
    folder = path.parent
    if path.is_dir():
        raise InputError(f"The output {path} is a folder: name a file.")
    if not folder.is_dir():
        raise InputError(f"The output folder {folder} does not exist.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"The output folder {folder} cannot be written.")
    if path.exists() and any(item.exists() and item.samefile(path) for item in inputs):
        raise InputError(f"The output {path} is also an input: choose another name.")


@contextmanager
def replacing(*paths: Path) -> Iterator[list[Path]]:
    """Temporary names to write to, one per path and with its suffix; all move into place at the end, or none.

    Raises
    ------
    RefusedError : a file could not be written, for instance because the disk is full
    """
    temporary = [path.with_name(f".{path.stem}.{os.getpid()}.tmp{path.suffix}") for path in paths]
    try:
        yield temporary
        for path in temporary:
            with path.open("rb+") as stream:
                os.fsync(stream.fileno())
        for path, destination in zip(temporary, paths, strict=True):
            os.replace(path, destination)
    except OSError as error:
        names = ", ".join(str(path) for path in paths)
        raise RefusedError(f"{names} could not be written: {error.strerror or error}.") from error
    finally:
        for path in temporary:
            path.unlink(missing_ok=True)
