# SPDX-License-Identifier: LGPL-2.1-or-later
"""FreeCAD's own robot trajectories: one ``Robot::TrajectoryObject`` per seam, alone or in a new document."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import FreeCAD
import Robot

from ...brep.model_files import document_colours
from ...errors import RefusedError
from .moves import AIR_VELOCITY, RobotSettings, SeamMoves

_NAMED_TOOL = 1


def add_trajectories(document: FreeCAD.Document, seams: Sequence[SeamMoves], settings: RobotSettings
                     ) -> list[FreeCAD.DocumentObject]:
    """Add the seams to a document; velocities are in mm/s, and a tool or base number is passed on."""
    objects = []
    tool = settings.tool if isinstance(settings.tool, int) else _NAMED_TOOL
    base = settings.base if isinstance(settings.base, int) else 0
    for number, seam in enumerate(seams, 1):
        first, last = -len(seam.way) - 1, len(seam.poses) - 1
        waypoints = []
        for station, pose in enumerate(seam.whole_way, first):
            air, i = not 0 < station <= last, station - first
            waypoints.append(Robot.Waypoint(FreeCAD.Placement(FreeCAD.Matrix(*pose.ravel().tolist())),
                                            type="PTP" if station < 0 else "LIN", name=f"S{number}P{i}",
                                            vel=AIR_VELOCITY if air else seam.velocity_to(station, settings),
                                            cont=0 < station < last, tool=tool, base=base))
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
            document_colours.add_views(path, dict.fromkeys(names, ()))
    except (OSError, RuntimeError, FreeCAD.Base.FreeCADError) as error:
        raise RefusedError(f"The document could not be written: {error}.") from error
    finally:
        FreeCAD.closeDocument(document.Name)
