# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the report for people says, in words and tables, from the JSON report and the request behind it."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .. import verdict
from ..versions import versions

Rows = list[tuple[str, ...]]
FACE_HEADS = ("face", "from", "seen", "points", "before: mean", "95 %", "after: mean", "95 %", "band ±")
_FLAGS = {"observed": "scan", "bridged": "bridged", "carried": "carried", "nominal": "nominal"}


@dataclass(frozen=True)
class Content:
    """What both files say.

    Attributes
    ----------
    title : the part's name
    sentence : the verdict
    good : whether the part fits its scan
    advice : what to look at, a sentence each
    faces : one row per face, under `FACE_HEADS`; lengths in mm
    certificate, settings, made_with : (name, value) each
    """

    title: str
    sentence: str
    good: bool
    advice: tuple[str, ...]
    faces: Rows
    certificate: Rows
    settings: Rows
    made_with: Rows


def content(title: str, report: Mapping[str, Any], request: Mapping[str, Any]) -> Content:
    """The content of a registration's report; ``request`` holds the settings that it was asked for with."""
    return Content(title, verdict.verdict_sentence(report), verdict.fits(report, report["deviation_after"]),
                   tuple(entry.text for entry in verdict.advice(report)), _faces(report),
                   _certificate(report["topology"]), _settings(report, request), list(versions().items()))


def _faces(report: Mapping[str, Any]) -> Rows:
    rows = [_face(face) for face in report["faces"]]
    everything = {"name": "all", "flag": None, "coverage": None, "band": None,
                  "points": sum(face["points"] for face in report["faces"]), **report}
    return [*rows, _face(everything)]


def _face(face: Mapping[str, Any]) -> tuple[str, ...]:
    blocks = face["deviation_before"], face["deviation_after"]
    figures = [_length(block and block[name]) for block in blocks for name in ("mean", "p95")]
    seen = "" if face["coverage"] is None else f"{100 * face['coverage']:.0f} %"
    return (face["name"], _FLAGS.get(face["flag"], ""), seen, str(face["points"]), *figures, _length(face["band"]))


def _certificate(topology: Mapping[str, Any]) -> Rows:
    counts = ", ".join(f"{count} {name}" for name, count in topology["after"].items() if count)
    gap, tolerance, check = topology["max_edge_gap"], topology["max_tolerance"], topology["boolean_check"]
    return [("topology", counts), ("same as nominal", _yes(topology["before"] == topology["after"])),
            ("order kept", _yes(topology["order_kept"])), ("valid", _yes(topology["valid"])),
            ("closed", _yes(topology["closed"])),
            ("largest edge gap", f"{gap['before']:.1e} → {gap['after']:.1e} mm"),
            ("largest tolerance", f"{tolerance['before']:.1e} → {tolerance['after']:.1e} mm"),
            ("check for Boolean operations", f"{_errors(check['before'])} → {_errors(check['after'])}")]


def _settings(report: Mapping[str, Any], request: Mapping[str, Any]) -> Rows:
    scan = report["scan"]
    noise = "" if scan["noise"] is None else f", noise {scan['noise']:.3f} mm"
    rows: Rows = [("scan", f"{scan['points']} points{noise}")]
    for name, value in request.items():
        shown = "whole part" if name == "faces" and value is None else _words(value)
        if shown:
            rows.append((name.replace("_", " "), shown))
    return rows


def _words(value: Any) -> str:
    if isinstance(value, Sequence) and not isinstance(value, str):
        return ", ".join(map(str, value))
    return "" if value is None else str(value)


def _length(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _yes(flag: bool) -> str:
    return "yes" if flag else "NO"


def _errors(count: int | None) -> str:
    return "not finished in time" if count is None else "no errors" if count == 0 else f"{count} errors"
