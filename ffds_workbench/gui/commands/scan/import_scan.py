# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ImportScan: scan files into a Points object; the unit is asked for where it looks wrong."""
from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui
import numpy as np

from ...qt import QtWidgets, execute
from ...running import Cancelled, call, in_background, name_of
from ...selection import chosen
from ...translating import tr
from ..command import Command

_PLAUSIBLE = (0.05, 20.0)
"""Sizes of a scan as multiples of the part's that need no question."""
_SMALLEST = 5.0
"""Without a part to compare with, a scan below this size (mm) is asked about."""


class ImportScan(Command):
    """Reads all formats of the command line; several files of one part are fused."""

    NAME = "FFDS_ImportScan"
    MENU = "Import scan…"
    TIP = "Import a scan as a point cloud: PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 or STL; several files are fused"
    HELP = ("Reads PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 and STL files into a point cloud. Several files of one "
            "part become one scan. Where the size of the scan does not suit the part, the unit is asked for. With "
            "a scan selected, its points can be replaced, and what was made from it follows.")
    KEYS = "F, I"

    def active(self) -> bool:
        """Always: a document is made where there is none."""
        return True

    def run(self) -> None:
        """Ask for files, for their unit where it looks wrong, and whether a selected scan is to be replaced."""
        from ....scan.files import FORMATS, read

        patterns = " ".join(f"*{suffix} *{suffix.upper()}" for suffix in FORMATS)
        paths, _ = QtWidgets.QFileDialog.getOpenFileNames(
            Gui.getMainWindow(), tr("Import scan"), "", tr("Scans") + f" ({patterns})")
        if not paths:
            return
        cloud = in_background(tr("Reading the scan"), lambda progress: read(paths))
        unit = self._unit(float(np.linalg.norm(np.ptp(cloud.points, axis=0))))
        if unit is None:
            return
        selected = chosen().scans
        replaced = _ask_whether_to_replace(selected[0]) if len(selected) == 1 else None
        if replaced is not None:
            _replace(replaced, paths, unit)
            return
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument("Scan")
        target = f"FreeCAD.getDocument({document.Name!r})"
        call(document, "Import scan", f"import_scan({target}, {paths!r}, unit={unit!r})")
        Gui.SendMsgToActiveView("ViewFit")

    def _unit(self, size: float) -> str | None:
        """The unit of files whose points span ``size``, None if the user wants none."""
        from ....scan.units import MILLIMETRES, NAMES

        part = _part_size()
        if part is not None and _PLAUSIBLE[0] < size / part < _PLAUSIBLE[1] or part is None and size > _SMALLEST:
            return "mm"
        units = list(MILLIMETRES)
        entries = [tr("{unit}: it is {size} mm across").format(unit=NAMES[unit], size=f"{size * MILLIMETRES[unit]:.4g}")
                   for unit in units]
        best = min(range(len(units)), key=lambda k: abs(np.log(size * MILLIMETRES[units[k]] / (part or 200.0))))
        known = tr("The part is {size} mm across.").format(size=f"{part:.4g}") + " " if part is not None else ""
        entry, accepted = QtWidgets.QInputDialog.getItem(
            Gui.getMainWindow(), tr("Unit of the scan"), known + tr("In which unit is the scan?"), entries, best, False)
        return units[entries.index(entry)] if accepted else None


def _ask_whether_to_replace(scan: Any) -> Any:
    """The scan where it is to be replaced, None where a new one is to be added.

    Raises
    ------
    Cancelled : the user wants neither
    """
    box = QtWidgets.QMessageBox(QtWidgets.QMessageBox.Question, "FFDS", tr(
        "Replace the points of {scan}, so that what was made from it follows, or add another scan?"
    ).format(scan=scan.Label), QtWidgets.QMessageBox.Cancel, Gui.getMainWindow())
    box.setObjectName("FfdsReplace")
    replace = box.addButton(tr("Replace"), QtWidgets.QMessageBox.AcceptRole)
    add = box.addButton(tr("Add"), QtWidgets.QMessageBox.AcceptRole)
    execute(box)
    if box.clickedButton() not in (replace, add):
        raise Cancelled
    return scan if box.clickedButton() is replace else None


def _replace(scan: Any, paths: list[str], unit: str) -> None:
    """Compute what depends on the scan in the background, then replace it in one undo step."""
    from ....api import read_scan
    from ....objects.as_built import is_as_built, request_of
    from ....objects.jobs.registration_job import job_on
    from ....objects.scans import as_stored

    cloud = as_stored(scan, read_scan(paths, unit))
    for item in scan.InList:
        if is_as_built(item) and item.Scan is scan:
            in_background(tr("Computing {part}").format(part=item.Label),
                          job_on(item.Source, cloud, request_of(item)).run)
    call(scan.Document, "Replace scan", f"replace_scan({name_of(scan)}, {paths!r}, unit={unit!r})")


def _part_size() -> float | None:
    """Diagonal of the largest shape of the active document in mm."""
    objects: Any = FreeCAD.ActiveDocument.Objects if FreeCAD.ActiveDocument is not None else ()
    shapes = [item.Shape for item in objects if getattr(getattr(item, "Shape", None), "Faces", ())]
    sizes = [shape.BoundBox.DiagonalLength for shape in shapes]
    return max(sizes, default=None)
