# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes one case of the world benchmark: any shape, a deformation in closed form, a scan with occlusion, the truth.

Everything is in proportion to the part, so that a part of any size is seen in the same way.
"""
from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import Part
from numpy.typing import NDArray

from ...brep.simulated_scan import edge_points
from ...registration.arrays import Array
from ...scan.sensor.files import write_ply
from ..simulated import warps
from ..simulated.warps import Warp
from .exact_samples import ExactSamples, Triangles, draw, triangulate
from .scene import WarpedScene
from .settings import ScanSettings

_TRUTH_POINTS = 300
"""On each face: the mean of its errors is then known within 1/√300 of their spread."""
_BUMP = 0.1, 0.1
"""Width of the bump (a Gaussian's σ) of the part's length, and its height of the width: slopes up to 6 %."""


class WorldTruth(NamedTuple):
    """What is known of a case, lengths in mm; the arrays of ``truth.npz``.

    Attributes
    ----------
    nominal, warped : (n, 3) points of the faces before and after; ``face`` (n,) index, ``uv`` (n, 2) on the nominal
    visible : (n,) whether a view sees them
    edges_nominal, edges : (m, k, 3) points along every edge before and after
    """

    nominal: Array
    warped: Array
    face: NDArray[np.intp]
    uv: Array
    visible: NDArray[np.bool_]
    edges_nominal: Array
    edges: Array


def make(shape: Part.Shape, deformation: str, settings: ScanSettings, folder: Path) -> None:
    """Write ``scan.ply`` and ``truth.npz`` of a deformed shape into a folder."""
    rng = np.random.default_rng(settings.seed)
    triangles = triangulate(shape)
    still = draw(shape, triangles, np.full(len(shape.Faces), _TRUTH_POINTS), rng)
    warp = _deformation(deformation, triangles, still, rng)
    scene = WarpedScene(triangles, shape, settings.views, warp)
    edges = edge_points(shape)
    moved = warp(edges.reshape(-1, 3)).reshape(edges.shape)
    truth = WorldTruth(still.points, warp(still.points), still.face, still.uv, scene.seen(still), edges, moved)
    np.savez_compressed(folder / "truth.npz", **truth._asdict())
    points, normals = _scan(shape, triangles, scene, settings, rng)
    write_ply(folder / "scan.ply", points, normals if settings.normals else None)


def _scan(shape: Part.Shape, triangles: Triangles, scene: WarpedScene, settings: ScanSettings, rng: np.random.Generator
          ) -> tuple[Array, Array]:
    """Points (n, 3) with noise, uniform over what is seen, and their normals."""
    area = np.bincount(triangles.face, np.linalg.norm(triangles.area_vectors, axis=1), len(shape.Faces))
    trial = draw(shape, triangles, rng.multinomial(_TRUTH_POINTS * 20, area / area.sum()), rng)
    share = max(scene.seen(trial).mean(), 0.02)
    count = int(1.1 * settings.points / share)
    drawn = draw(shape, triangles, rng.multinomial(count, area / area.sum()), rng)
    seen = rng.permutation(np.flatnonzero(scene.seen(drawn)))[: settings.points]
    normals = scene.normals(drawn)[seen]
    noise = settings.sigma * settings.scale * rng.normal(size=(len(seen), 1))
    return scene.warp(drawn.points[seen]) + noise * normals, normals


def bent_and_twisted(amplitude: float, low: Array, high: Array) -> Warp:
    """Rolled along the longest side of the box, so that it sags by ``amplitude`` mm and the middle plane keeps its
    lengths, then twisted about that side until the corners at its ends are ``amplitude`` mm apart."""
    order = np.argsort(low - high)
    size, box = (high - low)[order], (low[order], high[order])
    radius = size[0] ** 2 / (8 * amplitude)
    move = warps.chain(warps.roll(radius, 0.0, 0.5 * (box[0] + box[1])),
                       warps.twist(2 * amplitude / np.hypot(size[1], size[2]), 0, box))
    return lambda points: move(points[:, order])[:, np.argsort(order)]


def _deformation(name: str, triangles: Triangles, samples: ExactSamples, rng: np.random.Generator) -> Warp:
    corners = triangles.points.reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    length = float((high - low).max())
    if name == "none":
        return warps.still
    if name.startswith("bent-"):
        return bent_and_twisted(0.01 * float(name.removeprefix("bent-")) * length, low, high)
    middle, width = rng.integers(len(samples.points)), _BUMP[0] * length
    return warps.bump(samples.points[middle], _BUMP[1] * width * samples.normals[middle], width)
