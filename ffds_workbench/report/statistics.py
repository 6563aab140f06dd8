# SPDX-License-Identifier: LGPL-2.1-or-later
"""The figures of signed deviations, as in the report."""
from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Statistics:
    """Figures of the signed deviations of scan points from a surface, in mm.

    Attributes
    ----------
    mean, rms, p95, max : of |deviation|
    signed_mean : of the deviation itself, positive outside the material
    """

    mean: float
    rms: float
    p95: float
    max: float
    signed_mean: float

    def as_dict(self) -> dict[str, float]:
        """The report's block."""
        return asdict(self)


def statistics(deviations: NDArray[np.float64]) -> Statistics | None:
    """Figures of (n,) signed deviations in mm; None where there are none."""
    if len(deviations) == 0:
        return None
    size = np.abs(deviations)
    return Statistics(float(size.mean()), float(np.sqrt((size**2).mean())), float(np.percentile(size, 95)),
                      float(size.max()), float(deviations.mean()))
