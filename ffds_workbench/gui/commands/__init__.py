# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands, one module each in a folder per group, and where they appear. They load nothing heavy before they are
run."""
from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

from ..qt import QtCore, QtWidgets
from ..selection import watch_clicks
from .deform.deform_faces import DeformFaces
from .deform.deform_workpiece import DeformWorkpiece
from .deform.export_as_built import ExportAsBuilt
from .deform.repoint_references import RepointReferences
from .deform.show_lattice import ShowLattice
from .inspect.export_report import ExportReport
from .inspect.show_deviation import ShowDeviation
from .inspect.show_result import ShowResult
from .learn.first_steps import FirstSteps
from .learn.load_example import LoadExample
from .learn.show_documentation import ShowDocumentation
from .scan.align_by_points import AlignByPoints
from .scan.align_scan import AlignScan
from .scan.import_scan import ImportScan
from .scan.prepare_scan import PrepareScan
from .scan.simulate_scan import SimulateScan
from .weld.add_trajectory import AddTrajectory
from .weld.export_program import ExportProgram
from .weld.find_seams import FindSeams

GROUPS = {"Scan": (ImportScan, SimulateScan, PrepareScan, AlignScan, AlignByPoints),
          "Deform": (DeformFaces, DeformWorkpiece, ShowLattice, RepointReferences, ExportAsBuilt),
          "Inspect": (ShowResult, ShowDeviation, ExportReport),
          "Weld": (FindSeams, ExportProgram, AddTrajectory),
          "Learn": (FirstSteps, LoadExample, ShowDocumentation)}
"""By the title of their submenu and toolbar, which the window translates in the context "Workbench"."""
COMMANDS = tuple(command for group in GROUPS.values() for command in group)
CONTEXT = [command.NAME for command in (
    DeformFaces, DeformWorkpiece, PrepareScan, AlignScan, AlignByPoints, ShowResult, ShowDeviation, ShowLattice,
    ExportReport, RepointReferences, ExportAsBuilt, FindSeams, ExportProgram, AddTrajectory)]


def register() -> None:
    """Make the commands known to FreeCAD."""
    watch_clicks()
    for command in COMMANDS:
        Gui.addCommand(command.NAME, command())


def appear_in(workbench: Any) -> None:
    """Put them into the toolbars and the menu of the workbench, group by group."""
    for title, group in GROUPS.items():
        names = [command.NAME for command in group]
        workbench.appendToolbar(f"FFDS {title}", names)
        workbench.appendMenu(["FFDS", title], names)


def make_room() -> None:
    """See to it, once the window is laid out, that no button of the toolbars is hidden: they begin a row of their own
    where the window is too narrow."""
    QtCore.QTimer.singleShot(0, _begin_a_row)


def _begin_a_row() -> None:
    window = Gui.getMainWindow()
    bars = [window.findChild(QtWidgets.QToolBar, f"FFDS {title}") for title in GROUPS]
    cut_off = [bar for bar in bars if bar.isVisible() and bar.width() < bar.sizeHint().width()]
    if cut_off and not window.toolBarBreak(bars[0]):
        window.insertToolBarBreak(bars[0])
        for bar in bars[1:]:
            window.removeToolBarBreak(bar)
