# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs on the disk: one file for what was asked, one folder for what became of it; both appear whole."""
from __future__ import annotations

import json
import os
import re
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..registration.joint import SensorProfile
from ..registration.request import RegistrationRequest
from ..scan.sensor_profile import PRESETS
from ..scan.units import MILLIMETRES
from ..series import folder as layout
from ..series.setup import Outcome, PartJob, SeriesLimits, SeriesSetup

_ID = re.compile(r"[0-9]{14}-[0-9a-f]{16}")
_OPTIONS = ("faces", "freeze", "method", "lattice", "source_points", "isometry", "stiffness", "gate", "sensor", "align")
_LISTS = ("faces", "freeze", "lattice")
_NUMBERS = ("source_points", "stiffness", "gate")
_FACES = ("faces", "freeze")
_RESULTS, _WANTED = "results", "jobs"


@dataclass(frozen=True)
class ServeJob(PartJob):
    """A part, and how it is to be registered."""

    setup: SeriesSetup


class Jobs:
    """All jobs of a server.

    Parameters
    ----------
    folder : where they are kept; made where it is missing
    limits : what one job may take
    """

    def __init__(self, folder: Path, limits: SeriesLimits) -> None:
        self._wanted, self.results, self._limits = folder / _WANTED, folder / _RESULTS, limits
        self._wanted.mkdir(parents=True, exist_ok=True)
        layout.make(self.results)
        layout.clear_work(self.results)

    def add(self, model: Path, scan: Path, options: Mapping[str, Any]) -> ServeJob:
        """Keep a new job (InputError where the options make no sense)."""
        name = f"{time.strftime('%Y%m%d%H%M%S', time.gmtime())}-{secrets.token_hex(8)}"
        record = {"model": str(model.absolute()), "scan": str(scan.absolute()), "options": dict(options)}
        job = self._job(name, record)
        temporary = self._wanted / f".{name}.tmp"
        layout.write_whole(temporary, record)
        os.replace(temporary, self._wanted / f"{name}.json")
        return job

    def get(self, name: str) -> tuple[ServeJob, Outcome | None]:
        """A job, and what became of it, None while it is not done (KeyError where there is no such job)."""
        path = self._wanted / f"{name}.json"
        if not _ID.fullmatch(name) or not path.is_file():
            raise KeyError(name)
        return self._job(name, json.loads(path.read_text("utf-8"))), layout.outcome(self.results, name)

    def names(self) -> list[str]:
        """All jobs, the oldest first."""
        return sorted(path.stem for path in self._wanted.glob("*.json") if _ID.fullmatch(path.stem))

    def open_ones(self) -> list[ServeJob]:
        """Jobs that are not done."""
        return [job for job, found in map(self.get, self.names()) if found is None]

    def files(self, name: str) -> dict[str, Path]:
        """What came of a job, by name."""
        folder = self.results / name
        if not _ID.fullmatch(name) or not folder.is_dir():
            return {}
        return {path.name: path for path in sorted(folder.iterdir()) if path.is_file() and not path.is_symlink()}

    def _job(self, name: str, record: Mapping[str, Any]) -> ServeJob:
        request, unit = read_options(record["options"])
        setup = SeriesSetup(Path(record["model"]), None, unit, request, self.results.absolute(), self._limits,
                            checked=False)
        return ServeJob(Path(record["scan"]), name, setup)


def read_options(options: Mapping[str, Any]) -> tuple[RegistrationRequest, str]:
    """A request and the scan's unit out of JSON; nothing in it names a file.

    Raises
    ------
    InputError : an option is unknown or makes no sense
    """
    plain = dict(options)
    unit = plain.pop("scan_unit", "mm")
    if unit not in MILLIMETRES:
        raise InputError(f"The scan unit is unknown: use one of {', '.join(MILLIMETRES)}.")
    unknown = sorted(set(plain) - set(_OPTIONS))
    if unknown:
        raise InputError(f"There is no option '{unknown[0][:40]}': use {', '.join((*_OPTIONS, 'scan_unit'))}.")
    plain = {name: value for name, value in plain.items() if value is not None}
    for name, value in plain.items():
        _check(name, value)
    for name in _LISTS:
        if isinstance(plain.get(name), list):
            plain[name] = tuple(plain[name])
    if "sensor" in plain:
        plain["sensor"] = _sensor(plain["sensor"])
    return RegistrationRequest(**plain), unit


def _check(name: str, value: Any) -> None:
    """Refuse a value that is not of its kind."""
    kind: Any = str
    if name in _FACES:
        kind = list
        sound = isinstance(value, list) and all(isinstance(item, str) for item in value)
    elif name in _NUMBERS:
        whole = name == "source_points"
        sound = isinstance(value, int if whole else (int, float)) and not isinstance(value, bool)
    elif name == "lattice":
        sound = value == "auto" or (isinstance(value, list) and len(value) == 2 and all(
            isinstance(item, int) and not isinstance(item, bool) for item in value))
    else:
        sound = isinstance(value, kind)
    if not sound:
        raise InputError(f"The option '{name}' has a value of the wrong kind.")


def _sensor(name: str) -> SensorProfile:
    if name not in PRESETS:
        raise InputError(f"The sensor is unknown: use one of {', '.join(PRESETS)}.")
    return PRESETS[name]
