# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a scan alone shows, before anything is matched: point density and noise."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Array

_PLANE_NEIGHBOURS = 16
"""Points that a plane is put through, with the one in their middle (unit: few, as a surface is curved)."""
_SLAB_QUANTILES, _SLAB_POINTS, _PROBES_PER_SLAB = (0.2, 0.4, 0.6, 0.8), 5000, 200
"""Where across the scan its slabs lie, how many points they have, and how many of these are looked around (unit:
800 probes tell both medians to two per cent)."""


@dataclass(frozen=True)
class ScanStatistics:
    """Medians over the scan.

    Attributes
    ----------
    density : points per mm²
    noise : standard deviation in mm about local planes
    resolution : rounding of the coordinates in mm, as a standard deviation
    """

    density: float
    noise: float
    resolution: float


def scan_statistics(scan: Array) -> ScanStatistics:
    """Statistics of a scan (n, 3), from points in the middle of a few slabs across it, where it keeps its density."""
    across = scan[:, int(np.argmax(np.ptp(scan, axis=0)))]
    starts = np.unique([max(0, int(f * len(scan)) - _SLAB_POINTS // 2) for f in _SLAB_QUANTILES])
    bounds = np.unique(np.minimum([starts, starts + _SLAB_POINTS], len(scan) - 1))
    order = np.argpartition(across, bounds)
    slabs = [order[start : start + _SLAB_POINTS] for start in starts]
    density, noise = np.concatenate([_slab_statistics(scan[slab[np.argsort(across[slab])]]) for slab in slabs], axis=1)
    resolution = float(np.spacing(np.float32(np.abs(scan).max()))) / np.sqrt(12.0)
    return ScanStatistics(float(np.median(density)), max(float(np.median(noise)), resolution), resolution)


def _slab_statistics(slab: Array) -> Array:
    """Density and noise around probes in the inner half of a slab: (2, probes)."""
    inner = np.arange(len(slab) // 4, max(3 * len(slab) // 4, len(slab) // 4 + 1))
    probes = slab[inner[:: max(1, len(inner) // _PROBES_PER_SLAB)]]
    count = min(_PLANE_NEIGHBOURS, len(slab))
    distance, near = cKDTree(slab).query(probes, k=count)
    local = slab[near] - slab[near].mean(axis=1, keepdims=True)
    smallest = np.linalg.eigvalsh(np.matmul(local.swapaxes(1, 2), local))[:, 0]
    density = (count - 1) / np.maximum(np.pi * distance[:, -1] ** 2, 1e-12)
    return np.stack([density, np.sqrt(np.maximum(smallest, 0) / max(count - 3, 1))])
