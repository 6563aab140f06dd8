# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands, one module each, and where they appear. They load nothing heavy before they are run."""
from __future__ import annotations

import FreeCADGui as Gui

from .add_trajectory import AddTrajectory
from .align_by_points import AlignByPoints
from .align_scan import AlignScan
from .deform_faces import DeformFaces
from .deform_workpiece import DeformWorkpiece
from .export_as_built import ExportAsBuilt
from .export_program import ExportProgram
from .find_seams import FindSeams
from .import_scan import ImportScan
from .learn.show_documentation import ShowDocumentation
from .load_example import LoadExample
from .repoint_references import RepointReferences
from .scan.prepare_scan import PrepareScan
from .show_deviation import ShowDeviation
from .show_lattice import ShowLattice
from .simulate_scan import SimulateScan

GROUPS = ((ImportScan, SimulateScan, PrepareScan, AlignScan, AlignByPoints),
          (DeformFaces, DeformWorkpiece, ShowLattice, RepointReferences, ExportAsBuilt),
          (ShowDeviation,),
          (FindSeams, ExportProgram, AddTrajectory),
          (LoadExample, ShowDocumentation))
"""Scan, deform, inspect, weld, and the example: parted by lines in menu and toolbar."""
COMMANDS = tuple(command for group in GROUPS for command in group)
TOOLBAR = [name for group in GROUPS for name in (*(command.NAME for command in group), "Separator")][:-1]
CONTEXT = [command.NAME for command in (
    DeformFaces, DeformWorkpiece, PrepareScan, AlignScan, AlignByPoints, ShowDeviation, ShowLattice, RepointReferences,
    ExportAsBuilt, FindSeams, ExportProgram, AddTrajectory)]


def register() -> None:
    """Make the commands known to FreeCAD."""
    for command in COMMANDS:
        Gui.addCommand(command.NAME, command())
