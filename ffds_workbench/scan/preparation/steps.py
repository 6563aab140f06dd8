# SPDX-License-Identifier: LGPL-2.1-or-later
"""All steps from the raw scan to one that is ready for registration; each works on the result of those before."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError, RefusedError
from ...registration.arrays import Array
from ..cloud import PointCloud
from ..normals import fused
from . import clutter, crop, fusing, table, thinning
from .settings import PreparationSettings, PreparedScan, PreparationStep, PartSurface
from .spacing import spacing as spacing_of

Progress = Callable[[str], None]


@dataclass
class _Work:
    """A scan under way: its points where they are, and about ``origin``, normals and each point's sensor, (n, 3)."""

    placed: Array
    points: Array
    normals: Array | None
    sensors: Array
    origin: Array
    steps: list[PreparationStep]

    def keep(self, name: str, kept: NDArray[np.bool_], found: dict[str, Any] | None = None, note: str = "",
             nothing: str = "") -> None:
        """Go on with some of the points (RefusedError with the sentence ``nothing`` where there is none)."""
        if not kept.any():
            raise RefusedError(nothing or f"The step '{name}' would leave nothing of the scan: leave it out.")
        self.placed, self.points, self.sensors = self.placed[kept], self.points[kept], self.sensors[kept]
        self.normals = None if self.normals is None else self.normals[kept]
        self.record(name, len(kept), found, note)

    def record(self, name: str, before: int, found: dict[str, Any] | None = None, note: str = "") -> None:
        """A step was done."""
        self.steps.append(PreparationStep(name, before, self.placed, found or {}, note))


def prepare(scans: Sequence[PointCloud], settings: PreparationSettings, surface: PartSurface | None = None,
            names: Sequence[str] = (), progress: Progress = lambda text: None) -> PreparedScan:
    """Fuse scans, crop them, take the table, clutter and outliers away, estimate normals and thin.

    Steps that remove points leave the others unchanged to the last digit; thinning averages them.

    Parameters
    ----------
    surface : the part, for ``settings.near``
    names : of the scans, for errors and report
    progress : called with the name of each step

    Raises
    ------
    InputError : there are not as many poses as scans, open3d is missing and a step needs it, or no view point is known
    RefusedError : a step would leave nothing, or scans do not overlap
    """
    names = names or [f"number {number}" for number in range(1, len(scans) + 1)]
    work = _fused(scans, settings, names, progress)
    first_spacing = spacing_of(work.points)
    if settings.box is not None:
        work.keep("box", crop.within(work.placed, settings.box),
                  nothing="Nothing of the scan lies in the box: boxes are in mm, in the coordinates of the scan.")
    if settings.near is not None and surface is not None:
        progress("Cropping to the model")
        near = crop.near(work.points, replace(surface, vertices=surface.vertices - work.origin), settings.near)
        work.keep("near", near, {"distance": settings.near}, nothing=(
            f"Nothing of the scan lies within {settings.near:g} mm of the model: align the scan with it first."))
    _clean(work, settings, progress)
    if settings.normals:
        progress("Estimating normals")
        work.normals = thinning.estimated_normals(work.points, _sensors(work, settings))
        work.record("normals", len(work.points))
    if settings.spacing is not None:
        progress("Thinning")
        before = len(work.points)
        work.points, work.normals = thinning.thinned(work.points, work.normals, settings.spacing)
        work.placed = work.points + work.origin
        work.record("spacing", before, {"spacing": settings.spacing})
    scan = PointCloud(work.placed, sum(scan.dropped for scan in scans), scans[0].unit, work.normals)
    return PreparedScan(scan, tuple(work.steps), (first_spacing, spacing_of(work.points)))


def _fused(scans: Sequence[PointCloud], settings: PreparationSettings, names: Sequence[str], progress: Progress
           ) -> _Work:
    """All scans in one frame, and near the origin: there, differences of large coordinates keep their precision."""
    poses = settings.poses if settings.poses is not None else (np.eye(4),) * len(scans)
    if len(poses) != len(scans):
        raise InputError(f"There are {len(poses)} poses for {len(scans)} scans: give one for each, in their order.")
    placed = [scan.moved(pose) if settings.poses is not None else scan
              for scan, pose in zip(scans, poses, strict=True)]
    origin = np.round(placed[0].points.mean(axis=0))
    counts = [len(scan.points) for scan in placed]
    matched = settings.poses is not None and len(scans) > 1
    if matched:
        progress("Matching the scans")
        corrections = fusing.agreed_poses([scan.points - origin for scan in placed], names)
        about = np.eye(4), np.eye(4)
        about[0][:3, 3], about[1][:3, 3] = origin, -origin
        corrections = [about[0] @ correction @ about[1] for correction in corrections]
        placed = [scan.moved(correction) for scan, correction in zip(placed, corrections, strict=True)]
        poses = tuple(correction @ pose for correction, pose in zip(corrections, poses, strict=True))
    points = np.concatenate([scan.points for scan in placed])
    work = _Work(points, points - origin, fused([scan.normals for scan in placed], counts),
                 np.repeat([pose[:3, 3] - origin for pose in poses], counts, axis=0), origin, [])
    if matched:
        work.record("fuse", len(points), {"scans": [{"scan": name, "T_common_scan": pose.tolist()}
                                                    for name, pose in zip(names, poses, strict=True)]})
    return work


def _clean(work: _Work, settings: PreparationSettings, progress: Progress) -> None:
    """Remove the table, clutter and outliers, in this order: each is easier to recognise without the one before."""
    spacing, up = spacing_of(work.points), None
    if settings.remove_plane:
        progress("Looking for the table")
        plane = table.find_table(work.points)
        if plane is None:
            missing = "no plane was found that the rest stands on"
            work.record("plane", len(work.points), note=missing)
        else:
            up = plane.normal
            work.keep("plane", plane.in_front(work.points), {
                "normal": plane.normal.tolist(), "height": plane.height + float(plane.normal @ work.origin),
                "thickness": plane.below + plane.above})
    if settings.remove_clutter:
        progress("Looking for clutter")
        kept, large = clutter.in_large_pieces(work.points, spacing, up)
        work.keep("clutter", kept, {"pieces": large},
                  nothing="The scan consists of single points: its clutter cannot be told from the part.")
    if settings.remove_outliers:
        progress("Looking for outliers")
        work.keep("outliers", clutter.surrounded(work.points))


def _sensors(work: _Work, settings: PreparationSettings) -> Array:
    """Where each point was seen from, (3,) or (n, 3), about the work's origin."""
    if settings.view is not None:
        return np.asarray(settings.view, dtype=float) - work.origin
    low, high = work.points.min(axis=0), work.points.max(axis=0)
    inside = ((work.sensors > low) & (work.sensors < high)).all(axis=1)
    if inside.any():
        raise InputError("The origin of the scan's coordinates lies within the scan, so that no sensor stood there: "
                         "say where it stood (--view X,Y,Z).")
    return work.sensors
