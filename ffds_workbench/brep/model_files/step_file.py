# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP files that read back with the numbers of the shape that was written, or none."""
from __future__ import annotations

from pathlib import Path

import Part

from ...compat import write_step
from ...errors import RefusedError
from .. import topology
from ..topology import Topology
from . import step_colours
from .read_back import ReadBack, compare
from .reader import surface_types
from .step_colours import Decoration
from .step_free_shapes import with_free_shapes
from .step_order import ordered

_MOST_UNCERTAIN = 0.001
"""Of a larger tolerance (mm) the uncertainty in a STEP file says no more than this: readers drop what is shorter."""


def write(shape: Part.Shape, decoration: Decoration, path: Path) -> ReadBack:
    """Write a STEP file with names and colours, and read it back: arranged, or as it is where only that keeps its
    numbers.

    Raises
    ------
    RefusedError : the file could not be written
    """
    written = topology.read(shape)
    back = _write(ordered(shape), shape, written, decoration, path)
    return _write(shape, shape, written, decoration, path) if back.differences(written) else back


def _write(arranged: Part.Shape, shape: Part.Shape, written: Topology, decoration: Decoration, path: Path) -> ReadBack:
    """Write a shape arranged for STEP, and compare what reads back with the shape itself."""
    try:
        write_step(arranged, path)
    except (OSError, RuntimeError, Part.OCCError) as error:
        raise RefusedError(f"The STEP file could not be written: {error}.") from error
    if not path.exists() or not step_colours.is_complete(path):
        raise RefusedError("The STEP file could not be written whole: is the disk full?")
    text = with_free_shapes(path.read_text("utf-8"), shape)
    text = step_colours.decorate(text, decoration, surface_types(shape))
    path.write_text(step_colours.with_uncertainty(text, min(_tolerance(shape), _MOST_UNCERTAIN)), "utf-8")
    return compare(path.suffix.lower(), shape, written, Part.read(str(path)))


def _tolerance(shape: Part.Shape) -> float:
    """Largest tolerance of an edge or vertex in mm."""
    return max((part.Tolerance for part in (*shape.Edges, *shape.Vertexes)), default=0.0)
