# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which files the parts of a series are: files, folders, patterns and lists, in an order that one can foresee.

A list is a text file with the name of a scan in each line. Where its first line begins with ``scan``, it is a table
(CSV), and its further columns are labels: cavity, fixture, time.
"""
from __future__ import annotations

import csv
import glob
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import InputError
from ..scan.files import FORMATS

_LISTS = (".lst", ".list", ".txt", ".csv")
_FIRST_LINE = 4096


@dataclass(frozen=True)
class ScanFile:
    """The scan of one part, and what is known of the part."""

    path: Path
    labels: Mapping[str, str] = field(default_factory=dict)


def find_scans(wanted: Sequence[str | Path]) -> list[ScanFile]:
    """The scans of a series, each once.

    Parameters
    ----------
    wanted : scan files, folders of them, patterns such as ``scans/*.ply``, and lists

    Raises
    ------
    InputError : one of them is not there, or holds no scan
    """
    found: dict[Path, ScanFile] = {}
    for item in wanted:
        some = list(_expanded(Path(item)))
        if not some:
            raise InputError(f"{item} holds no scan: scans end in {' '.join(FORMATS)}.")
        for scan in some:
            found.setdefault(scan.path.absolute(), scan)
    return list(found.values())


def scans_in(folder: Path) -> list[Path]:
    """The scan files of a folder, by name, part2 before part10; hidden ones are none."""
    return sorted((path for path in folder.iterdir() if path.suffix.lower() in FORMATS and path.is_file()
                   and not path.name.startswith(".")), key=_natural)


def _expanded(path: Path) -> Iterator[ScanFile]:
    if path.is_dir():
        yield from (ScanFile(file) for file in scans_in(path))
    elif not path.exists():
        matches = sorted(map(Path, glob.glob(str(path), recursive=True)), key=_natural)
        if not matches:
            raise InputError(f"The scan {path} does not exist.")
        yield from (ScanFile(match) for match in matches if match.suffix.lower() in FORMATS)
    elif _is_list(path):
        yield from _listed(path)
    else:
        yield ScanFile(path)


def _natural(path: Path) -> list[tuple[int, int, str]]:
    """Numbers in names count as numbers."""
    return [(0, int(piece), "") if piece.isdigit() else (1, 0, piece) for piece in re.split(r"(\d+)", str(path))]


def _is_list(path: Path) -> bool:
    """Whether a text file names scans; one with coordinates is a scan itself."""
    suffix = path.suffix.lower()
    if suffix not in _LISTS:
        return False
    if suffix not in FORMATS:
        return True
    with path.open("rb") as stream:
        first = next((line for line in stream.read(_FIRST_LINE).splitlines() if line.strip()
                      and not line.startswith(b"#")), b"").decode("utf-8", "replace").strip()
    return first.split(",")[0].strip() == "scan" or Path(first.split(",")[0]).suffix.lower() in FORMATS


def _listed(path: Path) -> Iterator[ScanFile]:
    try:
        lines = [line for line in path.read_text("utf-8-sig").splitlines() if line.strip() and line[0] != "#"]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"The list {path} cannot be read: write it as plain text (UTF-8).") from error
    heads = [head.strip() for head in lines[0].split(",")] if lines else []
    if heads[:1] == ["scan"]:
        rows = [dict(zip(heads, map(str.strip, row), strict=False)) for row in csv.reader(lines[1:])]
    else:
        rows = [{"scan": line.strip()} for line in lines]
    for row in rows:
        name = Path(row.pop("scan"))
        scan = name if name.is_absolute() or not (path.parent / name).exists() else path.parent / name
        if not scan.is_file():
            raise InputError(f"The list {path} names {name}, which does not exist.")
        yield ScanFile(scan, {key: value for key, value in row.items() if value})
