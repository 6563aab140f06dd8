# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sensor profiles by name and as JSON files; `sensor_noise` measures one."""
from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..registration.joint import SensorProfile

PRESETS = {
    "white": SensorProfile(),
    "paper": SensorProfile(0.13, 0.0, 0.0, "paper"),
    "line-laser": SensorProfile(0.03, 0.015, 0.5, "line-laser"),
    "structured-light": SensorProfile(0.05, 0.025, 1.5, "structured-light"),
    "robot-laser": SensorProfile(1.5, 0.0, 0.0, "robot-laser"),
}
"""Typical sensors of a kind, for want of a measured profile. "paper": σ as published; "robot-laser": measured on the
plates of a real weld part, a point every 3 mm, too sparse for its neighbours to share anything."""

_NUMBERS = ("sigma", "sigma_c", "correlation_length")


def find(profile: SensorProfile | str | Path) -> SensorProfile:
    """A profile as it is, a preset by its name, or one read from a file.

    Raises
    ------
    InputError : there is no such preset or file, or the file holds no profile
    """
    if isinstance(profile, SensorProfile):
        return profile
    return PRESETS[str(profile)] if str(profile) in PRESETS else read(Path(profile))


def read(path: Path) -> SensorProfile:
    """Read a profile that `write` or ``ffds sensor measure`` wrote."""
    if not path.exists():
        raise InputError(f"The sensor profile {path} does not exist: name a file that 'ffds sensor measure' wrote, or "
                         f"one of {', '.join(PRESETS)}.")
    try:
        record = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"The sensor profile {path} cannot be read as JSON.") from error
    if not isinstance(record, dict) or any(not _is_number(record.get(key)) for key in _NUMBERS):
        raise InputError(f"The sensor profile {path} needs the numbers {', '.join(_NUMBERS)}, in mm.")
    sigma, sigma_c, length = (float(record[key]) for key in _NUMBERS)
    if sigma <= 0 or sigma_c < 0 or length < 0:
        raise InputError(f"The sensor profile {path} has a sigma that is not positive, or a negative sigma_c or "
                         "correlation_length.")
    return SensorProfile(sigma, sigma_c, length, str(record.get("name", path.stem)))


def write(profile: SensorProfile, path: Path) -> None:
    """Write a profile as JSON, lengths in mm."""
    path.write_text(json.dumps(asdict(profile), indent=1, ensure_ascii=False) + "\n", "utf-8")


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and bool(np.isfinite(value))
