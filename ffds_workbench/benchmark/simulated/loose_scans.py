# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scans as they come to an alignment: lying anywhere, cropped, on a table, with stray points; deformed parts."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import Part
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ...brep import workpiece
from ...brep.simulated_scan import scene_of
from ...registration.arrays import Array
from ...registration.motions import best_fit, motion
from ...registration.rigid import Target, target_of
from ...scan.sensor import SensorSettings, View, simulate
from .families import deformation
from .parts import FamilyPart

CONDITIONS = ("rigid", "deformed", "25 % cropped", "table with 60 % of the points", "10 % stray points")
_WARPS = ("bend", "twist", "mix", "bumps")
_LARGEST_DEFORMATION = 0.04
"""Of the part's size, the largest displacement: 5 mm on the parts of the benchmark of the alignment."""
_SPACING, _NOISE = 0.0045, 0.0012
"""Of the part's size: 0.5 and 0.13 mm on a part of 110 mm."""
_ELEVATIONS = (35.0, 60.0)


@dataclass(frozen=True)
class LoosePart:
    """A part and its scans, each with the pose (4, 4) that an alignment has to find; by `CONDITIONS`."""

    family: str
    target: Target
    scans: dict[str, tuple[Array, Array]]


def loose_parts(families: dict[str, Callable[[np.random.Generator], Part.Shape]], count: int,
                seed: int) -> Iterator[LoosePart]:
    """Draw ``count`` parts of the families in turn, and scan them."""
    names = list(families)
    for number in range(count):
        family = names[number % len(names)]
        rng = np.random.default_rng([seed, number])
        shape = families[family](rng)
        part = workpiece.read(shape)
        target = target_of([part.geometry(k) for k in range(len(part.faces))])
        yield LoosePart(family, target, _scans(shape, target, rng))


def _scans(shape: Part.Shape, target: Target, rng: np.random.Generator) -> dict[str, tuple[Array, Array]]:
    up = float(rng.choice((-1.0, 1.0)))
    around, above = rng.uniform(0, 2 * np.pi) + 2 * np.pi / 3 * np.arange(3), np.deg2rad(rng.uniform(*_ELEVATIONS, 3))
    views = np.stack([np.cos(above) * np.cos(around), np.cos(above) * np.sin(around), up * np.sin(above)], axis=1)
    settings = SensorSettings(_SPACING * target.size, _NOISE * target.size, seed=int(rng.integers(2**31)),
                              views=tuple(View((x, y, z)) for x, y, z in views))
    scan = simulate(scene_of(shape), settings).points
    move = deformation(FamilyPart(shape, views), str(rng.choice(_WARPS)),
                       rng.uniform(0.25, 1.0) * _LARGEST_DEFORMATION * target.size, rng)
    bent = simulate(scene_of(shape, {k: lambda _, points: move(points) - points for k in range(len(shape.Faces))}),
                    settings).points
    whole = target.everywhere
    stray = rng.uniform(scan.min(axis=0), scan.max(axis=0), (len(scan) // 10, 3))
    along = scan @ rng.normal(size=3)
    right = np.eye(4)
    return dict(zip(CONDITIONS, (
        (scan, right), (bent, best_fit(move(whole.points), whole.points, whole.area)),
        (scan[along < np.quantile(along, 0.75)], right),
        (table_under(rng.permutation(scan), target, views.mean(axis=0), _NOISE * target.size, rng), right),
        (np.concatenate([scan, stray]), right)), strict=True))


def table_under(scan: Array, target: Target, up: Array, noise: float, rng: np.random.Generator,
             share: float = 0.6) -> Array:
    """Part of a scan in random order, with a table under it that carries a share of all points and has none in the
    part's shadow; ``noise`` in mm."""
    up = up / np.linalg.norm(up)
    across = np.linalg.svd(up[None])[2][1:]
    count = int(share * len(scan))
    place = target.centre @ across.T + rng.uniform(-1.0, 1.0, (3 * count, 2)) * target.size
    shadow = cKDTree(target.samples.points @ across.T).query(place, distance_upper_bound=target.spacing)[0]
    place = place[~np.isfinite(shadow)][:count]
    height = (target.samples.points @ up).min() + rng.normal(0.0, noise, len(place))
    return np.concatenate([scan[count:], place @ across + height[:, None] * up])


def random_start(scan: Array, mode: str, rng: np.random.Generator) -> Array:
    """A motion of the scan: any for "global", 30° and 50 mm about its centroid for "fine"; (4, 4)."""
    middle = scan.mean(axis=0)
    if mode == "global":
        rotation = Rotation.random(random_state=int(rng.integers(2**31))).as_matrix()
        return motion(rotation, rng.uniform(-500, 500, 3))
    axis, direction = (v / np.linalg.norm(v) for v in rng.normal(size=(2, 3)))
    rotation = Rotation.from_rotvec(np.deg2rad(30) * axis).as_matrix()
    return motion(rotation, middle - rotation @ middle + 50.0 * direction)
