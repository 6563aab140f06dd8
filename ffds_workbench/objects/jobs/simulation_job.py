# SPDX-License-Identifier: LGPL-2.1-or-later
"""A part of the document scanned by the virtual sensor."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import api
from ...report.stopwatch import Progress
from ..sources import read_source


def prepare(source: Any, spacing: float, noise: float, views: Sequence[tuple[float, float, float]], outliers: float,
            seed: int) -> Callable[[Progress | None], NDArray[np.float64]]:
    """The scan as a function that touches no document, for any thread (call this on the main thread).

    It gives points (n, 3) in the document's coordinates. Lengths in mm; for the settings see `actions.simulate_scan`.

    Raises
    ------
    InputError : the part or the settings cannot be used
    """
    settings = api.SensorSettings(spacing=spacing, noise=noise, outliers=outliers, seed=seed,
                                  views=tuple(api.View(tuple(view)) for view in views))
    found = read_source(source)
    rotation, shift = found.T_document_part[:3, :3], found.T_document_part[:3, 3]

    def run(progress: Progress | None = None) -> NDArray[np.float64]:
        if progress is not None:
            progress("Scanning the part")
        return api.simulate(found.model, settings).scan.points @ rotation.T + shift

    return run
