# SPDX-License-Identifier: LGPL-2.1-or-later
"""The output files of the jobs, which appear complete or not at all."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import Part

from ..brep.model_files import Model, model_file
from ..output import replacing
from ..report import record
from ..report import picture as drawing
from ..report.deviation import FaceDeviation
from ..report.file_certificate import FileCertificate, certify_file
from ..scan.cloud import PointCloud
from .certified import CertifiedModel
from .destinations import destinations
from .deviating import Deviation
from .registering import Result


def write(result: Result, out: str | Path, report: str | Path | None = None, picture: str | Path | None = None,
          inputs: Sequence[str | Path] = ()) -> FileCertificate:
    """Write an as-built model (.step, .brep or .FCStd), and after it its report and picture: both of these or none.

    The model is read back and certified before it replaces an earlier file, and waits for nothing else; the deviation
    is measured after it, and the report waits for the check for Boolean operations.

    Parameters
    ----------
    result : what `register` gave
    out, report, picture : files: .step, .brep or .FCStd, .json, and .png
    inputs : files that were read and must not be written over

    Raises
    ------
    InputError : a destination cannot be written or is one of ``inputs``
    RefusedError : the disk is full, or the file would not hold the same model
    """
    model_file.check_output(Path(out))
    outputs = destinations((out, report, picture), inputs)
    certificate = write_certified(result, outputs.pop(0))
    with replacing(*outputs.values()) as temporary:
        target = dict(zip(outputs, temporary, strict=True))
        if picture is not None:
            before, after = result.deviations
            _draw(target[2], result.nominal, [_panel("Nominal", result.nominal.shape, result.scan, before),
                                              _panel("As built", result.shape, result.scan, after)])
        if report is not None:
            topology = result.report["topology"] | {"written": certificate.as_dict()}
            record.write(result.report | {"topology": topology}, target[1])
    return certificate


def write_certified(result: CertifiedModel, path: Path) -> FileCertificate:
    """Write a deformed model, read it back and certify it before it replaces an earlier file.

    Parameters
    ----------
    result : the model
    path : .step, .brep or .FCStd

    Raises
    ------
    RefusedError : the disk is full, or the file would not hold the same model
    """
    with replacing(path) as temporary:
        back = model_file.write(result.model, temporary[0])
        return certify_file(result.nominal.shape, result.unchecked.before, back)


def write_deviation(result: Deviation, report: str | Path | None = None, picture: str | Path | None = None,
                    inputs: Sequence[str | Path] = ()) -> None:
    """Write the report and the picture of a deviation: both or none. Raises as `write` does.

    Parameters
    ----------
    result : what `deviation` gave
    report, picture : files: .json, and .png
    inputs : files that were read and must not be written over
    """
    outputs = destinations((report, picture), inputs)
    with replacing(*outputs.values()) as temporary:
        target = dict(zip(outputs, temporary, strict=True))
        if report is not None:
            record.write(result.report, target[0])
        if picture is not None:
            _draw(target[1], result.model, [_panel("Deviation from the model", result.model.shape, result.scan,
                                                   result.faces)])


def _panel(title: str, shape: Part.Shape, scan: PointCloud, faces: Sequence[FaceDeviation]) -> drawing.Panel:
    """The points nearest to the faces of a shape; those of another state of it may be others."""
    return drawing.Panel(title, scan.points[np.concatenate([face.points for face in faces])],
                         np.concatenate([face.normals for face in faces]),
                         np.concatenate([face.deviations for face in faces]), _edges(shape))


def _edges(shape: Part.Shape) -> list[np.ndarray]:
    return [np.array([tuple(point) for point in edge.discretize(50)]) for edge in shape.Edges if not edge.Degenerated]


def _draw(path: Path, model: Model, panels: Sequence[drawing.Panel]) -> None:
    drawing.draw(path, f"{model.label}: {len(panels[0].points):,} scan points".replace(",", "\u202f"), panels)
