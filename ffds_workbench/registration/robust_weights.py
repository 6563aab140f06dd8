# SPDX-License-Identifier: LGPL-2.1-or-later
"""Weights and spreads that outliers do not move: Tukey's biweight, the median absolute deviation, quantiles.

The constants are theory: of a normal distribution the median absolute deviation is 1/1.4826 of the standard deviation,
and Tukey's weights cut off at 4.685 standard deviations have 95 % of the mean's efficiency (Huber and Ronchetti, Robust
Statistics, 2009).
"""
from __future__ import annotations

import numpy as np

from .arrays import Array

MAD_TO_SIGMA = 1.4826
"""Standard deviation over the median absolute deviation, of normal noise (theory)."""
TUKEY_SIGMAS = 4.685
"""Cut-off of Tukey's weights in standard deviations, for 95 % efficiency on normal noise (theory)."""
NOISE_ENDS_SIGMAS = 4.0
"""Standard deviations beyond which normal noise carries hardly any point: one in 16,000 (theory)."""


def tukey(residual: Array, cutoff: float | Array) -> Array:
    """Tukey's biweight (1 − (r/c)²)² of each ``residual`` r, zero beyond the ``cutoff`` c in the same unit; (n,)."""
    share = np.minimum(np.square(residual / cutoff), 1.0)
    return np.square(1 - share)


def robust_sigma(residual: Array) -> float:
    """Standard deviation of each ``residual`` (n,) about zero, from the median of their absolute values."""
    return MAD_TO_SIGMA * float(np.median(np.abs(residual)))


def quantile(values: Array, share: float) -> float:
    """One of the values (n > 0,), below which the share of them lies: numpy's method "lower", whose own function takes
    ten times as long for a few hundred of them."""
    rank = int(share * (len(values) - 1))
    return float(np.partition(values, rank)[rank])
