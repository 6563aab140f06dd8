# SPDX-License-Identifier: LGPL-2.1-or-later
"""All seams of a plan for one robot in its cell: each along its length, down to it and away, and on to the next."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..registration.arrays import Array
from ..seams.measured import MeasuredSeam
from ..seams.plan import SeamPlan
from ..seams.programs.moves import RobotSettings
from ..seams.trust import read_trust, trust_of
from .cells import Cell
from .clearance import MeshDistance, Moving, Surroundings, Facets, joined, triangles_of
from .planning import Course, Failure, SeamPath, leaving, plan_path, remedy, transfer

Progress = Callable[[str], object]


@dataclass(frozen=True)
class PlannedSeam:
    """A seam as the robot welds it.

    Attributes
    ----------
    seam : as it was measured
    path : along it, with what fails
    approach, retract : (6,) joints above its ends; None where it fails
    way : (k, 6) joints through the air to the approach, without both ends
    """

    seam: MeasuredSeam
    path: SeamPath
    approach: Array | None = None
    retract: Array | None = None
    way: Array | None = None

    @property
    def verdict(self) -> str:
        """"pass" or "fail"."""
        return "pass" if self.path.failure is None else "fail"

    def record(self) -> dict[str, Any]:
        """For the report: angles in rad, clearance in mm, None where there is none."""
        path = self.path
        rows = zip(path.joints, path.yaws, path.singularity, path.clearance, strict=True)
        stations = [{"joints": None if np.isnan(joints).any() else joints.tolist(), "yaw": float(yaw),
                     "singularity": float(singularity), "clearance": None if np.isnan(clear) else float(clear)}
                    for joints, yaw, singularity, clear in rows]
        failure = None if path.failure is None else path.failure.record()
        return {"name": self.seam.name, "verdict": self.verdict, "stations": stations, "first_failure": failure}

    def line(self) -> str:
        """One line for people."""
        failure = self.path.failure
        if failure is None:
            least = int(self.path.clearance.argmin())
            return (f"{self.seam.name}: pass; least clearance {self.path.clearance[least]:.1f} mm at station "
                    f"{least + 1}, least distance from singularity {self.path.singularity.min():.2f}")
        helps = f"; what helps: {failure.remedy}" if failure.remedy else ""
        return f"{self.seam.name}: fail ({failure.reason}): {failure.said}{helps}"


@dataclass(frozen=True)
class RobotPlan:
    """What a robot makes of the seams.

    Attributes
    ----------
    cell : the robot where it stands
    moving : the same, to measure with
    seams : in the order of the plan
    order : indices of those that can be welded, in the order in which they are
    """

    cell: Cell
    moving: Moving
    seams: tuple[PlannedSeam, ...]
    order: tuple[int, ...]

    def record(self) -> dict[str, Any]:
        """The report's ``robot``."""
        return {"name": self.cell.arm.name, "units": {"joints": "rad", "yaw": "rad", "clearance": "mm"},
                "seams": [seam.record() for seam in self.seams],
                "order": [self.seams[number].seam.name for number in self.order],
                "clearance_kept": self.cell.clearance, "unsure": list(self.cell.arm.unsure)}

    def table(self) -> str:
        """One line per seam, as text."""
        return "\n".join([f"Robot {self.cell.arm.name}", *(f"  {seam.line()}" for seam in self.seams)])


def plan_robot(plan: SeamPlan, cell: Cell, settings: RobotSettings | None = None,
               bands: str | Path | Mapping[str, Any] | None = None, progress: Progress = lambda text: None
               ) -> RobotPlan:
    """Find out how a robot welds the seams of a plan, and which it cannot.

    Parameters
    ----------
    plan : of ``plan_seams``
    cell : of ``read_cell``
    settings : velocity along the seams and distance of the approach
    bands : the registration's report or its file: faces stand out by their bands
    progress : told what is being done

    Raises
    ------
    InputError : the report of the bands cannot be read
    """
    settings = settings or RobotSettings()
    moving = _moving(plan, cell, bands)
    found = []
    for seam in plan.seams:
        progress(f"Planning {seam.name} for the {cell.arm.name}")
        found.append(_one(seam, moving, cell, settings))
    order, found = _ordered(found, moving, cell)
    return RobotPlan(cell, moving, tuple(found), tuple(order))


def _moving(plan: SeamPlan, cell: Cell, bands: str | Path | Mapping[str, Any] | None) -> Moving:
    part = triangles_of(plan.shape)
    names = [f"Face{number}" for number in range(1, len(plan.shape.Faces) + 1)]
    wide = np.full(len(names) + len(cell.meshes), np.nan)
    if bands is not None:
        trust = trust_of(bands) if isinstance(bands, Mapping) else read_trust(Path(bands))
        wide[: len(names)] = [trust.band(name) for name in names]
    meshes = [part]
    for number, (_, mesh) in enumerate(cell.meshes, len(names)):
        meshes.append(Facets(mesh.corners, mesh.faces + number, mesh.normals))
    around = Surroundings(MeshDistance(joined(meshes), wide), [*names, *(name for name, _ in cell.meshes)], cell.solids)
    return Moving(cell.arm, cell.base, cell.torch.tcp, cell.torch.about_the_wire, cell.torch.beside_the_wire, around)


def _one(seam: MeasuredSeam, moving: Moving, cell: Cell, settings: RobotSettings) -> PlannedSeam:
    stations = seam.stations
    course = Course(stations.torch, stations.positions, np.full(len(stations) - 1, settings.velocity))
    path = plan_path(moving, cell, course)
    if path.failure is not None:
        helps = remedy(moving, cell, course, path.failure)
        return PlannedSeam(seam, replace(path, failure=replace(path.failure, remedy=helps)))
    away = [leaving(moving, cell, path.tips[end], path.joints[end], settings.approach) for end in (0, -1)]
    for number, what in ((0, "approach to"), (1, "retract from")):
        if away[number] is None:
            station = number * (len(stations) - 1)
            failure = Failure(station, "approach", f"the {what} station {station + 1} is not free")
            return PlannedSeam(seam, replace(path, failure=failure))
    return PlannedSeam(seam, path, away[0], away[1])


def _ordered(seams: Sequence[PlannedSeam], moving: Moving, cell: Cell) -> tuple[list[int], list[PlannedSeam]]:
    """The nearest seam next, by the time that the slowest joint takes; and the ways in between."""
    found, order = list(seams), []
    left = [number for number, seam in enumerate(found) if seam.approach is not None]
    at = cell.home
    while left:
        if at is None:
            nearest = left[0]
        else:
            here = at
            nearest = min(left, key=lambda number: float(np.abs(
                (found[number].approach - here) / moving.arm.speeds).max()))  # type: ignore[operator]
        left.remove(nearest)
        seam = found[nearest]
        way = None if at is None else _way(moving, cell, at, seam.approach)
        if at is not None and way is None:
            failure = Failure(0, "transfer", "no way through the air was found to its approach")
            found[nearest] = replace(seam, path=replace(seam.path, failure=failure), approach=None)
            continue
        found[nearest] = replace(seam, way=np.empty((0, 6)) if way is None else way[1:-1])
        order.append(nearest)
        at = seam.retract
    return order, found


def _way(moving: Moving, cell: Cell, start: Array, end: Array | None) -> Array | None:
    if end is None:
        raise InputError("A seam without an approach has no way to it.")

    def free(joints: Array) -> NDArray[np.bool_]:
        result: NDArray[np.bool_] = moving.all(joints, cell.clearance + 1.0).distances >= cell.clearance
        return result

    return transfer(start, end, moving.arm.limits, free)
