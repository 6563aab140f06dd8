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
from .load_example import LoadExample
from .repoint_references import RepointReferences
from .show_deviation import ShowDeviation
from .show_lattice import ShowLattice
from .simulate_scan import SimulateScan

COMMANDS = (ImportScan, AlignScan, AlignByPoints, DeformFaces, DeformWorkpiece, ShowDeviation, ShowLattice,
            SimulateScan, RepointReferences, ExportAsBuilt, FindSeams, ExportProgram, AddTrajectory, LoadExample)
TOOLBAR = [command.NAME for command in COMMANDS]
CONTEXT = [command.NAME for command in (
    DeformFaces, DeformWorkpiece, AlignScan, AlignByPoints, ShowDeviation, ShowLattice, RepointReferences,
    ExportAsBuilt, FindSeams, ExportProgram, AddTrajectory)]


def register() -> None:
    """Make the commands known to FreeCAD."""
    for command in COMMANDS:
        Gui.addCommand(command.NAME, command())
