# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a scan can be one of a model where it lies: sizes, overlap and the unit that would explain a mismatch."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, RefusedError
from .cloud import PointCloud
from .units import MILLIMETRES, NAMES

Array = NDArray[np.float64]

_SMALLEST = 0.02
"""A scan smaller than this part of its model is suspected to be in another unit."""
_LARGEST = 50.0
_MARGIN = 0.15
"""How far beyond the model's box, as a part of its diagonal, a deformed part may reach."""


def check_overlap(scan: PointCloud, low: Array, high: Array) -> None:
    """Refuse a scan that cannot be one of the model in the box from ``low`` to ``high``, (3,) each, in mm.

    Raises
    ------
    InputError : the scan's size speaks for another unit
    RefusedError : the scan does not reach the model
    """
    size = float(np.linalg.norm(high - low))
    inner_low, inner_high = np.percentile(scan.points, [2.0, 98.0], axis=0)
    scan_size = float(np.linalg.norm(inner_high - inner_low))
    near = _share_near(scan.points, low, high, _MARGIN * size)
    if near > 0.0 and _SMALLEST < scan_size / size < _LARGEST:
        return
    unit = _likely_unit(scan.unit, scan_size / size)
    if unit is not None:
        raise InputError(f"The scan measures {scan_size:.3g} mm and the model {size:.3g} mm: the scan seems to be in "
                         f"{NAMES[unit]}, not in {NAMES[scan.unit]} (use --scan-unit {unit}).")
    if near > 0.0:
        raise RefusedError(f"The scan measures {scan_size:.3g} mm and the model {size:.3g} mm: they are not of the "
                           f"same part, or in other units.")
    away = np.linalg.norm(np.maximum(np.maximum(low - scan.points, scan.points - high), 0.0), axis=1).min()
    raise RefusedError(f"The scan and the model do not overlap, the nearest scan point is {away:.3g} mm away: align "
                       f"the scan with the model first.")


def _share_near(points: Array, low: Array, high: Array, margin: float) -> float:
    return float(((points > low - margin) & (points < high + margin)).all(axis=1).mean())


def _likely_unit(unit: str, ratio: float) -> str | None:
    """The unit that would bring the scan to the model's size, if the unit in use does not."""
    if 0.1 < ratio < 10.0:
        return None
    fits = {other: ratio * MILLIMETRES[other] / MILLIMETRES[unit] for other in MILLIMETRES if other != unit}
    best = min(fits, key=lambda other: abs(np.log(fits[other])))
    return best if 0.1 < fits[best] < 5.0 else None
