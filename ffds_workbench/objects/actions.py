# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the commands do to a document, one function each: macros record these calls and replay them headless.

Errors are `InputError` and `RefusedError`; a function that raises has left the document as it was.
"""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .. import RESOURCES, api
from ..brep.model_files import model_file
from ..errors import InputError
from ..output import check_writable, replacing
from . import scans, views
from .as_built import AsBuilt, apply_request, is_as_built, request_of
from .jobs import alignment_job, simulation_job
from .jobs.manual_alignment import align_by_points
from .jobs.preparation_job import prepare_scan
from .jobs.registration_job import Job, make_job
from .repointing import repoint
from .seams import add_trajectories, choose_seams, export_program, make_seams
from .sources import standing_for
from .waiting import wait_for

__all__ = ["add_trajectories", "align_by_points", "align_scan", "change_as_built", "choose_seams", "export_as_built",
           "export_program", "export_report", "import_scan", "job_of", "load_example", "make_as_built", "make_seams",
           "prepare_scan", "replace_in_place", "replace_scan", "repoint", "simulate_scan"]


def import_scan(document: Any, paths: str | Sequence[str], unit: str = "mm") -> Any:
    """A Points object of one scan file, or of several of one part; ``unit`` is that of the files."""
    names = [paths] if isinstance(paths, str) else list(paths)
    cloud = api.read_scan(names, unit)
    return scans.add_scan(document, cloud.points, Path(names[0]).stem, cloud.normals)


def replace_scan(scan: Any, paths: str | Sequence[str], unit: str = "mm") -> Any:
    """Put the points of another file, or of several, into a Points object; what depends on it is recomputed.

    Raises
    ------
    InputError : a file cannot be read
    """
    names = [paths] if isinstance(paths, str) else list(paths)
    cloud = api.read_scan(names, unit)
    scans.set_points(scan, cloud.points, cloud.normals)
    scan.Label = Path(names[0]).stem
    scan.Document.recompute()
    return scan


def align_scan(source: Any, scan: Any, mode: str = "global") -> Any:
    """Move a scan onto a part: ``mode`` "fine" from where it lies, "global" from anywhere. Returns the scan."""
    source = standing_for(source)
    scans.scan_points(scan)
    if scan.getParentGeoFeatureGroup() is not None:
        raise InputError(f"{scan.Label} lies in a part: drag it out into the document before aligning it.")
    aligned = alignment_job.find(source, scan, mode)
    scans.set_points(scan, aligned.scan.points, aligned.scan.normals)
    return scan


def make_as_built(source: Any, scan: Any, faces: Sequence[str] | None = None, **settings: Any) -> Any:
    """An as-built part beside its nominal one, which is hidden with earlier results; it follows scan and settings too.

    Parameters
    ----------
    source : the nominal part, any object with a shape
    scan : a Points object
    faces : names of the faces to deform, None for the whole part
    settings : freeze, method, lattice, source_points, isometry, stiffness, gate, as in `api.RegistrationRequest`

    Raises
    ------
    InputError, RefusedError : as `api.register` does
    """
    wanted = _request(faces, settings)
    job = make_job(source, scan, wanted)
    wait_for(job.source.item.Label, job.run)
    source = job.source.item
    item = source.Document.addObject("Part::FeaturePython", "AsBuilt")
    AsBuilt(item)
    item.Label = f"{source.Label} as built"
    item.Source, item.Scan = source, scan
    apply_request(item, wanted)
    holder = source.getParentGroup() or source.getParentGeoFeatureGroup()
    if holder is not None:
        holder.addObject(item)
    item.recompute()
    views.dress(item, source)
    for other in (source, *_results_of(source)):
        other.Visibility = other is item
    for other in (item, holder):
        if other is not None and other.isValid():
            other.purgeTouched()
    return item


def change_as_built(item: Any, faces: Sequence[str] | None = None, scan: Any = None, **settings: Any) -> Any:
    """Give an as-built part other settings, and another scan if one is named; unnamed settings take their defaults."""
    if not is_as_built(item):
        raise InputError(f"{item.Label} is no as-built part of this workbench.")
    wanted = _request(faces, settings)
    wait_for(item.Label, make_job(item.Source, scan or item.Scan, wanted).run)
    item.Scan = scan or item.Scan
    apply_request(item, wanted)
    item.recompute()
    if item.isValid() and not item.InList:
        item.purgeTouched()
    return item


def replace_in_place(source: Any, scan: Any, faces: Sequence[str] | None = None, **settings: Any) -> Any:
    """Write the as-built shape into the part itself, which must be a plain shape without a history of its own."""
    if source.TypeId != "Part::Feature":
        raise InputError(f"{source.Label} is computed from other things and cannot be replaced in place: make a simple "
                         f"copy of it, or an as-built part beside it.")
    job = make_job(source, scan, _request(faces, settings))
    shape = wait_for(source.Label, job.run).shape.copy()
    shape.Placement = job.source.placement
    source.Shape = shape
    return source


def simulate_scan(source: Any, spacing: float = 0.5, noise: float = 0.05,
                  views: Sequence[tuple[float, float, float]] = (), outliers: float = 0.0, seed: int = 0) -> Any:
    """Scan a part with the virtual sensor: a Points object. ``views`` are directions from the part to the camera; none:
    the whole surface is seen. Lengths in mm."""
    source = standing_for(source)
    points = wait_for(source.Label, simulation_job.prepare(source, spacing, noise, views, outliers, seed))
    return scans.add_scan(source.Document, points, f"{source.Label} scanned")


def load_example(document: Any) -> tuple[Any, Any]:
    """The bracket of the README and its scan: (part, scan)."""
    model = api.read_model(RESOURCES / "examples" / "bracket.step")
    part = document.addObject("Part::Feature", "Bracket")
    part.Shape = model.shape
    part.purgeTouched()
    if getattr(part, "ViewObject", None) is not None:
        part.ViewObject.DiffuseColor = list(model.decoration.colours)
    return part, import_scan(document, str(RESOURCES / "examples" / "bracket_scan.ply"))


def export_as_built(item: Any, path: str) -> None:
    """Write a part with its name and colours as .step, .brep or .FCStd: whole or not at all."""
    model = model_file.from_object(item)
    api.check_model_output(path)
    check_writable(Path(path))
    with replacing(Path(path)) as temporary:
        model_file.write(model, temporary[0])


def export_report(item: Any, path: str, sides: Sequence[tuple[float, float, float]] = ()) -> None:
    """Write the report on an as-built part for people, as .html or .pdf: whole or not at all.

    ``sides`` are those from which its pictures show it, vectors from the part to the viewer.

    Raises
    ------
    InputError : the object is no as-built part, or the file is of another format or cannot be written
    """
    if not is_as_built(item):
        raise InputError(f"{item.Label} is no as-built part of this workbench.")
    kind = Path(path).suffix.lower()
    if kind not in (".html", ".pdf"):
        raise InputError(f"The report {path} is of an unknown format: use .html or .pdf.")
    api.check_outputs((path,))
    job = job_of(item)
    wait_for(item.Label, lambda progress: api.write_pages(job.run(progress), **{kind[1:]: path}, sides=sides))


def job_of(item: Any) -> Job:
    """The registration that an as-built part stands for."""
    return make_job(item.Source, item.Scan, request_of(item))


def _results_of(source: Any) -> list[Any]:
    """The as-built parts that are made from a part."""
    return [item for item in source.InList if is_as_built(item) and item.Source is source]


def _request(faces: Sequence[str] | None, settings: dict[str, Any]) -> api.RegistrationRequest:
    """A request of plain values, of what a document keeps."""
    request = api.as_request(faces, **settings)
    if request.align != "none" or request.sensor is not None:
        raise InputError("An as-built part takes its scan as it lies, and no sensor profile: align the scan first.")
    return request
