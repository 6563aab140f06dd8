# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_ExportProgram: the selected seams as a robot's program, a table, a report or a picture."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCADGui as Gui

from .... import api
from ...qt import QtWidgets
from ...running import ask, in_background, name_of, record
from ...translating import said, tr
from ..command import Command
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
    NEEDS = "Select seams first: Find weld seams makes them."

    def active(self) -> bool:
        """With seams selected."""
        return selected_seams() is not None

    def run(self) -> None:
        """Ask for a file and write it."""
        from ....objects.seams import chosen_plan, job_of, robot_of
        from ....seams.output.writing import PROGRAMS

        item = selected_seams()
        stem = item.Label.replace(" ", "_")
        path, kind = QtWidgets.QFileDialog.getSaveFileName(
            Gui.getMainWindow(), tr("Export robot program"), f"{stem}.src", ";;".join(_formats()))
        if not path:
            return
        path += "" if Path(path).suffix else _formats().get(kind, ".src")
        plan = chosen_plan(item, in_background(tr("Measuring the seams"), job_of(item).run))
        keep_failing = False
        if Path(path).suffix.lower() in PROGRAMS:
            keep_failing = asked_for_failing(plan, robot_of(item))
        record(f"export_program({name_of(item)}, {path!r}{', keep_failing=True' if keep_failing else ''})")


def asked_for_failing(plan: Any, robot: api.RobotSettings) -> bool:
    """Say what to know of a program before it is written, and ask about seams beyond their limits.

    Raises
    ------
    Cancelled : it is not to be written
    """
    notes = api.program_notes(plan, robot)
    failing = len(plan.seams) - len(api.programmed_seams(plan, robot))
    if not notes:
        return False
    answers = [tr("Write without them"), tr("Write all")] if 0 < failing < len(plan.seams) else [
        tr("Write all the same")]
    chosen = ask(tr("Export robot program"), list(map(said, notes)), answers)
    return failing > 0 and chosen == len(answers) - 1
