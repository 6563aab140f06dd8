# SPDX-License-Identifier: LGPL-2.1-or-later
"""Control charts: means and scatter of groups (X̄ and s), and an exponentially weighted mean (EWMA)."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from ...registration.arrays import Array

_LIMIT = 3.0
_MEMORY, _EWMA_LIMIT = 0.2, 2.86
"""Weight of the newest figure and limit in standard deviations: one false alarm in 370 figures (Lucas and Saccucci,
*Exponentially weighted moving average control schemes*, Technometrics 32, 1990, table 3)."""


@dataclass(frozen=True)
class ControlChart:
    """A run of figures between its limits.

    Attributes
    ----------
    name : "means", "scatter" or "ewma"
    values : (k,) of the groups or figures
    centre : what they are about
    low, high : (k,) limits
    """

    name: str
    values: Array
    centre: float
    low: Array
    high: Array

    @property
    def signals(self) -> list[int]:
        """Indices of the values beyond their limits."""
        return [int(index) for index in np.flatnonzero((self.values < self.low) | (self.values > self.high))]


def means_chart(figures: Array, size: int = 5) -> ControlChart | None:
    """The X̄ chart of groups of ``size`` successive figures (n,); None where there are no two groups.

    Notes
    -----
    Limits X̿ ± 3 s̄ / (c₄ √size), c₄ = √(2/(size − 1)) Γ(size/2) / Γ((size − 1)/2) (ISO 7870-2).
    """
    groups = _groups(figures, size)
    if groups is None:
        return None
    values, centre = groups.mean(axis=1), float(groups.mean())
    half = _LIMIT * float(groups.std(axis=1, ddof=1).mean()) / (_c4(size) * np.sqrt(size))
    return ControlChart("means", values, centre, np.full(len(values), centre - half), np.full(len(values),
                                                                                              centre + half))


def scatter_chart(figures: Array, size: int = 5) -> ControlChart | None:
    """The s chart of groups of ``size`` successive figures (n,); None where there are no two groups.

    Notes
    -----
    Limits s̄ ± 3 s̄ √(1 − c₄²) / c₄, no less than 0 (ISO 7870-2).
    """
    groups = _groups(figures, size)
    if groups is None:
        return None
    values = groups.std(axis=1, ddof=1)
    centre, factor = float(values.mean()), _c4(size)
    half = _LIMIT * centre * np.sqrt(1.0 - factor**2) / factor
    return ControlChart("scatter", values, centre, np.full(len(values), max(0.0, centre - half)),
                        np.full(len(values), centre + half))


def ewma_chart(figures: Array) -> ControlChart | None:
    """The exponentially weighted mean of figures (n,), which sees small lasting shifts; None below three figures.

    Notes
    -----
    z_i = λ x_i + (1 − λ) z_(i−1), variance σ² λ/(2 − λ) (1 − (1 − λ)^(2i)); σ from successive differences, which a
    drift hardly widens (mean moving range over 1.128; ISO 7870-6).
    """
    count = len(figures)
    if count < 3:
        return None
    centre = float(figures.mean())
    sigma = float(np.abs(np.diff(figures)).mean()) / 1.128379
    values, last = np.empty(count), centre
    for index, figure in enumerate(figures):
        last = values[index] = _MEMORY * figure + (1.0 - _MEMORY) * last
    grown = 1.0 - (1.0 - _MEMORY) ** (2.0 * np.arange(1, count + 1))
    half = _EWMA_LIMIT * sigma * np.sqrt(_MEMORY / (2.0 - _MEMORY) * grown)
    return ControlChart("ewma", values, centre, centre - half, centre + half)


def _groups(figures: Array, size: int) -> Array | None:
    count = len(figures) // size
    return None if count < 2 else np.asarray(figures[: count * size], dtype=float).reshape(count, size)


def _c4(size: int) -> float:
    """Mean of the standard deviation of ``size`` normal figures, over σ."""
    return float(np.sqrt(2.0 / (size - 1)) * np.exp(gammaln(size / 2) - gammaln((size - 1) / 2)))
