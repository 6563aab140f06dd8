# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scripting surface: what macros, the command line and FreeCAD's Python console call.

In FreeCAD's Python console, with a part selected or at hand::

    from ffds_workbench import api
    scan = api.read_scan("scan.ply")                        # points in mm; unit="m" if the file is in metres
    result = api.register(App.ActiveDocument.Bracket, scan, faces=["Face6"])
    print(result.table())                                   # deviation and topology, before and after
    Part.show(result.shape)
    api.write(result, "as_built.step", report="as_built.json", picture="as_built.png")
    plan = api.plan_seams(result.shape, auto=0.5, nominal=App.ActiveDocument.Bracket)
    api.write_seams(plan, ["weld.src", "weld.csv"])

Models are files, shapes or document objects alike; objects are taken where they stand in their document. Errors are
`InputError` (the request cannot be read) and `RefusedError` (no honest result), each with one sentence that says why.
"""
from __future__ import annotations

from .. import _freecad

_freecad.activate()

from ..brep.files import Model
from ..brep.simulation import Simulation
from ..errors import FfdsError, InputError, RefusedError
from ..registration.joint import SensorProfile
from ..scan.cloud import PointCloud
from ..scan.sensor import SensorSettings, View
from ..seams.carry import carry
from ..seams.measured import SeamLimits
from ..seams.plan import check_seam_outputs, plan_seams, write_seams
from ..seams.programs.moves import RobotSettings, read_frame_choice
from ..seams.settings import SeamSettings
from .aligning import AlignedScan, align_scan, write_alignment
from .deviating import Deviation, deviation
from .inputs import read_model, read_scan
from .outputs import check_model_output, check_outputs, write, write_deviation, write_simulation
from .registering import Result, register
from .sensors import measure_sensor, write_sensor
from .simulating import simulate

__all__ = ["AlignedScan", "Deviation", "FfdsError", "InputError", "Model", "PointCloud", "RefusedError", "Result",
           "RobotSettings", "SeamLimits", "SeamSettings", "SensorProfile", "SensorSettings", "Simulation", "View",
           "align_scan", "carry", "check_model_output", "check_outputs", "check_seam_outputs", "deviation",
           "measure_sensor", "plan_seams", "read_frame_choice", "read_model", "read_scan", "register", "simulate",
           "write", "write_alignment", "write_deviation", "write_seams", "write_sensor", "write_simulation"]
