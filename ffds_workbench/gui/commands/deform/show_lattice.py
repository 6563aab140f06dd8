# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ShowLattice: draws the control lattices of the selected as-built part, or hides them."""
from __future__ import annotations

import FreeCADGui as Gui

from ...running import name_of
from ...selection import chosen
from ..command import Command, one_part


class ShowLattice(Command):
    """Switches the lattices before and after on and off."""

    NAME = "FFDS_ShowLattice"
    MENU = "Show control lattice"
    TIP = "Draw the control lattices of the selected as-built part, before and after, or hide them"
    HELP = ("Draws the control lattice of every deformed face of the selected as-built part, before (grey) and "
            "after (orange).")
    KEYS = "F, L"
    NEEDS = "Select one as-built part first."

    def active(self) -> bool:
        """With one as-built part selected."""
        part = one_part(chosen())
        return part is not None and "ShowLattice" in getattr(part.ViewObject, "PropertiesList", ())

    def run(self) -> None:
        """Switch."""
        part = one_part(chosen())
        part.Document.openTransaction("Show control lattice")
        Gui.doCommand(f"if {name_of(part)}.ViewObject: {name_of(part)}.ViewObject.ShowLattice = "
                      f"{not part.ViewObject.ShowLattice}")
        part.Document.commitTransaction()
