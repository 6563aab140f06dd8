# SPDX-License-Identifier: LGPL-2.1-or-later
"""What several commands do with their outputs: a folder for them, and the lines that say what was written."""
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError

if TYPE_CHECKING:
    from ..report.file_certificate import FileCertificate


def make_folder(path: Path) -> Path:
    """The folder, made where it is missing (InputError where that cannot be)."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"The output folder {path} cannot be made: {error.strerror}.") from error
    return path


def written(*paths: Path | None) -> str:
    """The line that names the files that were written; empty without any."""
    names = [str(path) for path in paths if path is not None]
    return f"Written: {', '.join(names)}" if names else ""


def read_back(certificate: FileCertificate) -> str:
    """What a written model is as it reads back, and the notes on it."""
    return "\n".join([certificate.line(), *(f"Note: {note}" for note in certificate.notes)])
