# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds benchmark topology``: whether real CAD files keep their topology when their faces move.

Every shape is rebuilt (a) where it is, (b) with a bump on one face and the faces around it adapting, once on the
busiest face and once on a middle one, and (c) warped as a whole, smoothly. Each result is compared with its nominal.
Bumps are rebuilt as closely as ``register`` does it, identity and warp as closely as the rebuild does by itself.
"""
from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import Part

from .. import ROOT
from ..api.certified import REBUILD_TOLERANCE
from ..brep import topology, workpiece
from ..brep.continuity import local_displacements
from ..brep.face_displacement import FaceDisplacement
from ..brep.model_files import step_file
from ..brep.model_files.step_colours import Decoration
from ..brep.rebuild import SURFACE_TOLERANCE, rebuild
from ..brep.workpiece import Workpiece
from ..errors import FfdsError
from ..report.boolean_check import boolean_checks, total
from ..report.certificate import Certificate, Condition, broken, condition
from .pages import page
from .pages.page import Section, Table
from .simulated import topology_shapes

Progress = Callable[[str], None]

BOOLEAN_LIMIT = 60.0
_DEVIATION_LIMIT = 1e-4
_VOLUME_LIMIT = 1e-6
_EXACT_TOLERANCE = 1e-4
_NO_FILES = "The parts, scans and cases beside the project are absent: only FreeCAD's own primitives were measured."


@dataclass(frozen=True)
class Row:
    """One shape in one mode.

    Attributes
    ----------
    shape, mode : names
    moved, faces : faces that moved, and all
    kept : same counts in the same order, valid, and closed where it was
    gap, excess_gap : the nominal's own largest edge gap in mm, and what the result's is beyond it
    tolerance : largest tolerance in mm, before and after
    tolerance_line : what the largest tolerance may be, in mm
    boolean_check : errors of the check for Boolean operations, of all bodies by themselves, before and after; None
        where it did not finish
    step : whether the STEP file reads back with the same counts and valid
    step_check : errors of the check for Boolean operations on what it reads back as
    deviation : largest distance from the nominal in mm (identity only)
    volume : relative change of volume
    poles : control points of the faces that moved
    seconds : field and rebuild
    problems : one sentence for everything that misses what is asked
    """

    shape: str
    mode: str
    moved: int
    faces: int
    kept: bool
    gap: float
    excess_gap: float
    tolerance: tuple[float, float]
    tolerance_line: float
    boolean_check: tuple[int | None, int | None]
    step: bool
    step_check: int | None
    deviation: float | None
    volume: float
    poles: int
    seconds: float
    problems: tuple[str, ...]


@dataclass(frozen=True)
class Refused:
    """One shape in one mode that was turned down."""

    shape: str
    mode: str
    reason: str


def run(folder: Path, progress: Progress) -> str:
    """Measure, and write ``topology.json``, ``topology.md`` and ``topology.html``; returns the tables."""
    data = ROOT.parent / "shared" / "data"
    rows: list[Row | Refused] = []
    for name, path in topology_shapes.files(data):
        shape = Part.Shape()
        shape.read(str(path))
        rows += measure(name, shape, progress)
    for name, shape in topology_shapes.primitives():
        rows += measure(name, shape, progress)
    text = ["Every shape is rebuilt where it is (identity), with a bump of 2.5 % of a face's size on the face with "
            "most edges and on the middle face of the list, the faces around it adapting, and warped as a whole by "
            "2 %."]
    if not data.is_dir():
        text.append(_NO_FILES)
    return page.write(folder, "topology", "What keeps its topology", [Section("Results", text, tables=_tables(rows))],
                      {"rows": [asdict(row) for row in rows]})


def measure(name: str, shape: Part.Shape, progress: Progress) -> list[Row | Refused]:
    """All modes of one shape."""
    part = workpiece.read(shape)
    nominal = condition(shape, boolean_checks((shape,), BOOLEAN_LIMIT)[0])
    busiest, middle = topology_shapes.busiest_and_middle(part)
    modes: dict[str, Callable[[], dict[int, FaceDisplacement]]] = {
        "identity": lambda: topology_shapes.identity(part),
        "bump, busiest": lambda: _bumped(part, busiest),
        "bump, middle": lambda: _bumped(part, middle),
        "warp": lambda: topology_shapes.warp(part)}
    rows: list[Row | Refused] = []
    for mode, displacements in modes.items():
        progress(f"{name}: {mode}")
        try:
            rows.append(_row(name, mode, part, nominal, displacements))
        except FfdsError as error:
            rows.append(Refused(name, mode, str(error)))
    return rows


def _bumped(part: Workpiece, face: int) -> dict[int, FaceDisplacement]:
    return local_displacements(part, {face: topology_shapes.bump(part.faces[face])})


def _row(name: str, mode: str, part: Workpiece, nominal: Condition,
         displacements: Callable[[], Mapping[int, FaceDisplacement]]) -> Row:
    start = time.perf_counter()
    moved = displacements()
    result = rebuild(part, moved, REBUILD_TOLERANCE if mode.startswith("bump") else SURFACE_TOLERANCE)
    seconds = time.perf_counter() - start
    back = _read_back(result)
    errors = boolean_checks((result,) if back is None else (result, back), BOOLEAN_LIMIT)
    certificate = Certificate(nominal, condition(result, errors[0]))
    deviation = _deviation(part, result) if mode == "identity" else None
    volume = abs(result.Volume - part.shape.Volume) / max(abs(part.shape.Volume), 1e-12)
    problems = certificate.problems()
    if back is None:
        problems.append("The STEP file does not read back." if _read_back(part.shape) is not None else
                        "The STEP file does not read back, nor does the nominal's.")
    if deviation is not None and deviation > _DEVIATION_LIMIT:
        problems.append(f"The identity is {deviation:.2g} mm off.")
    if mode == "identity" and nominal.max_tolerance <= _EXACT_TOLERANCE and volume > _VOLUME_LIMIT:
        problems.append(f"The identity changes the volume by {volume:.1g}.")
    return Row(name, mode, len(moved), len(part.faces), not broken(nominal, certificate.after), nominal.max_edge_gap,
               certificate.excess_gap, (nominal.max_tolerance, certificate.after.max_tolerance),
               certificate.tolerance_line,
               (nominal.boolean_errors, certificate.after.boolean_errors), back is not None,
               None if back is None else total(errors[1]), deviation, volume,
               sum(_poles(result.Faces[face]) for face in moved), seconds, tuple(problems))


def _poles(face: Part.Face) -> int:
    surface = face.Surface
    return surface.NbUPoles * surface.NbVPoles


def _deviation(part: Workpiece, result: Part.Shape) -> float:
    """Largest distance in mm between faces at the same (u, v), off the knots."""
    largest = 0.0
    for face, new in zip(part.faces, result.Faces, strict=True):
        box = face.box
        u, v = np.linspace(box.u0, box.u1, 38)[1:-1], np.linspace(box.v0, box.v1, 38)[1:-1]
        value = new.Surface.value
        there = np.array([tuple(value(a, b)) for a in u for b in v])
        largest = max(largest, float(np.linalg.norm(there - face.on_grid(u, v).reshape(-1, 3), axis=1).max()))
    return largest


def _read_back(shape: Part.Shape) -> Part.Shape | None:
    """What the shape's STEP file reads back as, if that has as many sub-shapes and is valid.

    Under the same numbers only what a STEP file was once read for: FreeCAD stores loops that STEP cannot say.
    """
    with tempfile.TemporaryDirectory() as folder:
        try:
            back = step_file.write(shape, Decoration(product="shape"), Path(folder) / "shape.step")
        except FfdsError:
            return None
    return back.shape if not back.counts(topology.read(shape)) and back.shape.isValid() else None


def _tables(rows: list[Row | Refused]) -> list[Table]:
    measured = [row for row in rows if isinstance(row, Row)]
    tables = [Table("Shapes without a flaw", ("mode", "shapes", "kept", "edge gaps", "tolerance", "Boolean check",
                                               "STEP", "no problem"), _summary(rows)),
              Table("Every shape", ("shape", "mode", "moved", "kept", "excess gap", "tolerance", "Boolean check",
                                    "STEP", "its check", "deviation", "volume", "poles", "s"),
                    [_cells(row) for row in measured])]
    exceptions = [(row.shape, row.mode, row.reason if isinstance(row, Refused) else " ".join(row.problems))
                  for row in rows if isinstance(row, Refused) or row.problems]
    return [*tables, Table("Exceptions", ("shape", "mode", "what"), exceptions)] if exceptions else tables


def _summary(rows: list[Row | Refused]) -> list[tuple[str, ...]]:
    lines: list[tuple[str, ...]] = []
    for mode in dict.fromkeys(row.mode for row in rows):
        of_mode = [row for row in rows if row.mode == mode]
        done = [row for row in of_mode if isinstance(row, Row)]
        both = [(before, after) for before, after in (row.boolean_check for row in done)
                if before is not None and after is not None]
        lines.append((mode, str(len(of_mode)), str(sum(row.kept for row in done)),
                      str(sum(row.excess_gap <= 1e-4 for row in done)),
                      str(sum(row.tolerance[1] <= row.tolerance_line for row in done)),
                      f"{sum(after <= before for before, after in both)} of {len(both)} finished",
                      str(sum(row.step for row in done)), str(sum(not row.problems for row in done))))
    return lines


def _cells(row: Row) -> tuple[str, ...]:
    before, after = ("–" if count is None else str(count) for count in row.boolean_check)
    return (row.shape, row.mode, f"{row.moved} of {row.faces}", "yes" if row.kept else "NO", f"{row.excess_gap:.1e}",
            f"{row.tolerance[0]:.1e} → {row.tolerance[1]:.1e}", f"{before} → {after}", "yes" if row.step else "NO",
            "–" if row.step_check is None else str(row.step_check),
            "" if row.deviation is None else f"{row.deviation:.1e}", f"{row.volume:.1e}", str(row.poles),
            f"{row.seconds:.2f}")
