# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ExportReport: the report on the selected as-built part, as one page or as PDF."""
from __future__ import annotations

from pathlib import Path

import FreeCADGui as Gui

from ...qt import QtWidgets
from ...running import name_of, record
from ...selection import chosen
from ...translating import tr
from ..command import Command, one_as_built

_FORMATS = "HTML (*.html);;PDF (*.pdf)"


class ExportReport(Command):
    """Writes a file that is complete or not there."""

    NAME = "FFDS_ExportReport"
    MENU = "Export report…"
    TIP = "Write the report on the selected as-built part: one HTML page with the part to turn, or a PDF"
    HELP = ("Writes the verdict, pictures of the deviation, the table of the faces, the certificate and the settings "
            "of the selected as-built part. The page needs no network and holds the part to turn in the browser.")
    KEYS = "F, J"
    NEEDS = "Select one as-built part first."

    def active(self) -> bool:
        """With one as-built part selected."""
        return one_as_built(chosen()) is not None

    def run(self) -> None:
        """Ask for a file and write it in the background; its pictures show the side that is seen now, and the other."""
        part = one_as_built(chosen())
        path, kind = QtWidgets.QFileDialog.getSaveFileName(
            Gui.getMainWindow(), tr("Export report"), f"{part.Label.replace(' ', '_')}.html", _FORMATS)
        if not path:
            return
        path += "" if Path(path).suffix else ".pdf" if kind.startswith("PDF") else ".html"
        towards = [round(-value, 4) for value in Gui.ActiveDocument.ActiveView.getViewDirection()]
        sides = [tuple(towards), tuple(-value for value in towards)]
        record(f"export_report({name_of(part)}, {path!r}, sides={sides})")
