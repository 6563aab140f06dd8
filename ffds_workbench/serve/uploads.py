# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that are sent in: on the disk under the name of their content when all of it is there, and not before."""
from __future__ import annotations

import hashlib
import os
import re
import shutil
import tempfile
from collections.abc import AsyncIterator
from pathlib import Path

from ..brep.model_files.reading import FORMATS as MODELS
from ..errors import InputError
from ..scan.files import FORMATS as SCANS

_NAME = re.compile(r"[0-9a-f]{64}\.[a-z0-9]{2,5}")
_PARTS = "incoming"


class TooLargeError(InputError):
    """A file is larger than what is taken."""


class Uploads:
    """The files that were sent in.

    Parameters
    ----------
    folder : where they are kept; made where it is missing
    limit : bytes of the largest file that is taken
    """

    def __init__(self, folder: Path, limit: int) -> None:
        self._folder, self._limit = folder, limit
        shutil.rmtree(folder / _PARTS, ignore_errors=True)  # what was broken off
        (folder / _PARTS).mkdir(parents=True)

    async def take(self, suffix: str, expected: int | None, body: AsyncIterator[bytes]) -> tuple[str, int]:
        """Take a file in; its name here, and its bytes.

        Parameters
        ----------
        suffix : of its format, with the dot
        expected : bytes that were promised, or None
        body : its content

        Raises
        ------
        InputError : the format is unknown, or fewer or more bytes came than were promised
        TooLargeError : there is too much of it
        OSError : the disk is full
        """
        suffix = suffix.lower()
        if suffix not in (*MODELS, *SCANS):
            raise InputError(f"Files that end in '{suffix[:10]}' are neither models nor scans.")
        if expected is not None and expected > self._limit:
            raise TooLargeError(f"The file is larger than {self._limit / 1e6:.0f} MB, which is the limit.")
        descriptor, name = tempfile.mkstemp(dir=self._folder / _PARTS)
        known, size = hashlib.sha256(), 0
        try:
            with os.fdopen(descriptor, "wb") as stream:
                async for piece in body:
                    size += len(piece)
                    if size > self._limit:
                        raise TooLargeError(f"The file is larger than {self._limit / 1e6:.0f} MB, which is the limit.")
                    known.update(piece)
                    stream.write(piece)
                stream.flush()
                os.fsync(stream.fileno())
            if size == 0 or (expected is not None and size != expected):
                raise InputError(f"{size} bytes of {expected or 'a file'} came: send it again.")
            final = f"{known.hexdigest()}{suffix}"
            os.replace(name, self._folder / final)
            return final, size
        finally:
            Path(name).unlink(missing_ok=True)

    def path(self, name: object, kinds: tuple[str, ...]) -> Path:
        """Where a file is that was sent in (InputError where there is none, or it is not one of the formats)."""
        if not isinstance(name, str) or not _NAME.fullmatch(name) or not (self._folder / name).is_file():
            raise InputError("There is no such file: send it first, and give the name that the answer has.")
        if Path(name).suffix not in kinds:
            raise InputError(f"A file that ends in {Path(name).suffix} cannot be used here: use one of "
                             f"{' '.join(kinds)}.")
        return self._folder / name
