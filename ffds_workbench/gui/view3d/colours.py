# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colours of a deviation, the same in the 3D view, the legend and the pictures of the report."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...report.picture import COLOURS

Array = NDArray[np.float64]

NO_DATA = 0xB4BAC2FF
WITHIN = 0x6FAE6BFF
"""Colour of deviations inside the tolerance band."""
_STOPS = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in COLOURS], dtype=float)


SMOOTH, PASS_FAIL = 0, -1
"""Numbers of steps that stand for a smooth scale, and for nothing but within the tolerance, above and below it."""
_ABOVE, _BELOW = 0xC9352BFF, 0x2F7FC8FF


def packed_colours(values: Array, limit: float, tolerance: float = 0.0, steps: int = SMOOTH) -> NDArray[np.uint32]:
    """0xRRGGBBAA of deviations (n,) in mm: the scale ends at ±``limit``, in ``steps`` of one colour each
    (or `SMOOTH`, `PASS_FAIL`); ±``tolerance`` is one green, NaN grey."""
    if steps == PASS_FAIL:
        packed = np.where(values > 0, np.uint32(_ABOVE), np.uint32(_BELOW))
        packed[np.abs(values) <= tolerance] = WITHIN
        packed[np.isnan(values)] = NO_DATA
        return packed.astype(np.uint32)
    place = np.clip(0.5 + 0.5 * np.nan_to_num(values) / max(limit, 1e-9), 0, 1)
    if steps:
        place = (np.minimum(np.floor(place * steps), steps - 1) + 0.5) / steps
    place *= len(_STOPS) - 1
    stops = np.arange(len(_STOPS))
    rgb = np.stack([np.interp(place, stops, channel) for channel in _STOPS.T], axis=-1).astype(np.uint32)
    packed = (rgb[..., 0] << 24) | (rgb[..., 1] << 16) | (rgb[..., 2] << 8) | 0xFF
    if tolerance > 0:
        packed[np.abs(values) <= tolerance] = WITHIN
    packed[np.isnan(values)] = NO_DATA
    return packed.astype(np.uint32)


def good_limit(values: Array) -> float:
    """Half the colour scale: nearly all of the deviations, rounded up to a readable number of mm."""
    size = max(float(np.percentile(np.abs(values), 97)), 1e-4) if len(values) else 1.0
    step = 10.0 ** np.floor(np.log10(size))
    return float(np.ceil(size / step * 2) / 2 * step)
