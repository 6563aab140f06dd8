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

from importlib import import_module
from typing import Any

from .. import find_freecad

find_freecad.activate()

_HOMES = {
    "..brep.model_files": ("Model",),
    "..brep.simulated_scan": ("Simulation",),
    "..errors": ("FfdsError", "InputError", "RefusedError"),
    "..fields": ("FieldMean", "VectorField", "difference", "limited", "masked", "mean", "read_field", "scaled",
                 "smoothed", "total", "transformed"),
    "..inspection": ("Plan", "read_plan"),
    "..registration.joint": ("SensorProfile",),
    "..registration.request": ("RegistrationRequest",),
    "..scan.cloud": ("PointCloud",),
    "..scan.poses": ("read_poses",),
    "..scan.preparation": ("PreparationSettings", "PreparedScan"),
    "..scan.sensor": ("SensorSettings", "View"),
    "..robot.cells": ("Cell",),
    "..series": ("Series", "SeriesLimits", "series"),
    "..seams.taught.carry": ("carry",),
    "..seams.measured": ("SeamLimits",),
    "..seams.plan": ("plan_seams",),
    "..seams.programs.moves": ("RobotSettings", "read_frame_choice"),
    "..seams.programs.reading": ("read_program",),
    "..seams.settings": ("SeamSettings",),
    "..seams.output.writing": ("check_seam_outputs", "program_notes", "programmed_seams", "write_seams"),
    ".placing.aligning": ("AlignedScan", "align_scan", "write_alignment"),
    ".placing.datums": ("DatumAlignment", "align_on_datum_faces", "align_on_reference_points"),
    ".destinations": ("check_model_output", "check_outputs", "step_keeps_numbers"),
    ".deviating": ("Deviation", "deviation"),
    ".inspecting": ("InspectedPart", "inspect", "inspect_model", "inspect_result", "inspect_scan", "write_inspected"),
    ".inputs": ("as_request", "read_model", "read_scan"),
    ".methods": ("OtherSideError",),
    ".morphing.applying": ("MorphedModel", "morph"),
    ".morphing.compensating": ("CompensatedModel", "compensate"),
    ".morphing.measuring": ("field_of_points",),
    ".morphing.taking": ("as_field", "field_of_meshes", "field_of_models", "field_of_result", "save_field"),
    ".morphing.writing": ("write_deformed",),
    ".outputs": ("write", "write_deviation"),
    ".pages": ("write_pages",),
    ".preparing": ("prepare", "write_prepared"),
    ".registering": ("Result", "register", "run"),
    ".robots": ("plan_robot", "read_cell"),
    ".sensors": ("measure_sensor", "write_sensor"),
    ".simulating": ("simulate", "write_simulation"),
}
"""Where each public name lives. What is not used is not loaded, so that commands start faster."""
_HOME = {name: home for home, names in _HOMES.items() for name in names}
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    """A public name, loaded at first use (PEP 562)."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOME[name], __name__), name)
    return value


def __dir__() -> list[str]:
    return [*globals(), *__all__]
