# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much memory a joint solve takes, estimated beforehand: a killed process explains nothing."""
from __future__ import annotations

import math
import os
from pathlib import Path

from ....errors import RefusedError

_PER_CONTROL_POINT = 5e3
"""Bytes for each control point and each halving of their number, down to one (theory: nested dissection of a surface
fills so much, George 1973). This and the next two are calibrated to 30 %: by hand, on the largest resident size of
``register`` on parts of 1,100 to 33,000 control points, 16,000 to 800,000 cells and 60,000 to 1.4 million points."""
_PER_CELL = 1.5e3
"""Bytes for each cell (calibrated: as above)."""
_PER_POINT = 140.0
"""Bytes for each point (calibrated: as above)."""
_MEMORY = Path("/proc/meminfo")
_LIMITS = Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory.current")


def needed(control_points: int, cells: int, points: int) -> float:
    """Bytes that a solve takes at its largest."""
    halvings = math.log2(max(2, control_points))
    return _PER_CONTROL_POINT * control_points * halvings + _PER_CELL * cells + _PER_POINT * points


def available() -> float:
    """Bytes that this process may still take: what Linux says, no more than its container has left; elsewhere all the
    memory of the machine, or no bound where that is unknown."""
    found = [math.inf]
    try:
        lines = dict(line.split(":", 1) for line in _MEMORY.read_text().splitlines())
        found.append(1024.0 * float(lines["MemAvailable"].split()[0]))
    except (OSError, KeyError, ValueError):
        found += _whole()
    try:
        most, used = (float(path.read_text()) for path in _LIMITS)
        found.append(most - used)
    except (OSError, ValueError):  # no container, or one without a limit ("max")
        pass
    return min(found)


def _whole() -> list[float]:
    """Memory of the machine, where POSIX tells it."""
    try:
        return [float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")]
    except (AttributeError, ValueError, OSError):
        return []


def refuse_too_large(control_points: int, cells: int, points: int) -> None:
    """Refuse a solve for which there is not enough memory.

    Parameters
    ----------
    control_points : how many there are
    cells : of the raster
    points : of the scan

    Raises
    ------
    RefusedError : it needs more than there is
    """
    wanted, there = needed(control_points, cells, points), available()
    if wanted > there:
        raise RefusedError(f"The job needs about {wanted / 1e9:.1f} GB of memory and {there / 1e9:.1f} GB are free: "
                           f"name the faces to deform, or check the units of model and scan.")
