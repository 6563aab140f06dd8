# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's two cases, simulated: a plane welding sheet, its deformed surface, and the clouds measured on it.

The paper states neither the size of its sheet nor its deformation: both are a stand-in here, 75 × 70 mm with a smooth
deformation of about 5 mm. The deformed surface is a formula, so that distances to it are true.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...registration.arrays import Array
from ..simulated.sheet import NOISE, SIZE, height
from ..simulated.sheet import POINTS as MEASURED_POINTS

VIRTUAL_POINTS = 104_705
GAPS = 0.2
_EDGE_POINTS = 400
_STEPS = 20


@dataclass(frozen=True)
class PaperCase:
    """A case of the paper.

    Attributes
    ----------
    name : "virtual" or "measured"
    text : what it is, in a sentence
    target : T, (n, 3) in mm
    seen : share of the face's area on which T has points
    """

    name: str
    text: str
    target: Array
    seen: float

    @property
    def floor(self) -> float:
        """Mean distance in mm from a point of the true surface to its neighbour in an exact T: 0.5/√density."""
        return 0.5 / float(np.sqrt(len(self.target) / (self.seen * SIZE[0] * SIZE[1])))


def lifted(xy: Array) -> Array:
    """Points (n, 3) of the deformed sheet over (x, y)."""
    return np.column_stack([xy, height(*xy.T)])


def virtual_case(seed: int = 1) -> PaperCase:
    """Random points exactly on the deformed face, as many as the paper has."""
    xy = np.random.default_rng(seed).uniform((0, 0), SIZE, (VIRTUAL_POINTS, 2))
    return PaperCase("virtual", f"{VIRTUAL_POINTS:,} random points exactly on the deformed face", lifted(xy), 1.0)


def measured_case(seed: int = 1) -> PaperCase:
    """Points with noise in z and round gaps, as many as the paper's camera gave."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform((0, 0), SIZE, (2 * MEASURED_POINTS, 2))
    cells = np.stack(np.meshgrid(*(np.linspace(0, side, 150) for side in SIZE), indexing="ij"), axis=-1).reshape(-1, 2)
    gone, lost = np.zeros(len(xy), dtype=bool), np.zeros(len(cells), dtype=bool)
    while lost.mean() < GAPS:
        centre, radius = rng.uniform((0, 0), SIZE), rng.uniform(3, 7)
        gone |= np.hypot(*(xy - centre).T) < radius
        lost |= np.hypot(*(cells - centre).T) < radius
    points = lifted(xy[~gone][:MEASURED_POINTS])
    points[:, 2] += rng.normal(0, NOISE, len(points))
    text = f"{MEASURED_POINTS:,} simulated points, noise {NOISE} mm in z, {GAPS:.0%} of the face in round gaps"
    return PaperCase("measured", text, points, 1.0 - float(lost.mean()))


def true_distance(points: Array) -> Array:
    """Distance of points (n, 3) from the deformed surface (continued beyond its edges), (n,), by Newton's method."""
    xy = points[:, :2].copy()
    for _ in range(_STEPS):
        h = 1e-4
        ex, ey = np.array([h, 0.0]), np.array([0.0, h])
        z, right, left, up, down = (height(*(xy + e).T) for e in (0 * ex, ex, -ex, ey, -ey))
        gx, gy = (right - left) / (2 * h), (up - down) / (2 * h)
        gap = np.column_stack([points[:, :2] - xy, points[:, 2] - z])
        a, b, c = 1 + gx**2, gx * gy, 1 + gy**2
        ra, rb = gap[:, 0] + gx * gap[:, 2], gap[:, 1] + gy * gap[:, 2]
        determinant: Array = a * c - b * b
        step = np.column_stack([c * ra - b * rb, a * rb - b * ra]) / determinant[:, None]
        xy += step
        if np.abs(step).max() < 1e-9:
            break
    return np.linalg.norm(points - lifted(xy), axis=1)


def outline() -> Array:
    """(u, v) = (x, y) along the sheet's boundary, (400, 2)."""
    corners = np.array([[0, 0], [SIZE[0], 0], SIZE, [0, SIZE[1]], [0, 0]], dtype=float)
    along = np.linspace(0, 4, _EDGE_POINTS, endpoint=False)
    side = along.astype(int)
    share = (along - side)[:, None]
    return corners[side] * (1 - share) + corners[side + 1] * share


def edge_distance(points: Array) -> Array:
    """Distance of points (n, 3) from the true deformed boundary, (n,), to 1e-4 mm."""
    corners = np.array([[0, 0], [SIZE[0], 0], SIZE, [0, SIZE[1]], [0, 0]], dtype=float)
    along = np.linspace(0, 4, 40_000, endpoint=False)
    side = along.astype(int)
    share = (along - side)[:, None]
    return cKDTree(lifted(corners[side] * (1 - share) + corners[side + 1] * share)).query(points)[0]
