# SPDX-License-Identifier: LGPL-2.1-or-later
"""The synthetic sheet: the robust method and the published one on many scans, and plain least squares that knows which
points are the sheet's."""
from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ...registration.arrays import Array
from ...registration.face import FaceRegistration, register_ffds, register_robust
from ...registration.face_geometry import FaceGeometry
from ..simulated import sheet
from .accuracy_cases import figures

Progress = Callable[[str], None]

SHEETS = {"A": "noise alone, σ = 0.13 mm", "D": "a fifth hidden, 2 % outliers, 8 % of other faces",
          "E": "as D, noise correlated over 1.5 mm"}
SEEDS = {"A": 20, "D": 100, "E": 50}
METHODS: dict[str, Callable[[FaceGeometry, Array], FaceRegistration]] = {
    "robust": register_robust,
    "ffds": lambda face, scan: register_ffds(face, scan, (10, 10), 400),
}
LEAST_SQUARES = "least squares on true inliers"
FIGURES = ("mean", "p95", "max")
_BENDS = 5


def measure(kind: str, seeds: int, progress: Progress) -> dict[str, Any]:
    """Figures of each method over the scans of one kind of sheet; ``seeds`` scans for the robust method and for least
    squares, a fifth of them for the published one, which hardly varies."""
    face = sheet.nominal()
    rows: dict[str, list[Any]] = {name: [] for name in (*METHODS, LEAST_SQUARES)}
    for seed in range(seeds):
        progress(f"Sheet {kind}, scan {seed + 1} of {seeds}")
        scan = sheet.scan(kind, seed)
        for name, method in METHODS.items():
            if name == "robust" or seed < max(1, seeds // 5):
                start = time.perf_counter()
                registration = method(face, scan)
                seconds = time.perf_counter() - start
                rows[name].append(_row(sheet.deviation(registration.displacement), seconds))
        start = time.perf_counter()
        rows[LEAST_SQUARES].append(_row(sheet.least_squares_deviation(kind, seed), time.perf_counter() - start))
    return {name: _summary(items) for name, items in rows.items()}


def _row(deviations: Array, seconds: float) -> dict[str, float]:
    return (figures(deviations) or {}) | {"seconds": seconds}


def _summary(rows: list[dict[str, float]]) -> dict[str, float]:
    summary = {key: float(np.mean([row[key] for row in rows])) for key in FIGURES}
    medians = {f"median_{key}": float(np.median([row[key] for row in rows])) for key in (*FIGURES, "seconds")}
    return summary | medians | {"worst": max(row["max"] for row in rows), "seeds": len(rows)}


def bend(progress: Progress, scans: int = _BENDS) -> dict[str, Any]:
    """Surface and edges of a sheet rolled on a cylinder, one face by itself."""
    face, rolled, result = sheet.nominal(), sheet.Bend(), {}
    for name, method in METHODS.items():
        progress(f"Bent sheet, {name}")
        fields = [method(face, rolled.scan(seed)).displacement for seed in range(scans)]
        surface = figures(np.concatenate([rolled.deviation(field) for field in fields]))
        edge = figures(np.concatenate([rolled.edge_deviation(field) for field in fields]))
        result[name] = {"surface": surface, "edge": edge}
    return result
