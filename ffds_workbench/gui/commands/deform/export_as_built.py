# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ExportAsBuilt: the selected part into a file, with its name and face colours."""
from __future__ import annotations

from pathlib import Path

import FreeCADGui as Gui

from ...qt import QtWidgets
from ...running import name_of, record
from ...selection import chosen
from ...translating import tr
from ..command import Command, one_part

_FORMATS = "STEP (*.step *.stp);;BREP (*.brep);;FCStd (*.FCStd)"


class ExportAsBuilt(Command):
    """Writes a file that is complete or not there."""

    NAME = "FFDS_ExportAsBuilt"
    MENU = "Export as-built part…"
    TIP = "Write the selected part as STEP, BREP or FCStd, with its name and face colours"
    HELP = ("Writes the selected part with its name and its face colours. The file is written whole or not at "
            "all.")
    KEYS = "F, E"
    NEEDS = "Select one part first."

    def active(self) -> bool:
        """With one part selected."""
        return one_part(chosen()) is not None

    def run(self) -> None:
        """Ask for a file and write it."""
        part = one_part(chosen())
        path, kind = QtWidgets.QFileDialog.getSaveFileName(
            Gui.getMainWindow(), tr("Export as-built part"), f"{part.Label.replace(' ', '_')}.step", _FORMATS)
        if not path:
            return
        suffix = "" if Path(path).suffix else {"S": ".step", "B": ".brep", "F": ".FCStd"}[(kind or "S")[0]]
        record(f"export_as_built({name_of(part)}, {path + suffix!r})")
