# SPDX-License-Identifier: LGPL-2.1-or-later
"""All seams of a plan for one robot in its cell: each along its length, down to it and away, and on to the next."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..registration.arrays import Array
from ..seams.measured import MeasuredSeam
from ..seams.plan import SeamPlan
from ..seams.programs.moves import RobotSettings
from ..seams.trust import read_trust, trust_of
from .cells import Cell
from .clearance import MeshDistance, Moving, Surroundings, Facets, joined, triangles_of
from .planning import (APPROACH, PROCESS, SEARCH, TRANSFER, Course, Failure, SeamPath, leaving, plan_path, remedy,
                       transfer)
from .process import USUAL_TOLERANCE, Process, Welding, runs, welding_of
from .searches import Search, is_needed, searches_of

Progress = Callable[[str], object]


@dataclass(frozen=True)
class SeamPiece:
    """A part of a seam that is welded at once, all of it as a rule.

    Attributes
    ----------
    first, last : stations
    approach, retract : (6,) joints above its ends
    way : (k, 6) joints through the air to the approach, without both ends
    """

    first: int
    last: int
    approach: Array
    retract: Array
    way: Array = field(default_factory=lambda: np.empty((0, 6)))


@dataclass(frozen=True)
class PlannedSeam:
    """A seam as the robot welds it.

    Attributes
    ----------
    seam : as it was measured
    path : along it, with what fails
    pieces : what of it is welded; none where it fails
    welding : by which rows of the process; None without one
    searches : the touches before it
    """

    seam: MeasuredSeam
    path: SeamPath
    pieces: tuple[SeamPiece, ...] = ()
    welding: Welding | None = None
    searches: tuple[Search, ...] = ()

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
        refused = () if self.welding is None else self.welding.refused
        return {"name": self.seam.name, "verdict": self.verdict, "stations": stations, "first_failure": failure,
                "searches": [{"station": search.station, "face": search.face, "from": search.start[:3, 3].tolist(),
                              "to": search.end[:3, 3].tolist()} for search in self.searches],
                "not_welded": [{"from": first, "to": last, "said": said} for first, last, said in refused]}

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
    order : the pieces that are welded, in the order in which they are: index of the seam, and of its piece; none of
        seams beyond their limits unless they are kept
    process : None where none was given
    """

    cell: Cell
    moving: Moving
    seams: tuple[PlannedSeam, ...]
    order: tuple[tuple[int, int], ...]
    process: Process | None

    def record(self) -> dict[str, Any]:
        """The report's ``robot``."""
        return {"name": self.cell.arm.name, "units": {"joints": "rad", "yaw": "rad", "clearance": "mm"},
                "seams": [seam.record() for seam in self.seams],
                "order": list(dict.fromkeys(self.seams[number].seam.name for number, _ in self.order)),
                "clearance_kept": self.cell.clearance, "unsure": list(self.cell.arm.unsure)}

    def table(self) -> str:
        """One line per seam, as text."""
        return "\n".join([f"Robot {self.cell.arm.name}", *(f"  {seam.line()}" for seam in self.seams)])


def plan_robot(plan: SeamPlan, cell: Cell, settings: RobotSettings | None = None,
               bands: str | Path | Mapping[str, Any] | None = None, process: Process | None = None,
               searching: bool = True, progress: Progress = lambda text: None) -> RobotPlan:
    """Find out how a robot welds the seams of a plan, and which it cannot.

    Parameters
    ----------
    plan : of ``plan_seams``
    cell : of ``read_cell``
    settings : velocity along the seams, distance of the approach, and whether seams beyond their limits are welded
    bands : the registration's report or its file: faces stand out by their bands
    process : of ``read_process``; its speeds count then
    searching : plan touches where a seam is less sure than the process needs
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
        found.append(_one(seam, moving, cell, settings, process, searching))
    wanted = [settings.keep_failing or not seam.exceeded(plan.limits) for seam in plan.seams]
    order, found = _ordered(found, wanted, moving, cell)
    return RobotPlan(cell, moving, tuple(found), tuple(order), process)


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


def _one(seam: MeasuredSeam, moving: Moving, cell: Cell, settings: RobotSettings, process: Process | None,
         searching: bool) -> PlannedSeam:
    stations = seam.stations
    velocities = np.full(len(stations) - 1, settings.velocity)
    welding = None if process is None else welding_of(process, seam)
    if welding is not None and welding.rows:
        velocities = np.array([row.speed for row in welding.rows])[welding.row]
    course = Course(stations.torch, stations.positions, velocities)
    path = plan_path(moving, cell, course)

    def failed(failure: Failure) -> PlannedSeam:
        return PlannedSeam(seam, replace(path, failure=failure), (), welding)

    if path.failure is not None:
        return failed(replace(path.failure, remedy=remedy(moving, cell, course, path.failure)))
    parts = _parts(len(stations), welding)
    if welding is not None and not parts:
        return failed(Failure(welding.refused[0][0], PROCESS, welding.refused[0][2]))
    searches: tuple[Search, ...] = ()
    if searching and is_needed(seam, USUAL_TOLERANCE if process is None else process.tolerance):
        touches = searches_of(seam, path.tips, path.joints, moving, cell)
        if touches is None:
            return failed(Failure(0, SEARCH, "it is less sure than it must be, and a touch of it is not free"))
        searches = touches
    pieces = []
    for first, last in parts:
        away = [leaving(moving, cell, path.tips[end], path.joints[end], settings.approach) for end in (first, last)]
        if away[0] is None or away[1] is None:
            station, what = (first, "approach to") if away[0] is None else (last, "retract from")
            return failed(Failure(station, APPROACH, f"the {what} station {station + 1} is not free"))
        pieces.append(SeamPiece(first, last, away[0], away[1]))
    return PlannedSeam(seam, path, tuple(pieces), welding, searches)


def _parts(count: int, welding: Welding | None) -> list[tuple[int, int]]:
    """First and last station of what is left between the stretches that the process refuses."""
    kept = np.ones(count - 1, dtype=bool)
    for first, last, _ in () if welding is None else welding.refused:
        kept[first:last] = False
    return [(int(run[0]), int(run[-1]) + 1) for run in runs(kept)]


def _ordered(seams: Sequence[PlannedSeam], wanted: Sequence[bool], moving: Moving, cell: Cell
             ) -> tuple[list[tuple[int, int]], list[PlannedSeam]]:
    """The nearest piece next, by the time that the slowest joint takes; and the ways in between.

    Every way begins where the piece before it in the order ends: a piece that is not welded must not be in it.

    Parameters
    ----------
    wanted : which seams are welded
    """
    found, order = list(seams), list[tuple[int, int]]()
    left = [(number, part) for number, seam in enumerate(found) if wanted[number] for part in range(len(seam.pieces))]
    at = cell.home
    while left:
        nearest = left[0]
        if at is not None:
            start = at
            nearest = min(left, key=lambda item: float(np.abs(
                (found[item[0]].pieces[item[1]].approach - start) / moving.arm.speeds).max()))
        left.remove(nearest)
        number, part = nearest
        seam = found[number]
        piece = seam.pieces[part]
        way = np.stack([piece.approach] * 2) if at is None else _way(moving, cell, at, piece.approach)
        if way is None:
            failure = Failure(piece.first, TRANSFER, "no way through the air was found to its approach")
            found[number] = replace(seam, path=replace(seam.path, failure=failure), pieces=())
            if any(item[0] == number for item in order):
                # Ways lead from its other pieces: they are sought anew without them.
                return _ordered(found, wanted, moving, cell)
            left = [item for item in left if item[0] != number]
            continue
        pieces = (*seam.pieces[:part], replace(piece, way=way[1:-1]), *seam.pieces[part + 1 :])
        found[number] = replace(seam, pieces=pieces)
        order.append(nearest)
        at = piece.retract
    return order, found


def _way(moving: Moving, cell: Cell, start: Array, end: Array) -> Array | None:
    def free(joints: Array) -> NDArray[np.bool_]:
        result: NDArray[np.bool_] = moving.all(joints, cell.clearance + 1.0).distances >= cell.clearance
        return result

    return transfer(start, end, moving.arm.limits, free)
