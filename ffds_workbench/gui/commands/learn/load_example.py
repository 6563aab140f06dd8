# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_LoadExample: the bracket and its scan, in a document of their own."""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui

from ...running import call
from ..command import Command


class LoadExample(Command):
    """Makes a new document with the example."""

    NAME = "FFDS_LoadExample"
    MENU = "Load the example"
    TIP = "Open a sheet-metal bracket and a scan of it as it came out, to try everything on"
    HELP = "Opens a sheet-metal bracket and a scan of it as it came out of the press, to try everything on."
    KEYS = "F, X"

    def active(self) -> bool:
        """Always."""
        return True

    def run(self) -> None:
        """New document, part and scan."""
        Gui.doCommand("FreeCAD.newDocument('Bracket')")
        document = FreeCAD.ActiveDocument
        call(document, "Load the example", f"load_example(FreeCAD.getDocument({document.Name!r}))")
        view = Gui.getDocument(document.Name).ActiveView
        view.viewIsometric()
        view.fitAll()
