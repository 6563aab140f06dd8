# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report for people, of a registration: HTML and PDF."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..brep.rebuilt_faces import built_geometry
from ..brep.simulated_scan import edge_points
from ..errors import InputError
from ..output import replacing
from ..report.pages.content import content
from ..report.pages.html_file import html_text
from ..report.pages.pdf_file import write_pdf
from ..report.pages.pictures import picture
from ..report.pages.scene import ColouredPart, make_scene
from ..report.picture import side_of
from .destinations import destinations
from .registering import Result

_ALONG_EDGE = 33
"""Points of an edge in the pictures (unit: as fine as they show)."""


def write_pages(result: Result, html: str | Path | None = None, pdf: str | Path | None = None,
                inputs: Sequence[str | Path] = (), sides: Sequence[tuple[float, float, float]] = ()) -> None:
    """Write the report of a registration for people: both files or none. Waits for the check for Boolean operations.

    Parameters
    ----------
    result : what `register` gave
    html : one file that needs nothing beside it, with the part to turn where three.js is installed
    pdf : the same without that
    inputs : files that were read and must not be written over
    sides : from which it is seen in the pictures, vectors from the part to the viewer; none: the side that was scanned,
        and the other one

    Raises
    ------
    InputError : a destination cannot be written or is one of ``inputs``, or a side is no direction
    """
    outputs = destinations((html, pdf), inputs)
    if not outputs:
        return
    after = result.deviations[1]
    front = side_of(np.concatenate([face.normals for face in after]))
    chosen = [_direction(side) for side in sides] or [front, -front]
    request = {name: value for name, value in vars(result.request).items() if name != "sensor"}
    said, scene = content(result.nominal.label, result.report, request), _scene(result)
    with replacing(*outputs.values()) as temporary:
        for place, path in zip(outputs, temporary, strict=True):
            if place == 0:
                path.write_text(html_text(said, scene, [picture(scene, side) for side in chosen]), "utf-8")
            else:
                write_pdf(path, said, scene, chosen)


def _direction(side: Sequence[float]) -> np.ndarray:
    length = float(np.linalg.norm(side))
    if len(side) != 3 or not np.isfinite(length) or length == 0.0:
        raise InputError(f"The side {', '.join(map(str, side))} is no direction: give X,Y,Z, from the part to the "
                         f"viewer.")
    return np.asarray(side, dtype=float) / length


def _scene(result: Result) -> ColouredPart:
    built = [built_geometry(result.part, index, face) for index, face in enumerate(result.shape.Faces)]
    return make_scene(built, result.deviations, result.scan.points, list(edge_points(result.shape, _ALONG_EDGE)))
