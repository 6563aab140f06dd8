# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rigid pose from a few picked pairs of points, from which an alignment can start."""
from __future__ import annotations

import numpy as np

from ...errors import InputError
from ..arrays import Array
from ..motions import best_fit

_COLLINEAR = 0.05
"""Points this near to a line, as a share of their spread along it, leave the turn about it open (unit)."""
_SIDE_TOLERANCE = 0.25
"""Sides of the two triangles may differ by this share of the longest (unit: scans are deformed, and picks are by
hand)."""


def pose_of_pairs(on_scan: Array, on_model: Array) -> Array:
    """T_model_scan, (4, 4), that brings points of the scan onto those of the model best, in the least squares.

    Parameters
    ----------
    on_scan, on_model : (n, 3) each, in mm, n ≥ 3, pair by pair

    Raises
    ------
    InputError : fewer than three pairs, points on a line, or figures that do not match
    """
    scan, model = np.asarray(on_scan, dtype=float), np.asarray(on_model, dtype=float)
    if scan.shape != model.shape or scan.ndim != 2 or scan.shape[1] != 3 or len(scan) < 3:
        raise InputError("The start takes three or more points on the scan and as many on the part, in the same order.")
    for name, points in (("scan", scan), ("part", model)):
        spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if spread[1] <= _COLLINEAR * spread[0]:
            raise InputError(f"The points on the {name} lie on a line: pick three that span a triangle.")
    sides_scan, sides_model = (np.linalg.norm(points[:, None] - points, axis=2) for points in (scan, model))
    if np.abs(sides_scan - sides_model).max() > _SIDE_TOLERANCE * sides_model.max():
        raise InputError("The points on the scan and on the part span different triangles: pick the same places in the "
                         "same order, and check the unit of the scan.")
    return best_fit(scan, model)
