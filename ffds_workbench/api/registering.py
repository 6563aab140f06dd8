# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``register``: from a nominal model and a scan to the as-built model, its certificate and its report."""
from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ..brep import workpiece
from ..brep.model_files import Model
from ..brep.rebuild import rebuild
from ..brep.workpiece import Workpiece
from ..errors import InputError
from ..registration.face import FaceRegistration
from ..registration.joint import JointFace, JointRegistration, SensorProfile
from ..report import record, table
from ..report.boolean_check import BooleanChecks
from ..report.certificate import Certificate, Structure, condition, enforce, structure
from ..report.comparison import compare
from ..report.deviation import FaceDeviation
from ..report.stopwatch import Progress, Stopwatch
from ..scan import sensor_profile
from ..scan.cloud import PointCloud
from ..scan.plausibility import check_overlap
from .inputs import as_cloud, as_model, box
from .methods import Deformation, Lattice, all_together, each_by_itself
from .tuning import Tuning

METHODS = ("robust", "ffds", "ffd-hsu")
ISOMETRY = ("auto", "on", "off")

BOOLEAN_CHECK_SECONDS = 10.0
"""Processor time that the check of a shape for Boolean operations, which runs beside the other work, may take before
the certificate goes without it: it can take minutes. Only what asks for the certificate waits for it, not the model."""
SURFACE_TOLERANCE = 1e-5
"""Largest distance in mm of a rebuilt face from the nominal surface plus its displacement."""


@dataclass(frozen=True)
class Result:
    """An as-built model and how it came about. The deviations are measured when they are first asked for.

    Attributes
    ----------
    model : the as-built shape with the nominal's name and colours
    nominal : what it was made from
    part : its faces
    scan : what it was made to fit
    sensor : the sensor's profile, if one was given
    found : the displacements, and where they come from
    structures : what the as-built shape had to keep, of the nominal and of itself
    checks : for Boolean operations, of the nominal and of the as-built shape
    watch : how long what took
    alignment : the report of the alignment that went before, if one did
    """

    model: Model
    nominal: Model
    part: Workpiece
    scan: PointCloud
    sensor: SensorProfile | None
    found: Deformation
    structures: tuple[Structure, Structure]
    checks: BooleanChecks
    watch: Stopwatch
    alignment: Mapping[str, Any] | None = None

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
        """Of the same scan points from the nominal and from the as-built faces."""
        with self.watch.stage("bands", "Finding the 95 % bands"):
            deformed = list(self.found.faces)
        with self.watch.stage("deviation", "Measuring the deviation"):
            return compare(self.part, self.shape, deformed, self.scan.points)

    @cached_property
    def certificate(self) -> Certificate:
        """Topology before and after; waits for the check for Boolean operations."""
        before, after = (condition(shape, known=known) for shape, known in
                         zip((self.nominal.shape, self.shape), self.structures, strict=True))
        errors = self.checks.errors()
        return Certificate(replace(before, boolean_check=errors[0]), replace(after, boolean_check=errors[1]))

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
                   "scan": record.scan_record(self.scan, noise, self.sensor),
                   "sheet": record.sheet_record(found.joint), "timing": self.watch.times()}
        return figures if self.alignment is None else figures | {"alignment": self.alignment}

    @cached_property
    def report(self) -> dict[str, Any]:
        """The JSON report as a dictionary; waits for the check for Boolean operations."""
        return self.figures | {"topology": self.certificate.as_dict()}

    @property
    def shape(self) -> Part.Shape:
        """The as-built shape."""
        return self.model.shape

    def table(self) -> str:
        """Deviation and topology, before and after, as text."""
        parts = (table.deviation_table(self.report), table.topology_table(self.report["topology"]),
                 table.doubts(self.report))
        return "\n\n".join(part for part in parts if part)


def register(model: Model | Part.Shape | object, scan: PointCloud | np.ndarray, faces: Sequence[str] | None = None,
             method: str = "robust", lattice: Lattice = "auto", freeze: Collection[str] = (),
             source_points: int = 400, isometry: str = "auto", progress: Progress | None = None,
             stiffness: float = 1.0, gate: float | None = None,
             sensor: SensorProfile | str | Path | None = None) -> Result:
    """Deform faces of a model to a scan; neighbouring faces adapt and the topology stays.

    Parameters
    ----------
    model : a `Model`, a file, a shape or a document object
    scan : a `PointCloud`, a file, or (n, 3) points in mm, aligned with the model
    faces : names like "Face6", numbered as FreeCAD numbers the shape, each registered by itself; None for the whole
        part: all faces together with "robust", every face that the scan observes by itself with the other methods
    method : "robust", "ffds" for the published algorithm, or "ffd-hsu" for a lattice in space around each face
    lattice : (N_i, N_j) control points per face, or "auto"; "ffd-hsu" then takes 10 × 10
    freeze : names of faces that must not move
    source_points : of methods "ffds" and "ffd-hsu", on each face
    isometry : of a whole sheet part: "on" holds it inextensible, "off" does not, "auto" decides from the strain found
    progress : called with what is being done
    stiffness : of "robust": above 1 the displacement is smoother, below 1 it follows the scan more closely
    gate : of "robust": scan points farther than this from the as-built surface are outliers, in mm; None for the
        default
    sensor : of the whole part: the sensor's profile, one of the presets by its name, or the file of one; it tells noise
        that neighbouring points share from shape, so that bands are honest. None: white noise

    Raises
    ------
    InputError : the model, a name, the method, the lattice or the sensor cannot be used
    RefusedError : no overlap, too little data, or a result that would break the model
    """
    watch, tuning = Stopwatch(progress), Tuning(stiffness, gate)
    profile = None if sensor is None else sensor_profile.find(sensor)
    with watch.stage("read", "Reading the model"):
        nominal = as_model(model)
        cloud = as_cloud(scan)
        part = workpiece.read(nominal.shape)
        frozen = [part.index(name) for name in dict.fromkeys(freeze)]
        wanted = None if faces is None else [part.index(name) for name in dict.fromkeys(faces)]
        _check_request(method, lattice, wanted, frozen, isometry, tuning, profile)
        check_overlap(cloud, *box(nominal.shape))
    if method == "robust" and wanted is None:
        found = all_together(part, cloud, freeze, isometry, watch, tuning, profile or SensorProfile())
    else:
        found = each_by_itself(part, cloud, wanted, frozen, method, lattice, source_points, watch, tuning)
    with watch.stage("rebuild", "Rebuilding the model"):
        shape = rebuild(part, found.displacements, SURFACE_TOLERANCE)
    checks = BooleanChecks(BOOLEAN_CHECK_SECONDS)
    checks.begin(nominal.shape)
    checks.begin(shape)
    with watch.stage("certify", "Checking the topology"):
        structures = structure(nominal.shape), structure(shape)
        enforce(*structures)
    return Result(replace(nominal, shape=shape), nominal, part, cloud, profile, found, structures, checks, watch)


def _check_request(method: str, lattice: Lattice, wanted: Collection[int] | None, frozen: Collection[int],
                   isometry: str, tuning: Tuning, sensor: SensorProfile | None) -> None:
    if method not in METHODS:
        raise InputError(f"The method '{method}' is unknown: use one of {', '.join(METHODS)}.")
    if lattice != "auto" and (isinstance(lattice, str) or min(lattice) < 4):
        raise InputError(f"The lattice {lattice} is unknown or too small: a cubic lattice has 4 or more control points "
                         f"in each direction, for instance 10x10.")
    if method != "robust" and tuning != Tuning():
        raise InputError(f"Stiffness and outliers are settings of method robust, not of {method}: leave them out.")
    both = sorted(set(wanted or ()) & set(frozen))
    if both:
        raise InputError(f"Face{both[0] + 1} is to be deformed and to be frozen: choose one.")
    if wanted is not None and not wanted:
        raise InputError("No face was named.")
    if isometry not in ISOMETRY:
        raise InputError(f"The isometry '{isometry}' is unknown: use one of {', '.join(ISOMETRY)}.")
    together = method == "robust" and wanted is None
    if together and lattice != "auto":
        raise InputError("All faces together take their lattices from the data: name a face to choose its lattice.")
    if not together and isometry != "auto":
        raise InputError("Isometry couples all faces of a sheet: it needs method robust without named faces.")
    if not together and sensor is not None:
        raise InputError("A sensor profile is for the whole part: it needs method robust without named faces.")
