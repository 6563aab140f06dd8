# SPDX-License-Identifier: LGPL-2.1-or-later
"""The methods under one name each, and the accuracy of what they give on the paper's sheet."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from ...registration.face import FaceRegistration, register_ffd, register_ffds, register_robust
from ..simulated.sheet import nominal
from .paper_case import PaperCase, edge_distance, lifted, outline, true_distance

METHODS: dict[str, Callable[..., FaceRegistration]] = {
    "ffds": lambda scan, lattice, points: register_ffds(nominal(), scan, lattice, points, overshoot=np.inf),
    "ffd_hsu": lambda scan, lattice, points: register_ffd(nominal(), scan, lattice, points),
    "robust": lambda scan, lattice, points: register_robust(nominal(), scan, lattice),
}
"""(scan, (N_i, N_j), source points) to the registration; ``robust`` uses all scan points instead of source points."""

TITLES = {"ffds": "FFDS", "ffd_hsu": "FFD-HSU", "robust": "robust FFDS"}
_TRUE_POINTS = 20_000
_GAP = 1.0
"""Where T has no point within this distance in mm, it has a gap."""


@dataclass(frozen=True)
class Accuracy:
    """Accuracy in mm.

    Attributes
    ----------
    paper_metric : mean distance from M, random on the deformed result, to its neighbour in T; M is as dense as T and
        independent of it, and leaves out T's gaps
    paper_metric_same_uv : the same with M at the (u, v) of T
    floor : 0.5/√density, what ``paper_metric`` is for a perfect result if T is exact
    perfect : what ``paper_metric`` is for a perfect result against this T, noise included
    true_mean, true_p95 : distance of the result from the true surface
    edge_mean : distance of the result's boundary from the true boundary
    """

    paper_metric: float
    paper_metric_same_uv: float
    floor: float
    perfect: float
    true_mean: float
    true_p95: float
    edge_mean: float

    def as_dict(self) -> dict[str, float]:
        return asdict(self)


class Judge:
    """Measures results against one case; holds what does not change between them."""

    def __init__(self, case: PaperCase, seed: int = 7) -> None:
        self.case = case
        self.tree = cKDTree(case.target)
        u0, u1, v0, v1 = nominal().surface.range
        uv = np.random.default_rng(seed).uniform((u0, v0), (u1, v1), (len(case.target), 2))
        self.same_uv = np.clip(case.target[:_TRUE_POINTS, :2], (u0, v0), (u1, v1))
        self.everywhere = uv[:_TRUE_POINTS]
        self.uv = uv[cKDTree(case.target[:, :2]).query(uv, distance_upper_bound=_GAP)[0] < _GAP]
        self.perfect = float(self.tree.query(lifted(self.uv))[0].mean())

    def accuracy(self, result: FaceRegistration) -> Accuracy:
        """The figures of one registration; the true distance counts in the gaps too."""
        metric, same = (float(self.tree.query(deformed(result, uv))[0].mean()) for uv in (self.uv, self.same_uv))
        true = true_distance(deformed(result, self.everywhere))
        edge = edge_distance(deformed(result, outline()))
        return Accuracy(metric, same, self.case.floor, self.perfect, float(true.mean()),
                        float(np.percentile(true, 95)), float(edge.mean()))


def deformed(result: FaceRegistration, uv: Array) -> Array:
    """Points of the deformed sheet at (u, v), (n, 2) to (n, 3)."""
    return nominal().surface(uv) + result.displacement(uv)
