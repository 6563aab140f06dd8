# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether a scan can be one of a model where it lies: sizes, overlap and the unit that would explain a mismatch."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, RefusedError
from ..registration.rigid.scan_unit import Surface, box_of, unit_mismatch
from .cloud import PointCloud
from .units import MILLIMETRES, NAMES

Array = NDArray[np.float64]

_MARGIN = 0.15
"""How far beyond the model's box, as a part of its diagonal, a deformed part may reach."""


def check_overlap(scan: PointCloud, low: Array, high: Array, surface: Surface, declared: str = "") -> None:
    """Refuse a scan that cannot be one of the model in the box from ``low`` to ``high``, (3,) each, in mm.

    Parameters
    ----------
    surface : gives points and normals of the model where they are needed
    declared : the unit that the model's file says it is in, "" where it is mm

    Raises
    ------
    InputError : the scan or the model is in another unit
    RefusedError : the scan does not reach the model
    """
    size = float(np.linalg.norm(high - low))
    factor = unit_mismatch(scan.points, low, high, surface)
    if factor is not None:
        raise InputError(wrong_unit(scan, size, factor, declared))
    if (np.abs(scan.points - 0.5 * (low + high)) < 0.5 * (high - low) + _MARGIN * size).all(axis=1).any():
        return
    away = np.linalg.norm(np.maximum(np.maximum(low - scan.points, scan.points - high), 0.0), axis=1).min()
    raise RefusedError(f"The scan and the model do not overlap, the nearest scan point is {away:.3g} mm away: align "
                       f"the scan with the model first.")


def wrong_unit(scan: PointCloud, size: float, factor: float, declared: str = "") -> str:
    """What is said of a scan that fits a model of this size (mm) once it is multiplied by ``factor``."""
    sizes = f"The scan measures {_mm(box_of(scan.points)[2])} mm and the model {_mm(size)} mm"
    times = f"{factor:g} times the scan" if factor > 1.0 else f"the scan divided by {1.0 / factor:g}"
    says = f" ({declared})" if declared else ""
    unit = next((name for name, length in MILLIMETRES.items()
                 if np.isclose(length, factor * MILLIMETRES[scan.unit])), None)
    if unit is None:
        return (f"{sizes}, but {times} fits: the model's file seems to declare a wrong unit{says}; correct it there, "
                f"or scale the scan.")
    return (f"{sizes}, but {times} fits: the scan seems to be in {NAMES[unit]}, not in {NAMES[scan.unit]} (use "
            f"--scan-unit {unit}), or the model's file declares a wrong unit{says}.")


def _mm(length: float) -> str:
    return f"{length:.3g}" if length < 1000.0 else f"{length:.0f}"
