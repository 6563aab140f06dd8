# SPDX-License-Identifier: LGPL-2.1-or-later
"""The order of the pieces: every way leads from the piece that is welded before, whatever is left out."""
from __future__ import annotations

from types import SimpleNamespace

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench import api
from ffds_workbench.robot import job
from ffds_workbench.robot.job import PlannedSeam, SeamPiece
from ffds_workbench.robot.planning import SeamPath
from ffds_workbench.seams.programs.moves import SeamMoves
from ffds_workbench.seams.programs.trajectory import add_trajectories


def piece(at: float) -> SeamPiece:
    return SeamPiece(0, 1, np.full(6, at), np.full(6, at + 1.0))


def test_a_seam_without_a_way_is_in_no_way_of_the_others(monkeypatch):
    """Of the seam with two pieces the second has no way: the other then starts from home, not from the first."""
    none = np.empty(0)
    path = SeamPath(none, none, none, none, none, none)
    seams = [PlannedSeam(None, path, (piece(0.0), piece(9.0))), PlannedSeam(None, path, (piece(4.0),))]

    def way(moving, cell, start, end):
        return None if end[0] == 9.0 else np.stack([start, start + 0.25, end])

    monkeypatch.setattr(job, "_way", way)
    moving, cell = SimpleNamespace(arm=SimpleNamespace(speeds=np.ones(6))), SimpleNamespace(home=np.full(6, -2.0))
    order, found = job._ordered(seams, [True, True], moving, cell)
    assert order == [(1, 0)] and not found[0].pieces and found[0].path.failure.reason == "transfer"
    assert found[1].pieces[0].way == pytest.approx(np.full((1, 6), -1.75))


def test_seams_beyond_their_limits_are_in_no_way_of_the_others():
    """Three blocks in a row, the middle one 0.9 mm above the plate: the way to the third leads from the first."""
    plate = Part.makeBox(600, 80, 8, FreeCAD.Vector(-300, -40, -8))
    blocks = [Part.makeBox(40, 40, 30, FreeCAD.Vector(x - 20, -20, up)) for x, up in ((-200, 0), (0, 0.9), (200, 0))]
    shape = Part.makeCompound([plate, *blocks])
    edges = [next(f"Edge{i}" for i, edge in enumerate(shape.Edges, 1)
                  if edge.CenterOfMass.isEqual(FreeCAD.Vector(x, -20, up), 1e-6)) for x, up in (
        (-200, 0), (0, 0.9), (200, 0))]
    plan = api.plan_seams(shape, edges, auto=1.5, limits=api.SeamLimits(gap=0.5))
    beyond = [bool(seam.exceeded(plan.limits)) for seam in plan.seams]
    assert sorted(beyond) == [False, False, True]
    robot, planned = api.plan_robot(plan, api.read_cell("KR 10 R1420"))
    assert [seam.verdict for seam in robot.seams] == ["pass"] * 3
    assert sorted(number for number, _ in robot.order) == [number for number in range(3) if not beyond[number]]
    assert [seam.name for seam in planned.seams] == [plan.seams[number].name for number, _ in robot.order]
    kept, _ = api.plan_robot(plan, api.read_cell("KR 10 R1420"), api.RobotSettings(keep_failing=True))
    assert len(kept.order) == 3


def test_a_trajectory_has_the_way_and_the_speeds_of_the_process():
    """FreeCAD's own trajectory: the same poses as in the other programs, each as fast."""
    poses = np.tile(np.eye(4), (6, 1, 1))
    poses[:, 0, 3] = np.arange(6.0)
    seam = SeamMoves("Edge1", "Edge1", poses[1], poses[2:5], poses[5], 0.5, poses[:1], velocities=np.array([7.0, 8.0]))
    document = FreeCAD.newDocument("Way", hidden=True, temp=True)
    try:
        (item,) = add_trajectories(document, [seam], api.RobotSettings(velocity=10.0))
        points = item.Trajectory.Waypoints
        assert [point.Pos.Base.x for point in points] == pytest.approx([0, 1, 2, 3, 4, 5])
        assert [point.Velocity for point in points] == pytest.approx([100, 100, 100, 7, 8, 100])
        assert [point.Type for point in points] == ["PTP", "PTP", "LIN", "LIN", "LIN", "LIN"]
    finally:
        FreeCAD.closeDocument(document.Name)
