# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_AddTrajectory: the selected seams as trajectories of FreeCAD's Robot workbench."""
from __future__ import annotations

from ...running import call, in_background, name_of
from ...translating import tr
from ..command import Command
from .find_seams import selected_seams


class AddTrajectory(Command):
    """Adds one trajectory per seam to the document."""

    NAME = "FFDS_AddTrajectory"
    MENU = "Add robot trajectory"
    TIP = "Add the selected seams to the document as trajectories for FreeCAD's Robot workbench"
    HELP = "Adds the selected seams to the document as trajectories for the Robot workbench."
    KEYS = "F, R"
    NEEDS = "Select seams first: Find weld seams makes them."

    def active(self) -> bool:
        """With seams selected."""
        return selected_seams() is not None

    def run(self) -> None:
        """Add them in one undo step."""
        from ....objects.seams import job_of

        item = selected_seams()
        in_background(tr("Measuring the seams"), job_of(item).run)
        call(item.Document, "Add robot trajectory", f"add_trajectories({name_of(item)})")
