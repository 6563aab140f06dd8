# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams with a known answer for each way in which a robot may fail, and paths replayed as a controller runs them."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ffds_workbench.robot.arms import read_arm
from ffds_workbench.robot.cells import Cell, default_base
from ffds_workbench.robot.clearance import Box, Moving, Surroundings
from ffds_workbench.robot.planning import Course, plan_path, remedy, replay, transfer
from ffds_workbench.robot.planning.transfers import between


def moving(cell: Cell, *solids) -> Moving:
    torch = cell.torch
    return Moving(cell.arm, cell.base, torch.tcp, torch.about_the_wire, torch.beside_the_wire,
                  Surroundings(None, (), solids))


def cell_of(name: str = "KR 8 R1440-2", **changes) -> Cell:
    arm = read_arm(name)
    return Cell(arm, changes.pop("base", default_base(arm)), **changes)


def line(start, end, count: int = 21, velocity: float = 10.0) -> Course:
    """A fillet on the floor from start to end: the torch leans 45° to the left of the travel."""
    start, end = np.array(start, dtype=float), np.array(end, dtype=float)
    x = (end - start) / np.linalg.norm(end - start)
    z = np.cross(x, (0, 0, 1)) - (0, 0, 1)
    z /= np.linalg.norm(z)
    torch = np.stack([x, np.cross(z, x), z], axis=1)
    return Course(np.tile(torch, (count, 1, 1)), start + np.linspace(0, 1, count)[:, None] * (end - start),
                  np.full(count - 1, velocity))


def circle(radius: float = 60.0, count: int = 73) -> Course:
    """Around a pipe that stands on the floor, from outside, the torch at 45°."""
    angle = np.linspace(0.0, 2.0 * np.pi, count)
    out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    x = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    z = -(out + (0, 0, 1)) / 2**0.5
    return Course(np.stack([x, np.cross(z, x), z], axis=2), radius * out, np.full(count - 1, 10.0))


BLOCK = ("block", Box(np.array([-50.0, -50.0, -50.0]), np.array([50.0, 50.0, 0.0]), np.eye(4)))


@pytest.fixture(scope="module")
def round_path():
    cell = cell_of()
    robot = moving(cell, BLOCK)
    return cell, robot, plan_path(robot, cell, circle())


def test_replayed_every_4_ms_nothing_exceeds_limits_or_clearance(round_path):
    cell, robot, path = round_path
    course = circle()
    assert path.failure is None
    joints, tips = replay(robot, path, course.times)
    assert robot.tips(joints) == pytest.approx(tips, abs=1e-6)
    low, high = cell.arm.limits.T
    assert (joints >= low).all() and (joints <= high).all()
    speed = np.diff(joints, axis=0) / 0.004
    assert (np.abs(speed) <= cell.arm.speeds).all()
    # Chords of the circle lie within 0.06 mm of it: stations are 5° apart on 60 mm.
    some = slice(None, None, 40)
    assert robot.all(joints[some], 50.0).distances.min() >= cell.clearance - 0.1
    assert (path.clearance >= cell.clearance).all() and path.singularity.min() >= 0.05


def test_poses_are_the_seam_s_but_for_the_yaw(round_path):
    _, _, path = round_path
    course = circle()
    assert path.tips[:, :3, 3] == pytest.approx(course.positions, abs=1e-9)
    assert path.tips[:, :3, 2] == pytest.approx(course.torch[:, :, 2], abs=1e-9)
    assert not path.leans.any()


def test_a_fixed_yaw_fails_where_a_free_one_does_not():
    """Once around with the torch fixed to the travel the wrist has to turn by 360°, and joint 4 or 5 gives out."""
    cell = cell_of(yaw=(0.0, 0.0))
    path = plan_path(moving(cell, BLOCK), cell, circle())
    assert path.failure is not None and path.failure.reason in ("motion", "limit") and path.failure.station > 0


def test_out_of_reach():
    """Along x away from the robot: the UR10e's wrist is 1184.25 mm from axis 2 at most."""
    cell = cell_of("UR10e")
    course = line((0, 0, 0), (2000, 0, 0), 41)
    path = plan_path(moving(cell), cell, course)
    assert path.failure.reason == "reach" and path.failure.station > 0
    # The last station before it is in reach of arm, wrist and torch together, the failing one beyond.
    torch = np.linalg.norm((cell.torch.tcp @ (0, 0, 0, 1.0))[:3]) + 116.55 + 119.85 + 174.15
    assert 780.0 + course.positions[path.failure.station, 0] < 1184.25 + torch
    assert np.isnan(path.joints[path.failure.station :]).all() and not np.isnan(path.joints[0]).any()


def test_remedies_name_what_helps():
    cell = cell_of("UR10e")
    course = line((900, 0, 0), (950, 0, 0), 5)
    robot = moving(cell)
    path = plan_path(robot, cell, course)
    assert path.failure.reason in ("reach", "limit", "singularity")
    assert "nearer" in remedy(robot, cell, course, path.failure)


def test_a_limit():
    """Behind the KR 8's back: axis 1 turns by 170° only, and with it locked to that side no branch is left."""
    cell = cell_of(yaw=(0.0, 0.0), work=(0.0, 0.0), travel=(0.0, 0.0))
    arm = replace(cell.arm, limits=np.where(np.arange(6)[:, None] == 4, np.radians([[-5.0, 5.0]]), cell.arm.limits))
    cell = replace(cell, arm=arm)
    path = plan_path(moving(cell), cell, line((0, -50, 0), (0, 50, 0)))
    assert path.failure.reason == "limit" and path.failure.station == 0 and "joint 5 by" in path.failure.said


def test_a_singular_wrist():
    """The torch straight on, its wire along axis 4 stretched out: every hold has axis 6 along axis 4."""
    cell = cell_of(yaw=(0.0, 0.0), work=(0.0, 0.0), travel=(0.0, 0.0))
    joints = np.radians([[0.0, -60.0, 80.0, 0.0, 0.0, 0.0]])
    tip = moving(cell).tips(joints)[0]
    course = Course(np.tile(tip[:3, :3], (3, 1, 1)), tip[:3, 3] + np.arange(3)[:, None] * tip[:3, 2] * 1e-3,
                    np.full(2, 0.01))
    limits = cell.arm.limits.copy()
    limits[[0, 2]] = np.radians([[-30.0, 30.0], [60.0, 100.0]])
    robot = moving(replace(cell, arm=replace(cell.arm, limits=limits)))
    path = plan_path(robot, cell, course)
    assert path.failure.reason == "singularity" and path.failure.station == 0


def test_torch_against_a_wall():
    """A wall from x = 40 on stands 6 mm beside the seam: the nozzle, 8 mm in radius, is against it from there on."""
    cell = cell_of(work=(0.0, 0.0), travel=(0.0, 0.0))
    wall = ("wall", Box(np.array([40.0, 6.0, -10.0]), np.array([200.0, 30.0, 300.0]), np.eye(4)))
    course = line((0, 0, 0), (100, 0, 0), 51)
    robot = moving(cell, wall)
    path = plan_path(robot, cell, course)
    assert path.failure.reason == "collision" and "torch against wall" in path.failure.said
    # The nozzle reaches 8 mm ahead of the wire and 1 mm is kept; stations are 2 mm apart.
    assert abs(course.positions[path.failure.station, 0] - (40.0 - 9.0)) <= 2.0


def test_a_lean_clears_what_the_bisector_does_not():
    """A ledge whose edge lies (30 − 24) / √2 = 4.2 mm off the torch's axis, in the nozzle; at 65° it is 17 mm."""
    ledge = ("ledge", Box(np.array([-100.0, 30.0, 0.0]), np.array([200.0, 60.0, 24.0]), np.eye(4)))
    course = line((0, 0, 0), (60, 0, 0), 13)
    stiff = cell_of(work=(0.0, 0.0), travel=(0.0, 0.0))
    failure = plan_path(moving(stiff, ledge), stiff, course).failure
    assert failure.reason == "collision" and failure.station == 0
    free = cell_of()
    path = plan_path(moving(free, ledge), free, course)
    assert path.failure is None and path.clearance.min() >= free.clearance
    assert np.radians(5.0) < np.abs(path.leans[:, 0]).max() <= np.radians(20.0) + 1e-9


def test_transfers_go_around():
    """A wall stands between two places: the straight way in joints is blocked, the one found is not."""
    cell = cell_of("UR10e")
    wall = ("wall", Box(np.array([-200.0, -30.0, -500.0]), np.array([600.0, 30.0, 600.0]), np.eye(4)))
    robot = moving(cell, wall)
    ends = [plan_path(robot, cell, line((0, y, 0), (10, y, 0), 3)).joints[0] for y in (-250.0, 250.0)]
    assert not np.isnan(ends).any()

    def free(joints):
        return robot.all(joints, 5.0).distances >= cell.clearance

    assert not free(between(*ends)).all()
    way = transfer(*ends, cell.arm.limits, free)
    assert way is not None and way[0] == pytest.approx(ends[0]) and way[-1] == pytest.approx(ends[1])
    for start, end in zip(way[:-1], way[1:], strict=True):
        assert free(between(start, end)).all()
