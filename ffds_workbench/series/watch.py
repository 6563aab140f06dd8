# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a scanner drops into a folder: a file is taken when it has not changed from one look to the next."""
from __future__ import annotations

from pathlib import Path

from ..errors import InputError
from .scans import ScanFile, scans_in

STOP = "STOP"
"""A file of this name in the watched folder ends the series."""


class Watch:
    """A folder that is looked at again and again.

    Parameters
    ----------
    folder : of the files

    Raises
    ------
    InputError : there is no such folder
    """

    def __init__(self, folder: Path) -> None:
        if not folder.is_dir():
            raise InputError(f"The folder {folder} that is to be watched does not exist.")
        self._folder = folder
        self._seen: dict[Path, tuple[int, int]] = {}
        self._taken: set[Path] = set()

    def new(self) -> list[ScanFile]:
        """Files that are there whole since the last look: their size and their time are still the same."""
        found = []
        for path in scans_in(self._folder):
            if path in self._taken:
                continue
            try:
                about = path.stat()
            except FileNotFoundError:
                continue  # a scanner renames what it has finished
            state = about.st_size, about.st_mtime_ns
            if about.st_size and self._seen.get(path) == state:
                self._taken.add(path)
                found.append(ScanFile(path))
            self._seen[path] = state
        return found

    @property
    def ended(self) -> bool:
        """Whether nothing more will come."""
        return (self._folder / STOP).exists()
