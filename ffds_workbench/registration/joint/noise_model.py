# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is known of a sensor's noise beforehand."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class SensorProfile:
    """The noise of a sensor along the surface normal; a property of the sensor, measured once on a flat datum.

    A single scan of a curved part cannot tell noise that neighbouring points share from shape.

    Attributes
    ----------
    sigma : white noise in mm, or None to take it from the scan
    sigma_c : correlated noise in mm: what neighbouring points share
    correlation_length : in mm: the correlation falls as exp(−r²/2l²)
    name : of the sensor
    """

    sigma: float | None = None
    sigma_c: float = 0.0
    correlation_length: float = 0.0
    name: str = "white noise"

    @property
    def shared(self) -> float:
        """∫ of the correlated noise's covariance over the surface, 2π l² σ_c², in mm⁴."""
        return 2 * np.pi * self.correlation_length**2 * self.sigma_c**2
