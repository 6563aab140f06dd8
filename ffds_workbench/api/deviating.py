# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``deviation``: how far a scan lies from a model, face by face."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import Part

from ..brep import workpiece
from ..brep.model_files import Model
from ..errors import RefusedError
from ..report import record, table
from ..report.deviation import FaceDeviation, measure, reach_of
from ..report.stopwatch import Progress, Stopwatch
from ..scan.cloud import PointCloud
from .inputs import as_cloud, as_model, check_place


@dataclass(frozen=True)
class Deviation:
    """The deviation of a scan from a model, face by face.

    Attributes
    ----------
    model, scan : what was compared
    faces : signed distances in mm of the faces that the scan shows
    report : the figures as a JSON record
    """

    model: Model
    scan: PointCloud
    faces: tuple[FaceDeviation, ...]
    report: dict[str, Any]

    def table(self) -> str:
        """The figures as text."""
        return table.deviation_table(self.report)


def deviation(model: Model | Part.Shape | object, scan: PointCloud | np.ndarray,
              progress: Progress | None = None) -> Deviation:
    """Signed distances of a scan from the faces of a model, by foot points on the surfaces.

    Parameters
    ----------
    model : a `Model`, a file, a shape or a document object
    scan : a `PointCloud`, a file, or (n, 3) points in mm, aligned with the model
    progress : called with what is being done

    Raises
    ------
    InputError, RefusedError : the model cannot be used, or the scan is nowhere near it
    """
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model"):
        used = as_model(model)
        cloud = as_cloud(scan)
        part = workpiece.read(used.shape)
        check_place(cloud, used)
    with watch.stage("deviation", "Measuring the deviation"):
        geometries = [part.geometry(index) for index in range(len(part.faces))]
        faces = tuple(measure(geometries, cloud.points, reach_of(used.shape.BoundBox.DiagonalLength)))
    if not any(len(face.points) for face in faces):
        raise RefusedError("No scan point lies over a face of the model: align the scan with the model first.")
    entries = [{"name": face.name, "points": len(face.points), "deviation": record.figures(face.deviations)}
               for face in faces]
    report = {"faces": entries, "deviation": record.all_figures(faces), "scan": record.scan_record(cloud, None),
              "timing": watch.times()}
    return Deviation(used, cloud, faces, report)
