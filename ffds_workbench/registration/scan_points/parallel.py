# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many threads a nearest-neighbour search uses."""
from __future__ import annotations

from ..arrays import Array


def workers(points: Array) -> int:
    """Threads that a search for so many ``points`` (n, 3) is worth."""
    return -1 if len(points) > 1000 else 1
