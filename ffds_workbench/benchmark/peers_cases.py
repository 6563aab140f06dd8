# SPDX-License-Identifier: LGPL-2.1-or-later
"""The clouds that the peers get: a clean scan of the deformed sheet, a dirty one, and one with correlated noise."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..registration.splines import Array
from ..scan.sensor.errors import correlated
from .paper_case import MEASURED_POINTS, NOISE, SIZE, height, lifted

_HIDDEN = 0.2
_CORRELATION = 1.5


def clean(seed: int, count: int = MEASURED_POINTS) -> Array:
    """Sheet A: points uniform in (x, y), white noise in z; (count, 3)."""
    rng = np.random.default_rng(seed)
    points = lifted(rng.uniform((0, 0), SIZE, (count, 2)))
    points[:, 2] += rng.normal(0, NOISE, count)
    return points


def dirty(seed: int, count: int = MEASURED_POINTS) -> Array:
    """Sheet D: a fifth hidden, 2 % gross outliers, 4 % on a wall beside it and 4 % on a sheet 1.5 mm below."""
    return _dirty(seed, count, lambda xy, rng: rng.normal(0, NOISE, len(xy)))


def dirty_correlated(seed: int, count: int = MEASURED_POINTS) -> Array:
    """Sheet E: sheet D with the noise correlated over 1.5 mm."""
    return _dirty(seed, count, lambda xy, rng: NOISE * correlated(xy, _CORRELATION, rng))


CASES: dict[str, Callable[..., Array]] = {"A": clean, "D": dirty, "E": dirty_correlated}


def _dirty(seed: int, count: int, noise: Callable[[Array, np.random.Generator], Array]) -> Array:
    rng = np.random.default_rng(seed)
    xy = rng.uniform((0, 0), SIZE, (count, 2))
    points = lifted(xy)
    points[:, 2] += noise(xy, rng)
    points = points[~_hidden(xy, rng)]
    gross = rng.uniform((-3, -3, -8), (78, 73, 14), (round(0.02 * count), 3))
    some = round(0.04 * count)
    wall = np.column_stack([np.full(some, SIZE[0]), rng.uniform(0, SIZE[1], some)])
    wall = np.column_stack([wall, height(wall) - rng.uniform(0, 8, some)])
    wall[:, 0] += rng.normal(0, NOISE, some)
    below = np.column_stack([rng.uniform(0, SIZE[0], some), rng.uniform(-6, 2.5, some)])
    below = np.column_stack([below, height(below) - 1.5 + rng.normal(0, NOISE, some)])
    return rng.permutation(np.concatenate([points, gross, wall, below]))


def _hidden(xy: Array, rng: np.random.Generator) -> np.ndarray:
    """Which points fall into a corner or into random discs that together hide a fifth of the sheet."""
    raster = np.stack(np.meshgrid(*(np.linspace(0, side, 151) for side in SIZE), indexing="ij"), axis=-1).reshape(-1, 2)
    gone, lost = (((p[:, 0] > 60) & (p[:, 1] < 5)) for p in (xy, raster))
    while lost.mean() < _HIDDEN:
        centre, radius = rng.uniform((0, 0), SIZE), rng.uniform(3, 7)
        gone |= np.hypot(*(xy - centre).T) < radius
        lost |= np.hypot(*(raster - centre).T) < radius
    return gone
