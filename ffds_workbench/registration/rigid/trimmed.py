# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether scattered parameters lie on a trimmed face."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..splines import Array


def inside_trims(trims: Sequence[Array], uv: Array) -> NDArray[np.bool_]:
    """Whether parameters (n, 2) lie on the face: even-odd rule over the closed polylines."""
    inside = np.zeros(len(uv), dtype=bool)
    x, y = uv[:, :1], uv[:, 1:]
    for polyline in trims:
        (x0, y0), (x1, y1) = polyline[:-1].T, polyline[1:].T
        run = np.where(y1 == y0, 1.0, y1 - y0)
        for some in np.array_split(np.arange(len(uv)), len(uv) * len(x0) // 2_000_000 + 1):
            crossed = (y0 > y[some]) != (y1 > y[some])
            left = x[some] < x0 + (x1 - x0) * (y[some] - y0) / run
            inside[some] ^= (crossed & left).sum(axis=1) % 2 == 1
    return inside
