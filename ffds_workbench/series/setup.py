# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all parts of a series have in common, and what becomes of one. Travels between processes; loads little."""
from __future__ import annotations

import hashlib
import math
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from ..errors import InputError
from ..registration.request import RegistrationRequest

REFUSED = 3


@dataclass(frozen=True)
class SeriesLimits:
    """What one part may take; a part that takes more is refused.

    Attributes
    ----------
    seconds : from the moment a process takes it up
    memory : of the process that registers it, in bytes; None for its share of the machine

    Raises
    ------
    InputError : a limit is not above 0
    """

    seconds: float = 900.0
    memory: float | None = None

    def __post_init__(self) -> None:
        for value in (self.seconds, self.memory):
            if value is not None and not (math.isfinite(value) and value > 0):
                raise InputError(f"A limit of {value:g} for a part makes no sense: give one above 0.")


@dataclass(frozen=True)
class SeriesSetup:
    """What all parts of a series have in common.

    Attributes
    ----------
    model : file of the nominal model
    label : of the object in a FreeCAD document that holds several
    scan_unit : of the scans: "mm", "cm", "m" or "in"
    request : how every part is registered
    folder : where all results go
    limits : what one part may take
    plan : file of the inspection plan that every part is held against, or None
    checked : whether model and request have been found sound; else what is wrong with them is the parts' own refusal
    """

    model: Path
    label: str | None
    scan_unit: str
    request: RegistrationRequest
    folder: Path
    limits: SeriesLimits = SeriesLimits()
    plan: Path | None = None
    checked: bool = True

    def digest(self) -> str:
        """Of all that a result depends on: the model's content, the plan's, and how parts are registered."""
        told = repr((self.label, self.scan_unit, self.request)).encode()
        for path in (self.model, self.plan):
            told += b"\0" + (b"" if path is None else path.read_bytes())
        return hashlib.sha256(told).hexdigest()

    def absolute(self) -> SeriesSetup:
        """The same for processes that work elsewhere."""
        return replace(self, model=self.model.absolute(), folder=self.folder.absolute(),
                       plan=None if self.plan is None else self.plan.absolute())


@dataclass(frozen=True)
class PartJob:
    """One part: its scan and the name of its folder."""

    scan: Path
    name: str


@dataclass(frozen=True)
class Outcome:
    """What became of a part.

    Attributes
    ----------
    scan, name : of the part
    exit : 0 registered, 2 its scan cannot be read, 3 refused
    said : one sentence on why there is no result; empty for a result
    seconds : it took
    final : whether this stands; what died of the machine is to be tried again
    memory : of the process after the part, in bytes; 0 where that is not known
    """

    scan: Path
    name: str
    exit: int
    said: str = ""
    seconds: float = 0.0
    final: bool = True
    memory: float = 0.0

    def as_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        return asdict(self) | {"scan": str(self.scan)}

    @staticmethod
    def from_dict(record: dict[str, Any]) -> Outcome:
        """What `as_dict` made a record of (TypeError or KeyError where it is none)."""
        return replace(Outcome(**record), scan=Path(record["scan"]))
