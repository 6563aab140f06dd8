# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_FindSeams: seams along the selected edges, or where the parts of the selected one touch."""
from __future__ import annotations

import FreeCADGui as Gui

from ...qt import QtWidgets
from ...running import call, in_background, name_of, tell
from ...selection import chosen
from ...translating import said, tr
from ..command import Command, one_part

_TOLERANCE = 0.5


class FindSeams(Command):
    """Makes a Seams object that follows the part; its settings are in its properties."""

    NAME = "FFDS_FindSeams"
    MENU = "Find weld seams…"
    TIP = "Weld seams along the selected edges, or wherever the parts of the selected object lie on each other"
    HELP = ("Follows the selected edges, or finds the joints between the parts of the selected object. The seams "
            "follow the part; limits, torch angles, tool and base are in their properties.")
    KEYS = "F, M"
    NEEDS = "Select one part, or edges of one, first."

    def active(self) -> bool:
        """With one part selected, or edges of one."""
        part = one_part(chosen())
        return part is not None and not _is_seams(part) and not chosen().scans

    def run(self) -> None:
        """Ask for the tolerance where no edge is selected; measure in the background, then add the object."""
        from ....objects.jobs.seam_job import SeamWishes
        from ....objects.seams import prepare

        part, edges, tolerance = one_part(chosen()), selected_edges(), None
        if not edges:
            tolerance, accepted = QtWidgets.QInputDialog.getDouble(
                Gui.getMainWindow(), tr("Find weld seams"), tr(
                    "No edge is selected, so the joints are found by themselves.\n"
                    "Parts touch where they are nearer to each other than (mm):"), _TOLERANCE, 0.001, 50.0, 3)
            if not accepted:
                return
        plan = in_background(tr("Finding the seams"), prepare(part, SeamWishes(edges, tolerance)).run)
        which = f"edges={list(edges)}" if edges else f"tolerance={tolerance:g}"
        call(part.Document, "Find weld seams", f"make_seams({name_of(part)}, {which})")
        if plan.notes:
            tell(*map(said, plan.notes))


def selected_edges() -> tuple[str, ...]:
    """The names of the selected edges, each once."""
    names = (name for entry in Gui.Selection.getSelectionEx() for name in entry.SubElementNames)
    return tuple(dict.fromkeys(name for name in names if name.startswith("Edge")))


def selected_seams() -> object:
    """The selected Seams object where it is the only one selected, else None."""
    entries = Gui.Selection.getSelection()
    return entries[0] if len(entries) == 1 and _is_seams(entries[0]) else None


def _is_seams(item: object) -> bool:
    return "Verdicts" in getattr(item, "PropertiesList", ()) and "AsBuilt" in item.PropertiesList
