# SPDX-License-Identifier: LGPL-2.1-or-later
"""How well a process keeps a tolerance: Cp and Cpk, with what so few parts can tell of them."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import nctdtr
from scipy.stats import chi2

from ...registration.arrays import Array

_TAIL = 0.025


@dataclass(frozen=True)
class Capability:
    """Indices of a process.

    Attributes
    ----------
    cp : (upper − lower) / 6σ; None where one limit alone is given
    cpk : distance of the mean from the nearer limit over 3σ
    cp_interval, cpk_interval : 95 % intervals
    """

    cp: float | None
    cpk: float
    cp_interval: tuple[float, float] | None
    cpk_interval: tuple[float, float]


def capability(figures: Array, lower: float | None, upper: float | None) -> Capability | None:
    """Cp and Cpk of figures (n,) between limits; None where they do not vary, are too few, or there is no limit.

    Notes
    -----
    Cp: the interval of a variance (chi square). Cpk: 3√n Ĉ of one limit is Student's t with non-centrality 3√n C
    (Kotz and Lovelace, *Process Capability Indices in Theory and Practice*, 1998, section 2.4); exact for the nearer
    limit, and for both a little too wide.
    """
    count = len(figures)
    if count < 3 or (lower is None and upper is None):
        return None
    mean, sigma = float(np.mean(figures)), float(np.std(figures, ddof=1))
    if sigma <= 0.0:
        return None
    cpk = min((side for side in (None if upper is None else (upper - mean) / (3 * sigma),
                                 None if lower is None else (mean - lower) / (3 * sigma)) if side is not None))
    cpk_interval = _non_centrality(cpk, count, 1 - _TAIL), _non_centrality(cpk, count, _TAIL)
    cp = interval = None
    if lower is not None and upper is not None:
        cp = (upper - lower) / (6 * sigma)
        low, high = (cp * np.sqrt(chi2.ppf(share, count - 1) / (count - 1)) for share in (_TAIL, 1 - _TAIL))
        interval = float(low), float(high)
    return Capability(cp, float(cpk), interval, cpk_interval)


def _non_centrality(index: float, count: int, share: float) -> float:
    """The index of a process of which ``share`` of samples of ``count`` show less than ``index``."""
    scale = 3.0 * np.sqrt(count)
    width = 6.0 * np.sqrt(1.0 + index**2 / 2.0 * scale**2 / (count - 1))  # six standard deviations, roughly
    found = brentq(lambda shift: nctdtr(count - 1, shift, scale * index) - share, scale * index - width,
                   scale * index + width)
    return float(found / scale)
