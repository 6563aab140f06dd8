# SPDX-License-Identifier: LGPL-2.1-or-later
"""The table of a series' parts, in SQLite: what other tools query, and what keeps the names of folders.

``parts(number, scan, name, labels, exit, said, seconds)``: exit is NULL while a part is not done. What stands in the
folders counts; the table follows them.
"""
from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ..errors import InputError
from .folder import TAKEN
from .scans import ScanFile
from .setup import Outcome, PartJob

_TABLES = """
CREATE TABLE IF NOT EXISTS about (name TEXT PRIMARY KEY, value TEXT);
CREATE TABLE IF NOT EXISTS parts (number INTEGER PRIMARY KEY, scan TEXT UNIQUE NOT NULL, name TEXT UNIQUE NOT NULL,
    labels TEXT NOT NULL, exit INTEGER, said TEXT NOT NULL DEFAULT '', seconds REAL NOT NULL DEFAULT 0);
"""
_AT_ONCE = 100
"""Outcomes that are written to the disk together: one that is lost is in its folder all the same."""


class PartIndex:
    """The table of a series' parts.

    Parameters
    ----------
    path : of the file; made where it is missing

    Raises
    ------
    InputError : the file is no such table
    """

    def __init__(self, path: Path) -> None:
        self._connection = sqlite3.connect(path, isolation_level=None)
        self._waiting: list[tuple[int, str, float, str]] = []
        try:
            self._connection.executescript(f"PRAGMA synchronous = NORMAL; {_TABLES}")
        except sqlite3.DatabaseError as error:
            raise InputError(f"{path} is no index of a series ({error}): take it away and resume.") from error

    def close(self) -> None:
        """Write what waits and let go of the file."""
        self.flush()
        self._connection.close()

    def about(self, name: str) -> str | None:
        """A value that was kept."""
        row = self._connection.execute("SELECT value FROM about WHERE name = ?", (name,)).fetchone()
        return None if row is None else str(row[0])

    def keep(self, name: str, value: str) -> None:
        """Keep a value."""
        self._connection.execute("INSERT OR REPLACE INTO about VALUES (?, ?)", (name, value))

    def add(self, scans: Iterable[ScanFile]) -> list[PartJob]:
        """Give every scan that is new a name; the jobs of those that are new and of those that are not done."""
        wanted = list(scans)
        known = dict(self._connection.execute("SELECT scan, name FROM parts"))
        names = set(known.values()) | TAKEN
        rows = []
        for scan in wanted:
            if str(scan.path.absolute()) not in known:
                name = _free_name(scan.path, names)
                names.add(name)
                known[str(scan.path.absolute())] = name
                rows.append((str(scan.path.absolute()), name, json.dumps(scan.labels, ensure_ascii=False)))
        self._connection.execute("BEGIN")
        self._connection.executemany("INSERT INTO parts (scan, name, labels) VALUES (?, ?, ?)", rows)
        self._connection.execute("COMMIT")
        open_ones = {row[0] for row in self._connection.execute("SELECT scan FROM parts WHERE exit IS NULL")}
        return [PartJob(Path(path), known[path]) for scan in wanted if (path := str(scan.path.absolute())) in open_ones]

    def record(self, found: Outcome) -> None:
        """Note what became of a part."""
        self._waiting.append((found.exit, found.said, found.seconds, found.name))
        if len(self._waiting) >= _AT_ONCE:
            self.flush()

    def flush(self) -> None:
        """Write what waits."""
        self._connection.execute("BEGIN")
        self._connection.executemany("UPDATE parts SET exit = ?, said = ?, seconds = ? WHERE name = ?", self._waiting)
        self._connection.execute("COMMIT")
        self._waiting.clear()

    def forget(self, names: Sequence[str]) -> None:
        """Mark parts as not done."""
        self._connection.executemany("UPDATE parts SET exit = NULL WHERE name = ?", [(name,) for name in names])

    def parts(self) -> list[tuple[Outcome, Mapping[str, str]]]:
        """All parts that are done, in the order in which they were added, with their labels."""
        self.flush()
        rows = self._connection.execute("SELECT scan, name, exit, said, seconds, labels FROM parts "
                                        "WHERE exit IS NOT NULL ORDER BY number")
        return [(Outcome(Path(scan), name, code, said, seconds), json.loads(labels))
                for scan, name, code, said, seconds, labels in rows]

    def names(self) -> list[tuple[str, int | None]]:
        """Name and exit code, None where it is not done, of all parts."""
        self.flush()
        return list(self._connection.execute("SELECT name, exit FROM parts ORDER BY number"))


def _free_name(path: Path, taken: set[str]) -> str:
    """A name for the folder of a scan's part: the file's own, with a number where that is taken."""
    stem = path.stem.lstrip(".") or "part"
    name, number = stem, 1
    while name in taken:
        number += 1
        name = f"{stem}_{number}"
    return name
