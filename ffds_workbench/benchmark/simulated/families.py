# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cases with known truth: a part of a family, a deformation in closed form, a simulated scan.

A case is a folder ``nominal.step``, ``scan.ply``, ``truth.npz``, ``case.json``. The truth comes from the deformation's
formula and the nominal surfaces; nothing of the registration or the rebuild takes part in it.
"""
from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ...brep.simulated_scan import edge_points, scene_of
from ...registration.arrays import Array
from ...scan.sensor import Scene, SensorSettings, SimulatedScan, Truth, View, make_truth, simulate
from ...scan.sensor.camera import place
from ...scan.sensor.files import write_ply
from . import warps
from .parts import FAMILIES, FamilyPart

WARPS = ("iso", "springback", "mix", "bumps", "twist", "bend")
SCANS: dict[str, dict[str, Any]] = {
    "clean": {},
    "one-view": {},
    "one-view with normals": {},
    "dirty": {"correlation": 1.5, "correlated_share": 0.3, "holes": 6, "outliers": 0.02, "table": 1.0,
              "edge_dropout": 0.5},
}
"""Settings of the sensor by name; the views come from the family."""
_NEIGHBOURS = 20
"""Points that a normal is estimated from: with the noise of the sensor it is off by some degrees."""


@dataclass(frozen=True)
class Case:
    """A part, its deformation, its scan and the truth."""

    family: str
    warp: str
    scan_name: str
    seed: int
    part: FamilyPart
    target: Scene
    scan: SimulatedScan
    truth: Truth
    normals: Array | None = None

    @property
    def largest_displacement(self) -> float:
        """In mm, over the truth's points."""
        return float(np.linalg.norm(self.truth.warped - self.truth.nominal, axis=1).max())

    @property
    def visible_faces(self) -> list[str]:
        """Names of the faces of which a view sees at least a tenth."""
        count = len(self.target.faces)
        seen = np.bincount(self.truth.face, self.truth.visible, count) / np.bincount(self.truth.face, minlength=count)
        return [f"Face{i + 1}" for i in np.flatnonzero(seen >= 0.1)]

    def write(self, folder: Path) -> None:
        """Write the case into a folder, which is made."""
        folder.mkdir(parents=True, exist_ok=True)
        self.part.shape.exportStep(str(folder / "nominal.step"))
        write_ply(folder / "scan.ply", self.scan.points, self.normals)
        self.truth.write(folder / "truth.npz")
        about = {"part": self.family, "warp": self.warp, "scan_settings": self.scan_name, "seed": self.seed,
                 "points": len(self.scan.points), "faces": len(self.target.faces), "visible_faces": self.visible_faces,
                 "max_disp": self.largest_displacement, "unit": "mm", "sheet": self.part.thickness}
        (folder / "case.json").write_text(json.dumps(about, indent=1) + "\n")


def make_case(family: str, warp: str, seed: int, scan_name: str = "clean", amplitude: float = 2.0) -> Case:
    """Draw a part, deform it and scan it; the same arguments give the same case.

    Parameters
    ----------
    family : one of `FAMILIES`
    warp : one of `WARPS`; "springback" needs a bent sheet
    scan_name : one of `SCANS`
    amplitude : largest displacement in mm, roughly for "iso" and "springback", which cannot be scaled
    """
    rng = np.random.default_rng([seed, sorted(FAMILIES).index(family), WARPS.index(warp)])
    part = through_step(FAMILIES[family](rng))
    move = deformation(part, warp, amplitude, rng)
    directions = part.views[:1] if scan_name.startswith("one-view") else part.views
    directions = directions + rng.normal(0.0, 0.06, directions.shape)
    settings = SensorSettings(spacing=0.35, views=tuple(View((x, y, z)) for x, y, z in directions),
                              seed=int(rng.integers(2**31)), **SCANS[scan_name])
    target, scan, truth = scanned(part, move, settings)
    normals = sensed_normals(scan, target, settings) if scan_name.endswith("with normals") else None
    return Case(family, warp, scan_name, seed, part, target, scan, truth, normals)


def scanned(part: FamilyPart, move: warps.Warp, settings: SensorSettings) -> tuple[Scene, SimulatedScan, Truth]:
    """The deformed part, a scan of it, and the truth about both."""
    target = scene_of(part.shape, {i: lambda _, points: move(points) - points for i in range(len(part.shape.Faces))})
    before = edge_points(part.shape)
    after = move(before.reshape(-1, 3)).reshape(before.shape)
    return target, simulate(target, settings), make_truth(target, settings, before, after, part.thickness)


def sensed_normals(scan: SimulatedScan, target: Scene, settings: SensorSettings) -> Array:
    """Normals as a sensor writes them, (n, 3): of the planes through neighbouring points of a shot, to its camera."""
    import open3d

    normals = np.zeros_like(scan.points)
    for number, view in enumerate(settings.views):
        own = scan.shot == number
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(scan.points[own]))
        cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(_NEIGHBOURS))
        cloud.orient_normals_towards_camera_location(place(view, target.centre, settings.standoff).position)
        normals[own] = np.asarray(cloud.normals)
    return normals


def deformation(part: FamilyPart, warp: str, amplitude: float, rng: np.random.Generator) -> warps.Warp:
    """A deformation of that kind with parameters drawn for the part."""
    box = part.shape.BoundBox
    low, high = np.array([box.XMin, box.YMin, box.ZMin]), np.array([box.XMax, box.YMax, box.ZMax])
    points = edge_points(part.shape).reshape(-1, 3)
    size = high - low
    long = 1 if size[1] >= size[0] else 0
    if warp == "iso":
        radius = (0.5 * np.hypot(size[0], size[1])) ** 2 / (2 * amplitude)
        return warps.roll(radius, rng.uniform(0, np.pi), 0.5 * (low + high))
    if warp == "springback":
        if part.profile is None:
            raise ValueError("springback opens the bends of a bent sheet")
        one = warps.springback(part.profile, 0.995, part.held)
        factor = 1 - 0.005 * amplitude / np.linalg.norm(one(points) - points, axis=1).max()
        return warps.springback(part.profile, factor, part.held)
    if warp == "bend":
        return warps.scaled(warps.bend(1.0, 2, long, (low, high)), amplitude, points)
    if warp == "twist":
        return warps.scaled(warps.twist(0.05, long, (low, high)), amplitude, points)
    width = rng.uniform(0.25, 0.4) * float(np.sort(size)[1:].mean())
    bumps = warps.bumps(1.0, width, 4, (low, high), rng)
    if warp == "bumps":
        return warps.scaled(bumps, amplitude, points)
    mixed = warps.chain(warps.bend(1.0, 2, long, (low, high)), warps.twist(0.02, long, (low, high)), bumps)
    return warps.scaled(mixed, amplitude, points)


def through_step(part: FamilyPart) -> FamilyPart:
    """The part as it reads back from STEP, so that faces and edges are numbered as in the file."""
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "part.step")
        part.shape.exportStep(path)
        shape = Part.read(path)
    if shape.ShapeType == "Compound" and len(shape.childShapes()) == 1:
        shape = shape.childShapes()[0]
    return replace(part, shape=shape)
