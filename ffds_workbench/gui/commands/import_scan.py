# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ImportScan: scan files into a Points object; the unit is asked for where it looks wrong."""
from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui
import numpy as np

from ..qt import QtWidgets
from ..running import call, in_background
from .command import Command

_PLAUSIBLE = (0.05, 20.0)
"""Sizes of a scan as multiples of the part's that need no question."""
_SMALLEST = 5.0
"""Without a part to compare with, a scan below this size (mm) is asked about."""


class ImportScan(Command):
    """Reads all formats of the command line; several files of one part are fused."""

    NAME = "FFDS_ImportScan"
    MENU = "Import scan…"
    TIP = "Import a scan as a point cloud: PLY, PCD, XYZ, ASC, TXT, CSV, PTS, E57 or STL; several files are fused"
    KEYS = "F, I"

    def active(self) -> bool:
        """Always: a document is made where there is none."""
        return True

    def run(self) -> None:
        """Ask for files, and for their unit where it looks wrong."""
        from ...scan.files import FORMATS, read

        patterns = " ".join(f"*{suffix} *{suffix.upper()}" for suffix in FORMATS)
        paths, _ = QtWidgets.QFileDialog.getOpenFileNames(Gui.getMainWindow(), "Import scan", "", f"Scans ({patterns})")
        if not paths:
            return
        cloud = in_background("Reading the scan", lambda progress: read(paths))
        unit = self._unit(float(np.linalg.norm(np.ptp(cloud.points, axis=0))))
        if unit is None:
            return
        document = FreeCAD.ActiveDocument or FreeCAD.newDocument("Scan")
        target = f"FreeCAD.getDocument({document.Name!r})"
        call(document, "Import scan", f"import_scan({target}, {paths!r}, unit={unit!r})")
        Gui.SendMsgToActiveView("ViewFit")

    def _unit(self, size: float) -> str | None:
        """The unit of files whose points span ``size``, None if the user wants none."""
        from ...scan.units import MILLIMETRES, NAMES

        part = _part_size()
        if part is not None and _PLAUSIBLE[0] < size / part < _PLAUSIBLE[1] or part is None and size > _SMALLEST:
            return "mm"
        units = list(MILLIMETRES)
        entries = [f"{NAMES[unit]}: it is {size * MILLIMETRES[unit]:.4g} mm across" for unit in units]
        best = min(range(len(units)), key=lambda k: abs(np.log(size * MILLIMETRES[units[k]] / (part or 200.0))))
        known = f"The part is {part:.4g} mm across. " if part is not None else ""
        entry, accepted = QtWidgets.QInputDialog.getItem(
            Gui.getMainWindow(), "Unit of the scan", f"{known}In which unit is the scan?", entries, best, False)
        return units[entries.index(entry)] if accepted else None


def _part_size() -> float | None:
    """Diagonal of the largest shape of the active document in mm."""
    objects: Any = FreeCAD.ActiveDocument.Objects if FreeCAD.ActiveDocument is not None else ()
    shapes = [item.Shape for item in objects if getattr(getattr(item, "Shape", None), "Faces", ())]
    sizes = [shape.BoundBox.DiagonalLength for shape in shapes]
    return max(sizes, default=None)
