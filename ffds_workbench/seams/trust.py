# SPDX-License-Identifier: LGPL-2.1-or-later
"""How certain a seam is: observed or inferred, and its 95 % band, from the registration's report."""
from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..registration.arrays import Array
from ..report import record
from .chains import Stretch
from .stations import Stations

FLAGS = ("observed", "bridged", "carried", "nominal")
"""From the best to the worst. Without a report everything is "nominal": nothing is known of a scan."""


@dataclass(frozen=True)
class _Entry:
    flag: str
    band: float


@dataclass(frozen=True)
class Trust:
    """Flags and bands of faces and edges by name."""

    entries: Mapping[str, _Entry]

    def along(self, stations: Stations) -> tuple[Array, Array]:
        """Flag (n,) and 95 % band in mm (n,) at each station; NaN where the report has none."""
        known = [self._of(stretch) for stretch in stations.seam.stretches]
        flags, bands = np.array([entry.flag for entry in known]), np.array([entry.band for entry in known])
        return flags[stations.places.stretch], bands[stations.places.stretch]

    def band(self, name: str) -> float:
        """Of a face or an edge in mm, NaN where the report has none."""
        return self.entries.get(name, _UNKNOWN).band

    def _of(self, stretch: Stretch) -> _Entry:
        """The edge's own entry. Where parts meet, one face of the edge is covered: the joined faces count too."""
        faces = [self.entries.get(f"Face{face + 1}", _UNKNOWN) for face in stretch.faces]
        joined = _Entry(max((entry.flag for entry in faces), key=FLAGS.index), max(entry.band for entry in faces))
        own = self.entries.get(stretch.name)
        if own is None:
            return joined
        flag = min(own.flag, joined.flag, key=FLAGS.index) if stretch.other else own.flag
        return _Entry(flag, own.band if math.isfinite(own.band) else joined.band)


_UNKNOWN = _Entry("nominal", math.nan)
NO_REPORT = Trust({})


def read_trust(path: Path) -> Trust:
    """Read the ``faces`` and ``edges`` of a registration's JSON report.

    Raises
    ------
    InputError : the file is missing or no such report
    """
    return trust_of(record.read(path), f"report {path}")


def trust_of(report: object, name: str = "registration's report") -> Trust:
    """The ``faces`` and ``edges`` of a registration's report, called ``name`` where it is none (InputError)."""
    if not isinstance(report, Mapping) or not isinstance(report.get("faces"), list):
        raise InputError(f"The {name} has no faces: name the file that register wrote with --report.")
    try:
        return Trust({str(item["name"]): _entry(item) for item in [*report["faces"], *report.get("edges", [])]})
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"The {name} has a face or edge without a sound name, flag and band.") from error


def _entry(item: Mapping[str, Any]) -> _Entry:
    flag, band = str(item["flag"]), item.get("band")
    if flag not in FLAGS:
        raise ValueError(flag)
    return _Entry(flag, math.nan if band is None else float(band))


def observed_share(flags: Array, lengths: Array) -> float:
    """Share of a seam's length that was observed, from flags (n,) and arc lengths (n,)."""
    seen = (flags == "observed").astype(float)
    return float((0.5 * (seen[1:] + seen[:-1]) * np.diff(lengths)).sum() / lengths[-1])


def doubts(name: str, flags: Array, lengths: Array) -> str | None:
    """A sentence if a part of a seam was not observed."""
    unseen = flags[flags != "observed"]
    if not len(unseen):
        return None
    worst = max(set(unseen.tolist()), key=FLAGS.index)
    share = 1.0 - observed_share(flags, lengths)
    where = "all" if len(unseen) == len(flags) else f"{share:.0%} of"
    return f"{name} was not observed by the scan over {where} its length ({worst}): check it before welding."
