# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many threads a nearest-neighbour search uses."""
from __future__ import annotations

from .arrays import Array


def workers(points: Array) -> int:
    """Number of threads for a nearest-neighbour search for these points: all (−1) if there are many."""
    return -1 if len(points) > 1000 else 1
