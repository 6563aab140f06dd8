# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ExportProgram: the selected seams as a robot's program, a table, a report or a picture."""
from __future__ import annotations

from pathlib import Path

import FreeCADGui as Gui

from ..qt import QtWidgets
from ..running import ACTIONS, in_background, name_of
from .command import Command
from .find_seams import selected_seams

_FORMATS = {"KUKA program (*.src)": ".src", "ABB program (*.mod)": ".mod",
            "Universal Robots program (*.script)": ".script",
            "Table of stations (*.csv)": ".csv", "FreeCAD document with trajectories (*.FCStd)": ".FCStd",
            "Report (*.json)": ".json", "Picture of the report (*.png)": ".png"}


class ExportProgram(Command):
    """Writes files that are complete or not there; tool, base and velocity are properties of the seams."""

    NAME = "FFDS_ExportProgram"
    MENU = "Export robot program…"
    TIP = "Write the selected seams for KUKA, ABB or Universal Robots, or as a table, a report or a picture"
    KEYS = "F, P"

    def active(self) -> bool:
        """With seams selected."""
        return selected_seams() is not None

    def run(self) -> None:
        """Ask for a file and write it."""
        from ...objects.seams import job_of

        item = selected_seams()
        stem = item.Label.replace(" ", "_")
        path, kind = QtWidgets.QFileDialog.getSaveFileName(Gui.getMainWindow(), "Export robot program", f"{stem}.src",
                                                           ";;".join(_FORMATS))
        if not path:
            return
        path += "" if Path(path).suffix else _FORMATS.get(kind, ".src")
        in_background("Measuring the seams", job_of(item).run)
        Gui.addModule(ACTIONS)
        Gui.doCommand(f"{ACTIONS}.export_program({name_of(item)}, {path!r})")
