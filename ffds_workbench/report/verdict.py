# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a registration came to: the verdict in a sentence, and what to look at, each with what it proposes."""
from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .table import doubts

SHOW, DEVIATION, SCAN = "show", "deviation", "scan"
"""What a piece of advice proposes: to look at its faces, at the deviation, or to bring another scan."""
_NOISES = 3.0
"""95 % of white noise lie within two standard deviations (theory); what a surface may leave beyond that makes it three
(unit)."""
_HALF = 0.5
"""Share of a face that has to be seen (unit: most of it)."""
_MOST_NAMES = 8
"""Faces that a sentence names (unit)."""


@dataclass(frozen=True)
class Advice:
    """One thing to look at.

    Attributes
    ----------
    text : the sentence
    proposes : `SHOW`, `DEVIATION` or `SCAN`
    faces : names of the faces that it is about
    """

    text: str
    proposes: str
    faces: tuple[str, ...] = ()


def fits(report: Mapping[str, Any], figures: Mapping[str, Any] | None) -> bool:
    """Whether deviations, of the part or of a face, are no larger than the scan's noise explains."""
    noise = report["scan"]["noise"]
    return figures is not None and noise is not None and figures["p95"] <= _NOISES * noise


def verdict_sentence(report: Mapping[str, Any]) -> str:
    """How well the as-built part of a registration's report fits its scan."""
    before, after = report["deviation_before"], report["deviation_after"]
    if after is None or before is None:
        return "No point of the scan lies on the as-built part."
    if fits(report, after):
        return (f"The as-built part fits the scan within its noise: {after['mean']:.3f} mm from it on average, "
                f"{before['mean']:.3f} mm before.")
    return (f"The as-built part lies {after['mean']:.3f} mm from the scan on average, {before['mean']:.3f} mm before: "
            f"that is more than noise explains.")


def advice(report: Mapping[str, Any]) -> list[Advice]:
    """What to look at, the gravest first; empty where all is well."""
    faces = report["faces"]
    found = [Advice(text, SCAN if report["sheet"]["unsure"] and "skin" in text else SHOW, _faces_in(text))
             for text in doubts(report).splitlines()]
    off = [face["name"] for face in faces if face["deviation_after"] and face["flag"] == "observed"
           and not fits(report, face["deviation_after"])]
    thin = [face["name"] for face in faces if face["flag"] == "observed" and face["coverage"] < _HALF]
    together = any(face["band"] is not None for face in faces)
    carried = [face["name"] for face in faces if together and face["flag"] in ("carried", "bridged")]
    found += _about(off, DEVIATION, _off_text(off))
    found += _about(thin, SHOW, _thin_text(thin))
    found += _about(carried, SHOW, _carried_text(carried))
    check = report["topology"]["boolean_check"]
    if check["after"] and check["after"] > (check["before"] or 0):
        found.append(Advice(_boolean_text(check["after"]), SHOW))
    return found


def _off_text(names: Sequence[str]) -> str:
    return f"Farther from the scan than its noise explains: {_listed(names)}. Look at the deviation."


def _thin_text(names: Sequence[str]) -> str:
    return f"The scan shows less than half of {_listed(names)}: scan more of it."


def _carried_text(names: Sequence[str]) -> str:
    return f"Not seen by the scan, and carried along by what is: {_listed(names)}."


def _boolean_text(count: int) -> str:
    return f"The check for Boolean operations finds {count} errors: cutting or joining this part may fail."


def _about(names: Sequence[str], proposes: str, text: str) -> list[Advice]:
    return [Advice(text, proposes, tuple(names))] if names else []


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(names[:_MOST_NAMES])
    return shown if len(names) <= _MOST_NAMES else f"{shown} … ({len(names)})"


def _faces_in(text: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(re.findall(r"\bFace\d+\b", text)))
