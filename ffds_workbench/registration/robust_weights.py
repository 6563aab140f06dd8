# SPDX-License-Identifier: LGPL-2.1-or-later
"""Weights and spreads that outliers do not move."""
from __future__ import annotations

import numpy as np

from .arrays import Array


def tukey(residual: Array, cutoff: float | Array) -> Array:
    """Tukey's biweight (1 − (r/c)²)², zero beyond the cut-off c."""
    ratio = residual / cutoff
    return np.where(np.abs(ratio) < 1.0, (1.0 - ratio * ratio) ** 2, 0.0)


def quantile(values: Array, share: float) -> float:
    """One of the values (n > 0,), below which the share of them lies: numpy's method "lower", whose own function takes
    ten times as long for a few hundred of them."""
    rank = int(share * (len(values) - 1))
    return float(np.partition(values, rank)[rank])
