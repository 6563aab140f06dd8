# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams as a table: one row per station, one column per figure. Lengths in mm, angles in degrees."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...registration.arrays import Array
from ..frames import quaternions
from ..measured import MeasuredSeam

COLUMNS = ("s", "x", "y", "z", "tx", "ty", "tz", "n1x", "n1y", "n1z", "n2x", "n2y", "n2z", "qx", "qy", "qz", "qw",
           "gap", "band", "flag", "curvature", "work_angle", "travel_angle")
OFFSET_COLUMNS = ("lateral", "normal", "longitudinal", "opening_angle", "torch_rotation")
"""With a nominal model; ``opening_angle`` is its change from nominal to as-built."""
PLACE_COLUMNS = ("opening", "seam", "kind", "edge", "fraction")
"""The opening itself, and where the row belongs: seam from 1 on, EdgeN, and the fraction of its parameter range."""


def csv_text(seams: Sequence[MeasuredSeam]) -> str:
    """The table as CSV; an unknown gap or band is empty."""
    with_offsets = any(seam.offsets is not None for seam in seams)
    lines = [",".join(COLUMNS + (OFFSET_COLUMNS if with_offsets else ()) + PLACE_COLUMNS)]
    for number, seam in enumerate(seams, 1):
        lines += [",".join(row) for row in zip(*_columns(number, seam, with_offsets), strict=True)]
    return "\n".join(lines) + "\n"


def _columns(number: int, seam: MeasuredSeam, with_offsets: bool) -> list[list[str]]:
    stations = seam.stations
    count = len(stations)
    columns = _numbers(stations.places.arc_length[:, None], 6) + _numbers(stations.positions, 6)
    columns += _numbers(np.hstack([stations.tangents, stations.n1, stations.n2, quaternions(stations.torch)]), 9)
    columns += _numbers(np.stack([stations.gap, seam.bands], axis=1), 5) + [seam.flags.tolist()]
    angles = np.degrees(np.stack([stations.work_angle, np.full(count, stations.travel_angle)], axis=1))
    columns += _numbers(stations.curvature[:, None], 8) + _numbers(angles, 4)
    if with_offsets and seam.offsets is not None:
        offsets = seam.offsets
        columns += _numbers(np.stack([offsets.lateral, offsets.normal, offsets.longitudinal], axis=1), 6)
        columns += _numbers(np.degrees(np.stack([offsets.opening_change, offsets.rotation], axis=1)), 5)
    stretches = [stations.seam.stretches[i] for i in stations.places.stretch.tolist()]
    columns += _numbers(np.degrees(stations.opening)[:, None], 4) + [[str(number)] * count]
    columns += [[stretch.kind for stretch in stretches], [stretch.name for stretch in stretches]]
    return columns + _numbers(stations.places.fraction[:, None], 9)


def _numbers(values: Array, digits: int) -> list[list[str]]:
    """(n, k) as k columns of text; NaN is empty, and there is no minus zero."""
    return [["" if np.isnan(value) else f"{round(value, digits) + 0.0:.{digits}f}" for value in column]
            for column in values.T.tolist()]
