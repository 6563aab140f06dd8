# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a scan says of itself before anything is matched: point density and noise."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..splines import Array

_NEIGHBOURS = 16
_PROBES = 1500


@dataclass(frozen=True)
class ScanStatistics:
    """Medians over the scan.

    Attributes
    ----------
    density : points per mm²
    noise : standard deviation in mm about local planes
    """

    density: float
    noise: float


def scan_statistics(sample: Array, share: float) -> ScanStatistics:
    """Statistics from a random sample (n, 3) that is ``share`` of the scan."""
    tree = cKDTree(sample)
    probes = sample[:: max(1, len(sample) // _PROBES)]
    count = min(_NEIGHBOURS, len(sample))
    distance, near = tree.query(probes, k=count)
    area = np.pi * np.median(distance[:, -1]) ** 2
    local = sample[near] - sample[near].mean(axis=1, keepdims=True)
    smallest = np.linalg.eigvalsh(np.matmul(local.swapaxes(1, 2), local))[:, 0]
    noise = float(np.sqrt(np.median(np.maximum(smallest, 0)) / max(count - 3, 1)))
    return ScanStatistics(float((count - 1) / max(area, 1e-12) / share), max(noise, 1e-4))
