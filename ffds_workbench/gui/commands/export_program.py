# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ExportProgram: the selected seams as a robot's program, a table, a report or a picture."""
from __future__ import annotations

from pathlib import Path

import FreeCADGui as Gui

from ..qt import QtWidgets
from ..running import in_background, name_of, record, tell
from ..translating import said, tr
from .command import Command
from .find_seams import selected_seams


def _formats() -> dict[str, str]:
    """What the file dialog offers, and the suffix it stands for."""
    return {tr("KUKA program (*.src)"): ".src", tr("ABB program (*.mod)"): ".mod",
            tr("Universal Robots program (*.script)"): ".script", tr("Table of stations (*.csv)"): ".csv",
            tr("FreeCAD document with trajectories (*.FCStd)"): ".FCStd", tr("Report (*.json)"): ".json",
            tr("Picture of the report (*.png)"): ".png"}


class ExportProgram(Command):
    """Writes files that are complete or not there; tool, base and velocity are properties of the seams."""

    NAME = "FFDS_ExportProgram"
    MENU = "Export robot program…"
    TIP = "Write the selected seams for KUKA, ABB or Universal Robots, or as a table, a report or a picture"
    HELP = ("Writes the selected seams for KUKA, ABB or Universal Robots, as a table, as a report or as a "
            "picture.")
    KEYS = "F, P"

    def active(self) -> bool:
        """With seams selected."""
        return selected_seams() is not None

    def run(self) -> None:
        """Ask for a file and write it."""
        from ...objects.seams import job_of

        item = selected_seams()
        stem = item.Label.replace(" ", "_")
        path, kind = QtWidgets.QFileDialog.getSaveFileName(
            Gui.getMainWindow(), tr("Export robot program"), f"{stem}.src", ";;".join(_formats()))
        if not path:
            return
        path += "" if Path(path).suffix else _formats().get(kind, ".src")
        in_background(tr("Measuring the seams"), job_of(item).run)
        record(f"export_program({name_of(item)}, {path!r})", "notes")
        import __main__ as console

        if console.notes:
            tell("\n".join(map(said, console.notes)))
