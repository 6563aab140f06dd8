# SPDX-License-Identifier: LGPL-2.1-or-later
"""The job ``prepare``: a raw scan is cropped, cleaned and thinned for registration, and written."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import Part

from ..brep.model_files import Model
from ..errors import InputError
from ..output import replacing
from ..report import record
from ..report.stopwatch import Progress
from ..scan.cloud import PointCloud
from ..scan.preparation import PartSurface, PreparationSettings, PreparedScan
from ..scan.preparation import prepare as prepare_clouds
from ..scan.sensor.files import write_ply
from .destinations import destinations
from .inputs import as_cloud, as_model

_SAG = 0.05
"""How far the triangles of the model may be from it, as a part of the distance within which the scan is kept."""


def prepare(scans: Sequence[PointCloud | np.ndarray | str | Path], model: Model | Part.Shape | str | Path | None = None,
            progress: Progress = lambda text: None, **settings: Any) -> PreparedScan:
    """Fuse, crop, clean and thin scans; see `PreparationSettings` for the steps and their order.

    ``api.prepare(["scan.ply"], remove_plane=True, spacing=0.5).scan`` is a scan that `register` takes.

    Parameters
    ----------
    scans : one or several; files are in mm
    model : where ``near`` is a distance from it; the scans must be aligned with it
    progress : called with what is being done
    settings : of `PreparationSettings`

    Raises
    ------
    InputError : the settings are none, ask for nothing, or need a model or open3d that is not there
    RefusedError : nothing of the scan would be left, or the scans do not overlap
    """
    try:
        wanted = PreparationSettings(**settings)
    except TypeError as unknown:
        raise InputError(f"Preparing has no such setting: {unknown}.") from None
    if not wanted.any_step:
        raise InputError("No step was asked for: name one, for instance --remove-plane, --remove-clutter or --spacing.")
    if (wanted.near is None) != (model is None):
        raise InputError("Cropping to a model needs both, the model and a distance from it.")
    names = [str(scan) if isinstance(scan, (str, Path)) else f"number {number}"
             for number, scan in enumerate(scans, 1)]
    surface = None
    if model is not None and wanted.near is not None:
        surface = _surface(as_model(model).shape, _SAG * wanted.near)
    return prepare_clouds([as_cloud(scan) for scan in scans], wanted, surface, names, progress)


def write_prepared(prepared: PreparedScan, out: str | Path, report: str | Path | None = None,
                   inputs: Sequence[str | Path] = ()) -> None:
    """Write a prepared scan, in mm, and its report: both or none. Raises as `write` does.

    Parameters
    ----------
    prepared : what `prepare` gave
    out, report : files, .ply (as doubles) and .json
    inputs : files that were read and must not be written over
    """
    outputs = destinations((out, report), inputs)
    with replacing(*outputs.values()) as temporary:
        write_ply(temporary[0], prepared.scan.points, prepared.scan.normals)
        if report is not None:
            record.write({"scan": record.scan_record(prepared.scan, None),
                          "spacing": {"before": prepared.spacing[0], "after": prepared.spacing[1]},
                          "steps": [step.as_dict() for step in prepared.steps]}, temporary[1])


def _surface(shape: Part.Shape, sag: float) -> PartSurface:
    vertices, triangles = shape.copy().tessellate(sag)  # the shape keeps no mesh
    return PartSurface(np.array([tuple(vertex) for vertex in vertices]), np.array(triangles))
