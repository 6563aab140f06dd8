# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scripting surface: what macros, the command line and FreeCAD's Python console call.

In FreeCAD's Python console, with a part selected or at hand::

    from ffds_workbench import api
    scan = api.read_scan("scan.ply")                        # points in mm; unit="m" if the file is in metres
    result = api.register(App.ActiveDocument.Bracket, scan, faces=["Face6"])
    print(result.table())                                   # deviation and topology, before and after
    Part.show(result.shape)
    api.write(result, "as_built.step", report="as_built.json", picture="as_built.png")
    plan = api.plan_seams(result.shape, auto=0.5, nominal=App.ActiveDocument.Bracket)
    api.write_seams(plan, ["weld.src", "weld.csv"])

Models are files, shapes or document objects alike; objects are taken where they stand in their document. Errors are
`InputError` (the request cannot be read) and `RefusedError` (no honest result), each with one sentence that says why.
"""
from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from . import _freecad

_freecad.activate()

import FreeCAD  # noqa: E402, F401 (Part needs FreeCAD to be loaded first)
import Part  # noqa: E402

from .brep import files, workpiece  # noqa: E402
from .brep.field import local_displacements  # noqa: E402
from .brep.files import Model  # noqa: E402
from .brep.rebuild import rebuild  # noqa: E402
from .brep.simulation import Simulation, simulate_shape  # noqa: E402
from .brep.workpiece import Workpiece  # noqa: E402
from .errors import FfdsError, InputError, RefusedError  # noqa: E402
from .output import check_writable, replacing  # noqa: E402
from .registration.ffd import register_ffd  # noqa: E402
from .registration.ffds import register_ffds  # noqa: E402
from .registration.result import FaceRegistration  # noqa: E402
from .registration.robust import register_robust  # noqa: E402
from .report import picture as drawing  # noqa: E402
from .report import record, table  # noqa: E402
from .report.certificate import Certificate, boolean_checks, certify  # noqa: E402
from .report.comparison import compare  # noqa: E402
from .report.deviation import FaceDeviation, measure, reach_of  # noqa: E402
from .report.stopwatch import Stopwatch  # noqa: E402
from .scan import files as scan_files  # noqa: E402
from .scan.cloud import PointCloud  # noqa: E402
from .scan.plausibility import check_overlap  # noqa: E402
from .scan.sensor import SensorSettings, View  # noqa: E402
from .scan.sensor.files import write_ply  # noqa: E402
from .seams.carry import carry  # noqa: E402
from .seams.measured import SeamLimits  # noqa: E402
from .seams.plan import check_seam_outputs, plan_seams, write_seams  # noqa: E402
from .seams.programs.moves import RobotSettings, read_frame_choice  # noqa: E402
from .seams.settings import SeamSettings  # noqa: E402

__all__ = ["Deviation", "FfdsError", "InputError", "Model", "PointCloud", "RefusedError", "Result", "RobotSettings",
           "SeamLimits", "SeamSettings", "SensorSettings", "Simulation", "View", "carry", "check_seam_outputs",
           "deviation", "plan_seams", "read_frame_choice", "read_model", "read_scan", "register", "simulate", "write",
           "write_deviation", "write_seams", "write_simulation"]

METHODS = ("robust", "ffds", "ffd-hsu")
Progress = Callable[[str], None]
Lattice = tuple[int, int] | str

BOOLEAN_CHECK_SECONDS = 4.0
"""How long the check for Boolean operations, which runs beside the other work, may take before the certificate goes
without it: it can take minutes."""
SURFACE_TOLERANCE = 1e-5
"""Largest distance in mm of a rebuilt face from the nominal surface plus its displacement."""
_PAPER_LATTICE = (10, 10)


@dataclass(frozen=True)
class Result:
    """An as-built model and how it came about.

    Attributes
    ----------
    model : the as-built shape with the nominal's name and colours
    nominal : what it was made from
    scan : what it was made to fit
    registrations : one per face that the scan deformed
    before, after : deviations of the same scan points from the nominal and from the as-built faces
    certificate : topology before and after
    report : the JSON report as a dictionary
    """

    model: Model
    nominal: Model
    scan: PointCloud
    registrations: tuple[FaceRegistration, ...]
    before: tuple[FaceDeviation, ...]
    after: tuple[FaceDeviation, ...]
    certificate: Certificate
    report: dict[str, Any]

    @property
    def shape(self) -> Part.Shape:
        """The as-built shape."""
        return self.model.shape

    def table(self) -> str:
        """Deviation and topology, before and after, as text."""
        return table.deviation_table(self.report) + "\n\n" + table.topology_table(self.report["topology"])


@dataclass(frozen=True)
class Deviation:
    """The deviation of a scan from a model, face by face."""

    model: Model
    scan: PointCloud
    faces: tuple[FaceDeviation, ...]
    report: dict[str, Any]

    def table(self) -> str:
        """The figures as text."""
        return table.deviation_table(self.report)


def read_scan(paths: str | Path | Sequence[str | Path], unit: str = "mm") -> PointCloud:
    """Read one scan file, or fuse several of one part; ``unit`` is that of the files: mm, cm, m or in."""
    return scan_files.read(paths, unit)


def read_model(path: str | Path, label: str | None = None) -> Model:
    """Read a model file; ``label`` picks the object of a FreeCAD document that holds several."""
    return files.read(path, label)


def register(model: Model | Part.Shape | object, scan: PointCloud | np.ndarray, faces: Sequence[str] | None = None,
             method: str = "robust", lattice: Lattice = "auto", freeze: Collection[str] = (),
             source_points: int = 400, progress: Progress | None = None) -> Result:
    """Deform faces of a model to a scan; neighbouring faces adapt and the topology stays.

    Parameters
    ----------
    model : a `Model`, a shape or a document object
    scan : a `PointCloud`, or (n, 3) points in mm, aligned with the model
    faces : names like "Face6", numbered as FreeCAD numbers the shape; None for every face that the scan observes
    method : "robust", "ffds" for the published algorithm, or "ffd-hsu" for a lattice in space around each face
    lattice : (N_i, N_j) control points per face, or "auto"; "ffds" and "ffd-hsu" then take 10 × 10
    freeze : names of faces that must not move
    source_points : of methods "ffds" and "ffd-hsu", on each face
    progress : called with what is being done

    Raises
    ------
    InputError : the model, a name, the method or the lattice cannot be used
    RefusedError : no overlap, too little data, or a result that would break the model
    """
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model"):
        nominal = _as_model(model)
        cloud = _as_cloud(scan)
        part = workpiece.read(nominal.shape)
        frozen = [part.index(name) for name in dict.fromkeys(freeze)]
        wanted = None if faces is None else [part.index(name) for name in dict.fromkeys(faces)]
        _check_request(method, lattice, wanted, frozen)
        check_overlap(cloud, *_box(nominal.shape))
    with watch.stage("register", "Finding the faces that the scan observes"):
        registrations = _register_faces(part, cloud, wanted, frozen, method, lattice, source_points, watch)
    with watch.stage("rebuild", "Rebuilding the model"):
        moving = {index: item.displacement for index, item in registrations.items()}
        displacements = local_displacements(part, moving, frozen)
        shape = rebuild(part, displacements, SURFACE_TOLERANCE)
    with ThreadPoolExecutor(1) as background:
        checks = background.submit(boolean_checks, (nominal.shape, shape), BOOLEAN_CHECK_SECONDS)
        with watch.stage("certify", "Checking the topology"):
            certificate = certify(nominal.shape, shape, None)
            certificate.enforce()
        with watch.stage("deviation", "Measuring the deviation"):
            before, after = compare(part, shape, list(registrations), cloud.points)
        with watch.stage("certify", "Waiting for the check for Boolean operations"):
            certificate = _with_checks(certificate, *checks.result())
    moved = [part.faces[index].name for index in displacements]
    report = _report(part, cloud, tuple(registrations.values()), before, after, moved, certificate, watch)
    return Result(replace(nominal, shape=shape), nominal, cloud, tuple(registrations.values()), before, after,
                  certificate, report)


def deviation(model: Model | Part.Shape | object, scan: PointCloud | np.ndarray,
              progress: Progress | None = None) -> Deviation:
    """Signed distances of a scan from the faces of a model, by foot points on the surfaces.

    Raises
    ------
    InputError, RefusedError : the model cannot be used, or the scan is nowhere near it
    """
    watch = Stopwatch(progress)
    with watch.stage("read", "Reading the model"):
        used = _as_model(model)
        cloud = _as_cloud(scan)
        part = workpiece.read(used.shape)
        check_overlap(cloud, *_box(used.shape))
    with watch.stage("deviation", "Measuring the deviation"):
        geometries = [part.geometry(index) for index in range(len(part.faces))]
        faces = tuple(measure(geometries, cloud.points, reach_of(_diagonal(used.shape))))
    if not any(len(face.points) for face in faces):
        raise RefusedError("No scan point lies over a face of the model: align the scan with the model first.")
    entries = [{"name": face.name, "points": len(face.points), "deviation": record.figures(face.deviations)}
               for face in faces]
    report = {"faces": entries, "deviation": record.all_figures(faces), "scan": record.scan_record(cloud, None),
              "timing": watch.times()}
    return Deviation(used, cloud, faces, report)


def write(result: Result, out: str | Path, report: str | Path | None = None, picture: str | Path | None = None,
          inputs: Sequence[str | Path] = ()) -> None:
    """Write an as-built model (.step, .brep or .FCStd), and beside it its report and picture: all of them or none.

    Raises
    ------
    InputError : a destination cannot be written or is one of ``inputs``
    RefusedError : the disk is full, or the file would not hold the same model
    """
    files.check_output(Path(out))
    panels = [drawing.Panel("Nominal", _all(result.before), _edges(result.nominal.shape)),
              drawing.Panel("As built", _all(result.after), _edges(result.shape))] if picture else []
    outputs = _outputs((out, report, picture), inputs)
    with replacing(*outputs.values()) as temporary:
        target = dict(zip(outputs, temporary, strict=True))
        files.write(result.model, target[0])
        if report is not None:
            record.write(result.report, target[1])
        if picture is not None:
            _draw(target[2], result.nominal, result.scan, result.before, panels)


def write_deviation(result: Deviation, report: str | Path | None = None, picture: str | Path | None = None,
                    inputs: Sequence[str | Path] = ()) -> None:
    """Write the report and the picture of a deviation: both or none. Raises as `write` does."""
    outputs = _outputs((report, picture), inputs)
    with replacing(*outputs.values()) as temporary:
        target = dict(zip(outputs, temporary, strict=True))
        if report is not None:
            record.write(result.report, target[0])
        if picture is not None:
            panel = drawing.Panel("Deviation from the model", _all(result.faces), _edges(result.model.shape))
            _draw(target[1], result.model, result.scan, result.faces, [panel])


def simulate(model: Model | Part.Shape | object, settings: SensorSettings | None = None) -> Simulation:
    """Scan a model with the virtual sensor: ``.scan.points`` (n, 3) in mm, and ``.truth``.

    ``SensorSettings(views=(View((0, 0, 1)),), noise=0.13, seed=1)`` is one shot from above.

    Raises
    ------
    InputError, RefusedError : the model cannot be used, or the views see nothing of it
    """
    return simulate_shape(_as_model(model).shape, settings or SensorSettings())


def write_simulation(simulation: Simulation, out: str | Path, truth: str | Path | None = None,
                     inputs: Sequence[str | Path] = ()) -> None:
    """Write a simulated scan (.ply) and its truth (.npz): both or none. Raises as `write` does."""
    outputs = _outputs((out, truth), inputs)
    with replacing(*outputs.values()) as temporary:
        write_ply(temporary[0], simulation.scan.points)
        if truth is not None:
            simulation.truth.write(temporary[1])


def check_outputs(paths: Sequence[str | Path | None], inputs: Sequence[str | Path] = ()) -> None:
    """Refuse destinations that cannot be written, before any work is done (InputError)."""
    _outputs(paths, inputs)


def _outputs(paths: Sequence[str | Path | None], inputs: Sequence[str | Path]) -> dict[int, Path]:
    """The destinations that are asked for, by their place."""
    outputs = {place: Path(path) for place, path in enumerate(paths) if path is not None}
    if len({path.resolve() for path in outputs.values()}) < len(outputs):
        raise InputError("Two outputs have the same name: choose different ones.")
    for path in outputs.values():
        check_writable(path, [Path(item) for item in inputs])
    return outputs


def _with_checks(certificate: Certificate, before: int | None, after: int | None) -> Certificate:
    return Certificate(replace(certificate.before, boolean_check=before),
                       replace(certificate.after, boolean_check=after))


def _as_model(model: Model | Part.Shape | object) -> Model:
    return model if isinstance(model, Model) else files.from_object(model)


def _as_cloud(scan: PointCloud | np.ndarray) -> PointCloud:
    if isinstance(scan, PointCloud):
        return scan
    points = np.asarray(scan, dtype=float)
    if points.ndim != 2 or points.shape[1] != 3:
        raise InputError(f"A scan is an array of shape (n, 3), not {points.shape}.")
    finite = np.isfinite(points).all(axis=1)
    return PointCloud(points[finite], int((~finite).sum()))


def _check_request(method: str, lattice: Lattice, wanted: Collection[int] | None, frozen: Collection[int]) -> None:
    if method not in METHODS:
        raise InputError(f"The method '{method}' is unknown: use one of {', '.join(METHODS)}.")
    if lattice != "auto" and (isinstance(lattice, str) or min(lattice) < 4):
        raise InputError(f"The lattice {lattice} is unknown or too small: a cubic lattice has 4 or more control points "
                         f"in each direction, for instance 10x10.")
    both = sorted(set(wanted or ()) & set(frozen))
    if both:
        raise InputError(f"Face{both[0] + 1} is to be deformed and to be frozen: choose one.")
    if wanted is not None and not wanted:
        raise InputError("No face was named.")


def _box(shape: Part.Shape) -> tuple[np.ndarray, np.ndarray]:
    box = shape.BoundBox
    return np.array([box.XMin, box.YMin, box.ZMin]), np.array([box.XMax, box.YMax, box.ZMax])


def _diagonal(shape: Part.Shape) -> float:
    return float(shape.BoundBox.DiagonalLength)


def _register_faces(part: Workpiece, cloud: PointCloud, wanted: Sequence[int] | None, frozen: Collection[int],
                    method: str, lattice: Lattice, source_points: int, watch: Stopwatch) -> dict[int, FaceRegistration]:
    """Register each face by itself. A face that was not asked for by name and lacks data is left as it is."""
    if wanted is None:
        from .registration.observed import observed_faces

        geometries = [part.geometry(index) for index in range(len(part.faces))]
        indices = [index for index in observed_faces(geometries, cloud.points) if index not in frozen]
    else:
        indices = list(wanted)
    registrations: dict[int, FaceRegistration] = {}
    refusals: list[RefusedError] = []
    for count, index in enumerate(indices, 1):
        watch.tell(f"Registering {part.faces[index].name} ({count} of {len(indices)})")
        try:
            registrations[index] = _register_face(part, index, cloud, method, lattice, source_points)
        except RefusedError as refusal:
            if wanted is not None:
                raise
            refusals.append(refusal)
    if not registrations:
        if refusals:
            raise refusals[0]
        raise RefusedError("The scan observes no face of the model that may move: align the scan with the model, or "
                           "name the faces.")
    return registrations


def _register_face(part: Workpiece, index: int, cloud: PointCloud, method: str, lattice: Lattice,
                   source_points: int) -> FaceRegistration:
    face = part.geometry(index)
    if method in ("ffds", "ffd-hsu"):
        published = register_ffds if method == "ffds" else register_ffd
        return published(face, cloud.points, _PAPER_LATTICE if lattice == "auto" else lattice, source_points)
    return register_robust(face, cloud.points, None if lattice == "auto" else lattice)


def _report(part: Workpiece, cloud: PointCloud, registrations: Sequence[FaceRegistration],
            before: Sequence[FaceDeviation], after: Sequence[FaceDeviation], moved: Sequence[str],
            certificate: Certificate, watch: Stopwatch) -> dict[str, Any]:
    names = [face.name for face in part.faces]
    observed = [item.name for item in registrations]
    edge_faces = [[names[index] for index in faces] for faces in certificate.before.topology.edge_faces]
    noise = float(np.median([item.noise for item in registrations]))
    return {
        "faces": record.face_records(names, moved, registrations, before, after),
        "edges": record.edge_records(edge_faces, moved, observed),
        "deviation_before": record.all_figures(before), "deviation_after": record.all_figures(after),
        "topology": certificate.as_dict(),
        "scan": record.scan_record(cloud, noise),
        "sheet": {"thickness": None, "strain": None},
        "timing": watch.times()}


def _all(faces: Sequence[FaceDeviation]) -> np.ndarray:
    return np.concatenate([face.deviations for face in faces])


def _edges(shape: Part.Shape) -> list[np.ndarray]:
    return [np.array([tuple(point) for point in edge.discretize(50)]) for edge in shape.Edges if not edge.Degenerated]


def _draw(path: Path, model: Model, scan: PointCloud, faces: Sequence[FaceDeviation],
          panels: Sequence[drawing.Panel]) -> None:
    points = scan.points[np.concatenate([face.points for face in faces])]
    normals = np.concatenate([face.normals for face in faces])
    title = f"{model.label}: {len(points):,} scan points".replace(",", "\u202f")
    drawing.draw(path, title, points, normals, panels)
