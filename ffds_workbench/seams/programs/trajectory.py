# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's own robot trajectories: one ``Robot::TrajectoryObject`` per seam, alone or in a new document."""
from __future__ import annotations

import zipfile
from collections.abc import Sequence
from pathlib import Path

import FreeCAD
import Robot

from ...errors import RefusedError
from .moves import AIR_VELOCITY, RobotSettings, SeamMoves

_NAMED_TOOL = 1
_SHOWN = """<?xml version='1.0' encoding='utf-8'?>
<Document SchemaVersion="1">
    <ViewProviderData Count="{count}">{providers}
    </ViewProviderData>
    <Camera settings=""/>
</Document>
"""
_PROVIDER = """
        <ViewProvider name="{name}" expanded="0">
            <Properties Count="1" TransientCount="0">
                <Property name="Visibility" type="App::PropertyBool" status="1"><Bool value="true"/></Property>
            </Properties>
        </ViewProvider>"""
"""What a document that was saved without a GUI lacks: it opens with everything hidden."""


def add_trajectories(document: FreeCAD.Document, seams: Sequence[SeamMoves], settings: RobotSettings
                     ) -> list[FreeCAD.DocumentObject]:
    """Add the seams to a document; velocities are in mm/s, and a tool or base number is passed on."""
    objects = []
    tool = settings.tool if isinstance(settings.tool, int) else _NAMED_TOOL
    base = settings.base if isinstance(settings.base, int) else 0
    for number, seam in enumerate(seams, 1):
        last = len(seam.poses)
        waypoints = []
        for i, pose in enumerate(seam.all_poses):
            air = i in (0, 1, last + 1)
            waypoints.append(Robot.Waypoint(FreeCAD.Placement(FreeCAD.Matrix(*pose.ravel().tolist())),
                                            type="PTP" if i == 0 else "LIN", name=f"S{number}P{i}",
                                            vel=AIR_VELOCITY if air else settings.velocity, cont=1 < i < last,
                                            tool=tool, base=base))
        item = document.addObject("Robot::TrajectoryObject", f"Seam{number}")
        item.Label = seam.title
        item.Trajectory = Robot.Trajectory(waypoints)
        objects.append(item)
    return objects


def write_document(path: Path, seams: Sequence[SeamMoves], settings: RobotSettings) -> None:
    """Write a new document that holds the seams alone (RefusedError if it cannot be written)."""
    document = FreeCAD.newDocument("FFDS_seams", hidden=True, temp=True)
    try:
        names = [item.Name for item in add_trajectories(document, seams, settings)]
        document.recompute()
        document.saveAs(str(path))
        if not FreeCAD.GuiUp:
            providers = "".join(_PROVIDER.format(name=name) for name in names)
            with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
                archive.writestr("GuiDocument.xml", _SHOWN.format(count=len(names), providers=providers))
    except (OSError, RuntimeError, FreeCAD.Base.FreeCADError) as error:
        raise RefusedError(f"The document could not be written: {error}.") from error
    finally:
        FreeCAD.closeDocument(document.Name)
