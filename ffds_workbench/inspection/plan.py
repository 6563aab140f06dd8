# SPDX-License-Identifier: LGPL-2.1-or-later
"""The inspection plan: what is to be inspected on which faces and edges, as JSON; see inspection_plan.schema.json."""
from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import InputError

FORMS = ("flatness", "straightness", "roundness", "cylindricity")
PROFILES = ("profile_line", "profile_surface")
ORIENTATIONS = ("parallelism", "perpendicularity", "angularity")
ZONES = (*FORMS, *PROFILES, *ORIENTATIONS, "position")
DIMENSIONS = ("distance", "diameter", "angle", "thickness", "gap", "flush")
CHARACTERISTICS = (*ZONES, *DIMENSIONS)
_PAIRS = ("distance", "angle", "thickness", "gap", "flush")
_CONDITIONS = ("rfs", "mmc", "lmc")
_KEYS = {"name", "characteristic", "of", "datums", "tolerance", "nominal", "lower", "upper", "condition", "size"}


@dataclass(frozen=True)
class PlanItem:
    """One characteristic.

    Attributes
    ----------
    name : what it is called
    characteristic : one of `CHARACTERISTICS`
    of : names of the faces or edges
    datums : names of datums, the primary one first
    lower, upper : limits, None for none: of a zone its width in mm, of a dimension deviations from its nominal value,
        in mm or degrees
    nominal : of a dimension; None for the nominal model's own
    condition : of a position: "rfs", or "mmc" or "lmc", where ``size`` is the size at that condition in mm
    size : see there
    """

    name: str
    characteristic: str
    of: tuple[str, ...]
    datums: tuple[str, ...]
    lower: float | None
    upper: float | None
    nominal: float | None = None
    condition: str = "rfs"
    size: float | None = None


@dataclass(frozen=True)
class Plan:
    """A plan: its datums by their letters, each a face, and its items."""

    datums: Mapping[str, str]
    items: tuple[PlanItem, ...]


def read_plan(path: str | Path) -> Plan:
    """Read a plan file.

    Parameters
    ----------
    path : of a JSON file

    Raises
    ------
    InputError : it cannot be read, or says something that is no plan
    """
    try:
        record = json.loads(Path(path).read_text("utf-8"))
    except OSError as error:
        raise InputError(f"The plan {path} cannot be read: {error.strerror or error}.") from error
    except ValueError as error:
        raise InputError(f"The plan {path} is not JSON: {error}.") from error
    return plan_of(record)


def plan_of(record: Any) -> Plan:
    """A plan out of JSON (InputError where it is none)."""
    if not isinstance(record, dict) or not isinstance(record.get("items"), list) or not record["items"]:
        raise InputError("The plan has no items: it is an object with 'items', a list, and 'datums', an object.")
    datums = record.get("datums", {})
    if not isinstance(datums, dict) or not all(isinstance(value, str) for value in datums.values()):
        raise InputError("The plan's datums are no object of letters and faces, as in {\"A\": \"Face1\"}.")
    return Plan(datums, tuple(_item(number, item, datums) for number, item in enumerate(record["items"], 1)))


def _item(number: int, item: Any, datums: Mapping[str, str]) -> PlanItem:
    if not isinstance(item, dict):
        raise InputError(f"Item {number} of the plan is no object.")
    name = str(item.get("name", f"item {number}"))
    unknown = sorted(set(item) - _KEYS)
    if unknown:
        raise InputError(f"{name}: '{unknown[0]}' is unknown; an item has {', '.join(sorted(_KEYS))}.")
    kind = item.get("characteristic")
    if kind not in CHARACTERISTICS:
        raise InputError(f"{name}: the characteristic {kind!r} is unknown: use one of {', '.join(CHARACTERISTICS)}.")
    of = _names(name, "of", item.get("of"))
    wanted = _names(name, "datums", item.get("datums", []))
    missing = [letter for letter in wanted if letter not in datums]
    if missing:
        raise InputError(f"{name}: the plan names no datum {missing[0]}.")
    _check_counts(name, kind, of, wanted)
    lower, upper = _limits(name, kind, item)
    condition, size = item.get("condition", "rfs"), _number(name, "size", item.get("size"))
    if condition not in _CONDITIONS or (condition != "rfs") != (size is not None):
        raise InputError(f"{name}: a condition is one of {', '.join(_CONDITIONS)}, and mmc and lmc need a 'size'.")
    if condition != "rfs" and kind != "position":
        raise InputError(f"{name}: {condition} is for positions; leave it out.")
    nominal = _number(name, "nominal", item.get("nominal"))
    return PlanItem(name, kind, of, wanted, lower, upper, nominal, condition, size)


def _names(name: str, key: str, value: Any) -> tuple[str, ...]:
    names = [value] if isinstance(value, str) else value
    if not isinstance(names, list) or not all(isinstance(item, str) for item in names):
        raise InputError(f"{name}: '{key}' is a name or a list of names.")
    return tuple(names)


def _check_counts(name: str, kind: str, of: tuple[str, ...], datums: tuple[str, ...]) -> None:
    wanted = 2 if kind in _PAIRS else 1
    if len(of) != wanted and not (kind == "profile_surface" and of):
        many = "s" * (wanted > 1)
        raise InputError(f"{name}: {kind} is of {wanted} face{many} or edge{many}, and 'of' names {len(of)}.")
    if kind in FORMS and datums:
        raise InputError(f"{name}: {kind} has no datums; leave them out.")
    if kind in ORIENTATIONS and not datums:
        raise InputError(f"{name}: {kind} needs a datum.")


def _limits(name: str, kind: str, item: Mapping[str, Any]) -> tuple[float | None, float | None]:
    tolerance, lower, upper = (_number(name, key, item.get(key)) for key in ("tolerance", "lower", "upper"))
    if kind in ZONES:
        if tolerance is None or tolerance <= 0 or lower is not None or upper is not None:
            raise InputError(f"{name}: {kind} has a 'tolerance' above 0, and neither 'lower' nor 'upper'.")
        return None, tolerance
    if tolerance is not None:
        if lower is not None or upper is not None or tolerance <= 0:
            raise InputError(f"{name}: give either a 'tolerance' above 0, for ±, or 'lower' and 'upper'.")
        lower, upper = -tolerance, tolerance
    if lower is None and upper is None:
        raise InputError(f"{name}: {kind} needs a 'tolerance', or 'lower' or 'upper', from the nominal value.")
    if lower is not None and upper is not None and lower > upper:
        raise InputError(f"{name}: 'lower' is above 'upper'.")
    return lower, upper


def _number(name: str, key: str, value: Any) -> float | None:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise InputError(f"{name}: '{key}' is no number.")
    return float(value)
