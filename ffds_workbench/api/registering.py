# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``register``: from a nominal model and a scan to the as-built model, its certificate and its report."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import Part

from ..brep.model_files import Model
from ..brep.workpiece import Workpiece
from ..registration.face import FaceRegistration
from ..registration.joint import JointFace, JointRegistration
from ..registration.request import RegistrationRequest
from ..report import record, table
from ..report.comparison import compare
from ..report.deviation import FaceDeviation
from ..report.stopwatch import Progress, Stopwatch
from ..scan.cloud import PointCloud
from .placing import AlignedScan, align_scan
from .certified import CertifiedModel, certified
from .inputs import as_cloud, as_model, as_request, as_workpiece, check_place
from .methods import Deformation, check_names, find_deformation


@dataclass(frozen=True)
class Result(CertifiedModel):
    """An as-built model and how it came about. The deviations are measured at first use.

    Attributes
    ----------
    part : faces of the nominal model
    scan : what it was made to fit
    request : how it was asked for
    found : the displacements, and where they come from
    aligned : the scan as it was brought onto the model before, where that was asked for
    """

    part: Workpiece
    scan: PointCloud
    request: RegistrationRequest
    found: Deformation
    aligned: AlignedScan | None = None

    @property
    def registrations(self) -> tuple[FaceRegistration | JointFace, ...]:
        """One per face that the scan deformed."""
        return tuple(self.found.faces.values())

    @property
    def joint(self) -> JointRegistration | None:
        """The registration of the whole part, where all faces were registered together."""
        return self.found.joint

    @cached_property
    def deviations(self) -> tuple[tuple[FaceDeviation, ...], tuple[FaceDeviation, ...]]:
        """From the nominal and from the as-built faces: of the whole part, or of those that were named."""
        with self.watch.stage("bands", "Finding the 95 % bands"):
            faces = self.found.faces if self.joint is None else range(len(self.part.faces))
        with self.watch.stage("deviation", "Measuring the deviation"):
            return compare(self.part, self.shape, list(faces), self.scan.points)

    @cached_property
    def figures(self) -> dict[str, Any]:
        """The JSON report but for the topology."""
        found, names = self.found, [face.name for face in self.part.faces]
        moved, (before, after) = [names[index] for index in found.displacements], self.deviations
        if found.joint is None:
            edge_faces = [[names[index] for index in faces] for faces in self.structures[0].topology.edge_faces]
            faces = record.face_records(names, moved, found.faces.values(), before, after)
            edges = record.edge_records(edge_faces, moved, [item.name for item in found.faces.values()])
        else:
            faces = record.face_records(names, moved, found.joint.faces, before, after)
            edges = record.joint_edge_records(found.joint.edges)
        noise = float(np.median([item.noise for item in found.faces.values()]))
        figures = {"faces": faces, "edges": edges, "deviation_before": record.all_figures(before),
                   "deviation_after": record.all_figures(after),
                   "scan": record.scan_record(self.scan, noise, self.request.sensor),
                   "sheet": record.sheet_record(found.joint), "timing": self.watch.times()}
        return figures if self.aligned is None else figures | {"alignment": self.aligned.report}

    @property
    def first_report(self) -> dict[str, Any]:
        """The JSON report as long as the check for Boolean operations goes on: waits for nothing."""
        return self.figures | {"topology": self.unchecked.as_dict()}

    @cached_property
    def report(self) -> dict[str, Any]:
        """The JSON report as a dictionary; waits for the check for Boolean operations."""
        return self.figures | {"topology": self.certificate.as_dict()}

    def table(self) -> str:
        """All of it as text: the alignment that went before, if one did, deviation and topology."""
        aligned = [] if self.aligned is None else [self.aligned.table()]
        return "\n\n".join([*aligned, self.deviation_table()])

    def deviation_table(self) -> str:
        """Deviation and topology, before and after, as text."""
        parts = (table.deviation_table(self.report), table.topology_table(self.report["topology"]),
                 table.doubts(self.report))
        return "\n\n".join(part for part in parts if part)


def register(model: Model | Part.Shape | object, scan: PointCloud | np.ndarray, faces: Sequence[str] | None = None,
             progress: Progress | None = None, **settings: Any) -> Result:
    """Deform faces of a model to a scan; neighbouring faces adapt and the topology stays.

    Parameters
    ----------
    model : a `Model`, a file, a shape or a document object
    scan : a `PointCloud`, a file, or (n, 3) points in mm, aligned with the model unless ``align`` is asked for
    faces : names like "Face6", numbered as FreeCAD numbers the shape, each registered by itself; None for the whole
        part: all faces together with "robust", every face that the scan observes by itself with the other methods
    progress : called with what is being done
    settings : ``method``, ``lattice``, ``freeze``, ``source_points``, ``isometry``, ``stiffness``, ``gate``,
        ``sensor`` and ``align``, as `RegistrationRequest` has them; the sensor may also be a preset by its name, or
        the file of one

    Raises
    ------
    InputError : the model, a name, the method, the lattice or the sensor cannot be used
    RefusedError : no overlap, too little data, or a result that would break the model
    """
    return run(as_request(faces, **settings), model, scan, progress)


def run(request: RegistrationRequest, model: Model | Part.Shape | object, scan: PointCloud | np.ndarray,
        progress: Progress | None = None) -> Result:
    """Carry out a request. Raises as `register` does.

    Parameters
    ----------
    request : how the model is to be deformed
    model, scan, progress : as for `register`
    """
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model"):
        nominal = as_model(model)
        cloud = as_cloud(scan)
        part = as_workpiece(nominal.shape)
        check_names(part, request)
    aligned = None if request.align == "none" else align_scan(nominal, cloud, request.align, progress)
    cloud = cloud if aligned is None else aligned.scan
    check_place(cloud, nominal)
    found = find_deformation(part, cloud, request, watch)
    built = certified(nominal, part, found.displacements, watch)
    return Result(built.model, nominal, built.structures, built.checks, watch, part, cloud, request, found, aligned)
