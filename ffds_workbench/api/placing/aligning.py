# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``align``: bring a scan onto the model, and say how sure that is."""
from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import Part

from ...brep.model_files import Model
from ...errors import InputError, RefusedError
from ...output import replacing
from ...registration.motions import apply, describe_difference
from ...registration.request import ALIGNMENTS
from ...registration.rigid import FAILED, Alignment, Target, align, target_of
from ...registration.rigid.scan_unit import unit_by_size
from ...report import record
from ...report.stopwatch import Progress, Stopwatch
from ...scan.cloud import PointCloud
from ...scan.plausibility import wrong_unit
from ...scan.poses import as_pose
from ...scan.sensor.files import write_ply
from ...scan.units import MILLIMETRES
from ..destinations import destinations
from ..inputs import as_cloud, as_model, as_workpiece

_TARGETS: deque[tuple[Part.Shape, Target]] = deque(maxlen=2)


class Placed(Protocol):
    """A scan on its model, however it came there: its points, and its pose as a JSON record."""

    @property
    def scan(self) -> PointCloud: ...
    @property
    def report(self) -> dict[str, Any]: ...


@dataclass(frozen=True)
class AlignedScan:
    """A scan on its model.

    Attributes
    ----------
    scan : the scan in mm and in the model's coordinates
    alignment : the pose, its verdict and its confidence
    report : the pose as a JSON record
    """

    scan: PointCloud
    alignment: Alignment
    report: dict[str, Any]

    def table(self) -> str:
        """What was found, as text."""
        found = self.alignment
        lines = [f"Alignment    {found.text}, confidence {found.confidence:.2f}",
                 f"On the part  {100 * found.fitness:.1f} % of the scan within {found.reach:.2g} mm, "
                 f"rms deviation {found.rmse:.3f} mm; {100 * found.coverage:.0f} % of the visible part covered"]
        if found.symmetry:
            lines.append(f"Symmetry     the part is {found.symmetry}")
        if len(found.poses) > 1:
            here = self.scan.points.mean(axis=0)
            others = [describe_difference(found.T_model_scan, pose.T_model_scan, here) for pose in found.poses[1:]]
            lines += [f"Also fits    {'; '.join(dict.fromkeys(others))}",
                      "Which one    the scan alone cannot decide: turn it roughly into place and align it with "
                      "mode fine, or scan more of the part"]
        if found.scale != 1.0:
            lines.append(f"Unit         the scan is in {found.unit}, or the model's file declares a wrong unit: the "
                         f"scan's coordinates were multiplied by {found.scale:g}")
        if found.table:
            lines.append("Table        a plane beside the part was left out")
        return "\n".join(lines)


def align_scan(model: Model | Part.Shape | object, scan: PointCloud | np.ndarray, mode: str = "global",
               progress: Progress | None = None, start: np.ndarray | None = None) -> AlignedScan:
    """Bring a scan onto a model by a rigid motion.

    Parameters
    ----------
    model : a `Model`, a file, a shape or a document object
    scan : a `PointCloud`, a file, or (n, 3) points in mm; a unit off by 1000, 100, 10 or 25.4 is recognised
    mode : "fine" from where the scan lies, within some 30°; "global" from anywhere
    progress : called with what is being done
    start : (4, 4), a T_model_scan given by hand: the pose is sought close around it, whatever the mode

    Raises
    ------
    InputError : the model, the mode or the start cannot be used
    RefusedError : no pose explains the scan
    """
    if mode not in ALIGNMENTS:
        raise InputError(f"The alignment '{mode}' is unknown: use one of {', '.join(ALIGNMENTS)}.")
    begin = np.eye(4) if start is None else as_pose(start, "The start of the alignment")
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model"):
        cloud = as_cloud(scan)
        nominal = as_model(model)
        target = target_of_shape(nominal.shape)
    with watch.stage("align", "Aligning the scan"):
        found = _from(begin, align(target, apply(begin, cloud.points), mode if start is None else "local"))
    if found.verdict == FAILED:
        _refuse_unit(cloud, nominal)
        raise RefusedError(f"The scan could not be aligned with the model: {found.reason}; check that it shows this "
                           f"part, or leave other objects out.")
    unit = found.unit if found.scale != 1.0 and found.unit in MILLIMETRES else cloud.unit
    report = {**_record(found), "timing": watch.times()}
    return AlignedScan(replace(cloud.moved(found.T_model_scan, found.scale), unit=unit), found, report)


def write_alignment(aligned: Placed, out: str | Path, pose: str | Path | None = None,
                    inputs: Sequence[str | Path] = ()) -> None:
    """Write an aligned scan and its pose: both or none.

    Parameters
    ----------
    aligned : what `align_scan` gave, or an alignment by datums
    out, pose : files, .ply and .json
    inputs : files that were read and must not be written over

    Raises
    ------
    InputError : a destination cannot be written or is one of ``inputs``
    RefusedError : the disk is full
    """
    outputs = destinations((out, pose), inputs)
    with replacing(*outputs.values()) as temporary:
        write_ply(temporary[0], aligned.scan.points, aligned.scan.normals)
        if pose is not None:
            record.write(aligned.report, temporary[1])


def target_of_shape(shape: Part.Shape) -> Target:
    """The target of a shape; that of the last shapes is kept, for the next scan of the same part."""
    for known, target in _TARGETS:
        if known.isEqual(shape):
            return target
    part = as_workpiece(shape)
    target = target_of([part.geometry(index) for index in range(len(part.faces))])
    _TARGETS.appendleft((shape, target))
    return target


def _refuse_unit(scan: PointCloud, model: Model) -> None:
    """Refuse a scan that fits the model in no pose, and whose size suggests another unit (InputError)."""
    size = model.shape.BoundBox.DiagonalLength
    factor = unit_by_size(scan.points, size)
    if factor is not None:
        raise InputError(wrong_unit(scan, size, factor, model.unit))


def _from(begin: np.ndarray, found: Alignment) -> Alignment:
    """An alignment of a scan that was moved before, as one of the scan itself; the unit found scales the shift too."""
    first = begin.copy()
    first[:3, 3] *= found.scale
    poses = tuple(replace(pose, T_model_scan=pose.T_model_scan @ first) for pose in found.poses)
    return replace(found, T_model_scan=found.T_model_scan @ first, poses=poses)


def _record(found: Alignment) -> dict[str, Any]:
    return {
        "T_model_scan": found.T_model_scan.tolist(), "verdict": found.verdict, "confidence": found.confidence,
        "poses": [{"T_model_scan": pose.T_model_scan.tolist(), "score": pose.score, "reason": pose.reason}
                  for pose in found.poses],
        "reason": found.reason, "symmetry": found.symmetry, "unit": found.unit, "scale": found.scale,
        "fitness": found.fitness, "fitness_distance": found.reach, "rmse": found.rmse, "coverage": found.coverage,
        "explained": found.explained, "table_removed": found.table}
