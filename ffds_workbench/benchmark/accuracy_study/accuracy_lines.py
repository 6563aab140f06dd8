# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the accuracy has to be, line by line, and whether it is."""
from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .accuracy_cases import FLAGS, WITHOUT_NORMALS, WITH_NORMALS
from .accuracy_sheet import LEAST_SQUARES

Row = Mapping[str, Any]

_CASES: dict[str, dict[str, float]] = {
    "b-springback-1view": {"visible": 0.006, "p95": 0.02, "hidden": 0.015, "thickness": 0.005},
    "b-springback": {"visible": 0.006, "edges": 0.03}, "b-mix": {"visible": 0.007, "hidden": 0.05, "edges": 0.04},
    "c-springback": {"visible": 0.010, "hidden": 0.03, "edges": 0.05}, "a-iso": {"visible": 0.008, "edges": 0.025},
    "e-twist": {"visible": 0.005, "edges": 0.06}, "d-bumps": {"visible": 0.008, "edges": 0.06},
    "f-bend": {"visible": 0.008, "edges": 0.06},
    "/".join(map(str, WITH_NORMALS)): {"visible": 0.005, "hidden": 0.05},
}
"""Largest means in mm (p95: of the visible) for the supplied cases, and where normals tell which skin is seen."""
_FAMILIES: dict[tuple[str, str], dict[str, float]] = {
    ("bracket", "springback"): {"visible": 0.006, "hidden": 0.015, "edges": 0.03},
    ("bracket", ""): {"visible": 0.007, "hidden": 0.05, "edges": 0.04},
    ("hat-channel", ""): {"visible": 0.010, "hidden": 0.03, "edges": 0.05},
    ("rimmed-plate", "iso"): {"visible": 0.008, "edges": 0.025},
    ("rimmed-plate", ""): {"visible": 0.008},
    ("free-form-panel", ""): {"visible": 0.005, "edges": 0.06},
    ("pipe-on-plate", ""): {"visible": 0.008, "edges": 0.06},
    ("turned-part", ""): {"visible": 0.008, "edges": 0.06},
}
"""The same for families seen from all their views; for every deformation that has no line of its own."""
_UNTOLD = "/".join(map(str, WITHOUT_NORMALS))
_WRONG_SKIN = 0.5
"""Mean of the visible in mm from which a sheet was fitted to its other skin: it is some 1.7 mm away."""
_GAP, _TOLERANCE = 1e-4, 1e-3
_LEAST_SQUARES_RATIO, _WORST = 1.15, 0.5
_MEDIANS = {"mean": 0.065, "p95": 0.18, "max": 0.5}
_HELD = {("white", "observed"): (0.93, 0.97), ("white", "bridged"): (0.93, 1.0), ("white", "carried"): (0.90, 1.0),
         ("dirty", "observed"): (0.90, 1.0), ("dirty", "bridged"): (0.90, 1.0), ("dirty", "carried"): (0.90, 1.0)}


@dataclass(frozen=True)
class AccuracyLine:
    """One thing that has to hold: what was found, what is asked, and whether it does."""

    what: str
    found: float
    asked: str
    met: bool

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def held(rows: Iterable[Row], key: str = "bands") -> dict[str, dict[str, float]]:
    """Share of all places within their bands, by kind of noise and flag, and the number of places."""
    shares = {}
    for kind in ("white", "dirty"):
        chosen = [row[key] for row in rows if key in row and (row["kind"] == "dirty") == (kind == "dirty")]
        for flag in FLAGS:
            places, inside = (sum(item[flag][what] for item in chosen) for what in ("places", "held"))
            if places:
                shares[f"{kind}/{flag}"] = {"places": places, "share": inside / places}
    return shares


def lines(sheets: Mapping[str, Any], rows: Sequence[Row]) -> list[AccuracyLine]:
    """All lines for which there are figures."""
    found = [*_sheet_lines(sheets), *_case_lines(rows)]
    for name, item in held(rows).items():
        kind, flag = name.split("/")
        low, high = _HELD[kind, flag]
        noise = "white noise" if kind == "white" else "correlated noise, sensor profile known"
        asked = f"{low:.2f} to {high:.2f}" if high < 1 else f"at least {low:.2f}"
        found.append(AccuracyLine(f"95 % bands, {flag}, {noise}", item["share"], asked, low <= item["share"] <= high))
    return found


def _at_most(what: str, found: float, limit: float) -> AccuracyLine:
    return AccuracyLine(what, found, f"at most {limit:g}", bool(found <= limit))


def _sheet_lines(sheets: Mapping[str, Any]) -> list[AccuracyLine]:
    found = []
    if "D" in sheets:
        robust, plain = sheets["D"]["robust"], sheets["D"][LEAST_SQUARES]
        found += [_at_most(f"Sheet D, {key}, ÷ {LEAST_SQUARES}", robust[key] / plain[key], _LEAST_SQUARES_RATIO)
                  for key in ("mean", "p95")]
        found += [_at_most(f"Sheet D, median {key}, ÷ {LEAST_SQUARES}",
                           robust[f"median_{key}"] / plain[f"median_{key}"], _LEAST_SQUARES_RATIO)
                  for key in ("mean", "p95")]
        found.append(_at_most(f"Sheet D, largest of {robust['seeds']} scans, mm", robust["worst"], _WORST))
    if "E" in sheets:
        found += [_at_most(f"Sheet E, median {key}, mm", sheets["E"]["robust"][f"median_{key}"], limit)
                  for key, limit in _MEDIANS.items()]
    return found


def _case_lines(rows: Sequence[Row]) -> list[AccuracyLine]:
    found = []
    for row in rows:
        for what, limit in _CASES.get(row["case"], {}).items():
            if row.get("visible" if what == "p95" else what):
                found.append(_at_most(f"{row['case']}, {what}, mm", figure(row, what), limit))
    for (family, warp), limits in _FAMILIES.items():
        chosen = [row for row in rows if row["family"] == family and row["kind"] == "clean" and "refused" not in row
                  and (f"/{warp}/" in row["case"] if warp else not _has_own_line(family, row["case"]))]
        for what, limit in limits.items() if chosen else ():
            mean = float(np.mean([figure(row, what) for row in chosen]))
            name = f"{family}, {warp or 'other deformations'}, {len(chosen)} scans, {what}, mm"
            found.append(_at_most(name, mean, limit))
    done = [row for row in rows if "refused" not in row]
    if done:
        found += [_at_most("Largest gap beyond the nominal's, mm", max(row["gap"] for row in done), _GAP),
                  _at_most("Largest tolerance, mm", max(row["tolerance"] for row in done), _TOLERANCE),
                  _at_most("Results with a certificate that is not clean, or another topology",
                           float(sum(bool(row["certificate"]) or not row["topology"] for row in done)), 0.0)]
    untold = [row for row in rows if row["case"] == _UNTOLD]
    if untold:
        wrong = [row for row in untold if not row.get("unsure") and "refused" not in row
                 and figure(row, "visible") > _WRONG_SKIN]
        what = f"{_UNTOLD}, whose skin nothing tells: written on the wrong one, and not as a guess with bands as wide"
        found.append(_at_most(what, float(len(wrong)), 0.0))
    refused = [row for row in rows if "refused" in row]
    found.append(_at_most("Cases that were refused, though their scans tell enough", float(len(refused)), 0.0))
    return found


def _has_own_line(family: str, case: str) -> bool:
    return any(own == family and warp and f"/{warp}/" in case for own, warp in _FAMILIES)


def figure(row: Row, what: str) -> float:
    """A mean in mm, or the p95 of the visible; zero where there is nothing to be off."""
    block = row.get("visible" if what == "p95" else what)
    return float(block["p95" if what == "p95" else "mean"]) if block else 0.0
