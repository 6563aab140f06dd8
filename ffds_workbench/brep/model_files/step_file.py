# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP files that read back with the numbers of the shape that was written, or none."""
from __future__ import annotations

from pathlib import Path

import Part

from ...compat import write_step
from ...errors import RefusedError
from .. import topology
from . import step_colours
from .read_back import ReadBack, compare
from .reader import surface_types
from .step_colours import Decoration
from .step_free_shapes import with_free_shapes
from .step_order import ordered

_MOST_UNCERTAIN = 0.001
"""Largest uncertainty that a STEP file states, in mm, where tolerances are larger: readers drop what is shorter
(unit)."""


def write(shape: Part.Shape, decoration: Decoration, path: Path) -> ReadBack:
    """Write a STEP file with names and colours, arranged so that it keeps the shape's numbers, and read it back.

    Raises
    ------
    RefusedError : the file could not be written
    """
    try:
        write_step(ordered(shape), path)
    except (OSError, RuntimeError, Part.OCCError) as error:
        raise RefusedError(f"The STEP file could not be written: {error}.") from error
    if not path.exists() or not step_colours.is_complete(path):
        raise RefusedError("The STEP file could not be written whole: is the disk full?")
    text = with_free_shapes(path.read_text("utf-8"), shape)
    text = step_colours.decorate(text, decoration, surface_types(shape))
    path.write_text(step_colours.with_uncertainty(text, min(_tolerance(shape), _MOST_UNCERTAIN)), "utf-8")
    return compare(path.suffix.lower(), shape, topology.read(shape), Part.read(str(path)))


def _tolerance(shape: Part.Shape) -> float:
    """Largest tolerance of an edge or vertex in mm."""
    return max((part.Tolerance for part in (*shape.Edges, *shape.Vertexes)), default=0.0)
