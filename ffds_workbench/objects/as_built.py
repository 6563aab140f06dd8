# SPDX-License-Identifier: LGPL-2.1-or-later
"""The as-built part: a document object that follows its nominal part, its scan and its settings."""
from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import FreeCAD
import numpy as np

from ..errors import InputError
from ..registration.request import ISOMETRY, LEAST_SOURCE_POINTS, METHODS, STIFFEST, RegistrationRequest
from ..report.table import doubts
from .boolean_check import LOST, RUNNING, follow
from .feature import HIDDEN, OUTPUT, READ_ONLY, Feature, Property
from .jobs.registration_job import Job, make_job
from .lattices import Lattice, draw_lattices
from .signatures import found_again, signatures
from .waiting import wait_for

_FIGURES = (("MeanBefore", "deviation_before", "mean"), ("P95Before", "deviation_before", "p95"),
            ("MeanAfter", "deviation_after", "mean"), ("P95After", "deviation_after", "p95"))


_PLAIN = RegistrationRequest()


def _figure(name: str, text: str) -> Property:
    return Property(name, "App::PropertyDistance", "Deviation", text, None, READ_ONLY)


class AsBuilt(Feature):
    """Deforms ``Source`` to ``Scan``. The shape is saved with the document and needs no workbench to be seen."""

    PROPERTIES = (
        Property("Source", "App::PropertyLinkGlobal", "As built", "The nominal part"),
        Property("Faces", "App::PropertyLinkSubListGlobal", "As built",
                 "The faces to deform, each by itself; none: the whole part"),
        Property("Scan", "App::PropertyLinkGlobal", "As built", "The point cloud that the part is deformed to"),
        Property("Freeze", "App::PropertyLinkSubListGlobal", "As built", "Faces that must not move"),
        Property("Method", "App::PropertyEnumeration", "As built",
                 "robust copes with noise, gaps and clutter; ffds is the published algorithm", list(METHODS)),
        Property("ControlPointsU", "App::PropertyIntegerConstraint", "As built",
                 "Control points of each face in u; 0: chosen from the data", (0, 0, 400, 1)),
        Property("ControlPointsV", "App::PropertyIntegerConstraint", "As built",
                 "Control points of each face in v; 0: chosen from the data", (0, 0, 400, 1)),
        Property("SourcePoints", "App::PropertyIntegerConstraint", "As built",
                 "Source points on each face, for the methods ffds and ffd-hsu",
                 (_PLAIN.source_points, LEAST_SOURCE_POINTS, 1000000, 100)),
        Property("Isometry", "App::PropertyEnumeration", "As built",
                 "Whether a whole sheet part is held inextensible", list(ISOMETRY)),
        Property("Stiffness", "App::PropertyFloatConstraint", "As built",
                 "Above 1 the displacement is smoother, below 1 it follows the scan more closely",
                 (_PLAIN.stiffness, 1 / STIFFEST, STIFFEST, 0.1)),
        Property("Gate", "App::PropertyLength", "As built",
                 "Scan points farther than this from the as-built part are outliers; 0: a default for most scans"),
        _figure("MeanBefore", "Mean distance of the scan from the nominal part"),
        _figure("P95Before", "95 % of the scan are nearer than this to the nominal part"),
        _figure("MeanAfter", "Mean distance of the scan from the as-built part"),
        _figure("P95After", "95 % of the scan are nearer than this to the as-built part"),
        Property("BooleanCheck", "App::PropertyString", "Topology",
                 "OCCT's check for Boolean operations of the as-built part; it goes on in the background", None,
                 READ_ONLY | OUTPUT),
        Property("Report", "App::PropertyString", "Deviation", "The report as JSON", None, READ_ONLY | HIDDEN),
        Property("Signatures", "App::PropertyStringList", "As built", "What the named faces looked like", None,
                 READ_ONLY | HIDDEN),
        Property("LatticeSizes", "App::PropertyIntegerList", "Lattice", "Control points in u and v, face by face", None,
                 READ_ONLY | HIDDEN),
        Property("LatticeNominal", "App::PropertyVectorList", "Lattice", "Control points before", None,
                 READ_ONLY | HIDDEN),
        Property("LatticeAsBuilt", "App::PropertyVectorList", "Lattice", "Control points after", None,
                 READ_ONLY | HIDDEN),
    )

    def onDocumentRestored(self, obj: Any) -> None:
        """A document was opened: bring its object up to this version; a check that ran when it was saved is lost."""
        super().onDocumentRestored(obj)
        if obj.BooleanCheck == RUNNING:
            obj.BooleanCheck = LOST

    def execute(self, obj: Any) -> None:
        """Recompute. What goes wrong makes the object invalid, with the sentence; its last shape stays."""
        if obj.Source is None or obj.Scan is None:
            missing = "nominal part" if obj.Source is None else "scan"
            raise InputError(f"{obj.Label} has lost its {missing}: choose one in its properties.")
        job = _with_faces_found_again(obj, make_job(obj.Source, obj.Scan, request_of(obj)))
        result = wait_for(obj.Label, job.run)
        obj.Shape = result.shape
        obj.Placement = job.source.placement
        for name, block, figure in _FIGURES:
            setattr(obj, name, result.figures[block][figure])
        obj.Report = json.dumps(result.first_report)
        if doubt := doubts(result.figures):
            FreeCAD.Console.PrintWarning(f"{obj.Label}: {doubt}\n")
        obj.Signatures = signatures(job.source.model.shape, (*(job.request.faces or ()), *job.request.freeze))
        lattices = draw_lattices(job.source.model.shape, result.registrations)
        obj.LatticeSizes = [count for item in lattices for count in item.nominal.shape[:2]]
        obj.LatticeNominal = _vectors([item.nominal for item in lattices])
        obj.LatticeAsBuilt = _vectors([item.deformed for item in lattices])
        obj.BooleanCheck = RUNNING
        follow(obj, result)


def is_as_built(item: Any) -> bool:
    """Whether a document object is an as-built part of this workbench."""
    return isinstance(getattr(item, "Proxy", None), AsBuilt)


def request_of(obj: Any) -> RegistrationRequest:
    """The request that the properties of an as-built object make.

    Raises
    ------
    InputError : a face belongs to another part than the source, or the lattice is given in one direction alone; else as
        `RegistrationRequest` does
    """
    sizes = (obj.ControlPointsU, obj.ControlPointsV)
    if (sizes[0] == 0) != (sizes[1] == 0):
        raise InputError(f"{obj.Label} has a lattice of {sizes[0]} × {sizes[1]} control points: give both numbers, or "
                         f"0 for both to choose them from the data.")
    faces = _names(obj, obj.Faces)
    return RegistrationRequest(faces or None, obj.Method, sizes if sizes[0] else "auto", _names(obj, obj.Freeze),
                               obj.SourcePoints, obj.Isometry, obj.Stiffness, obj.Gate.Value or None)


def apply_request(obj: Any, request: RegistrationRequest) -> None:
    """Write a request into the properties of an as-built object; its faces are those of the nominal part as it is."""
    obj.Signatures = []
    obj.Faces = [(obj.Source, request.faces)] if request.faces else []
    obj.Freeze = [(obj.Source, request.freeze)] if request.freeze else []
    obj.Method, obj.Isometry, obj.SourcePoints = request.method, request.isometry, request.source_points
    obj.Stiffness, obj.Gate = request.stiffness, request.gate or 0.0
    obj.ControlPointsU, obj.ControlPointsV = request.counts or (0, 0)


def _with_faces_found_again(obj: Any, job: Job) -> Job:
    """The job with the faces that were meant, where their numbers in the nominal part have changed (InputError where
    they are gone)."""
    names = found_again(obj.Signatures, job.source.model.shape, job.source.item.Label)
    if all(old == new for old, new in names.items()):
        return job
    faces, freeze = (tuple(names.get(name, name) for name in old)
                     for old in (job.request.faces or (), job.request.freeze))
    obj.Faces = [(obj.Source, faces)] if faces else []
    obj.Freeze = [(obj.Source, freeze)] if freeze else []
    return replace(job, request=replace(job.request, faces=faces or None, freeze=freeze))


def lattices_of(obj: Any) -> list[Lattice]:
    """The control lattices of the last recompute, in the part's own frame."""
    sizes = np.reshape(obj.LatticeSizes, (-1, 2)).astype(int).tolist()
    ends = np.cumsum([rows * columns for rows, columns in sizes])[:-1]
    before, after = (np.split(np.array([tuple(point) for point in points]).reshape(-1, 3), ends)
                     for points in (obj.LatticeNominal, obj.LatticeAsBuilt))
    return [Lattice(a.reshape(*size, 3), b.reshape(*size, 3)) for size, a, b in zip(sizes, before, after, strict=False)]


def report_of(obj: Any) -> dict[str, Any]:
    """The report of the last recompute, empty before it."""
    return json.loads(obj.Report) if obj.Report else {}


def _names(obj: Any, links: list) -> tuple[str, ...]:
    for item, _ in links:
        if item is not obj.Source:
            raise InputError(f"A face of {item.Label} is named, but {obj.Label} is made from {obj.Source.Label}: "
                             f"choose faces of one part.")
    return tuple(name for _, names in links for name in names if name)


def _vectors(grids: list[np.ndarray]) -> list[FreeCAD.Vector]:
    return [FreeCAD.Vector(*point) for grid in grids for point in grid.reshape(-1, 3).tolist()]
