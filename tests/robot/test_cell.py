# SPDX-License-Identifier: LGPL-2.1-or-later
"""``cell.json``: what it may say, what comes of it, and what is refused."""
from __future__ import annotations

import json

import numpy as np
import Part
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.robot.cells import FREE, read_cell


def write(folder, **entries):
    (folder / "cell.json").write_text(json.dumps(entries))
    return folder / "cell.json"


def test_without_a_file_the_robot_stands_behind_the_model():
    cell = read_cell(None, "UR10e")
    assert cell.base == pytest.approx(np.array([[1, 0, 0, -0.6 * 1300], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]))
    assert cell.yaw == FREE and not cell.solids and not cell.meshes and cell.home is None


def test_everything_that_it_may_say(tmp_path):
    Part.makeBox(10, 20, 30).exportStep(str(tmp_path / "clamp.step"))
    path = write(tmp_path, robot="KR 10 R1420", base=[-500, 10, 20, 90, 0, 0],
                 torch={"stick_out": 15, "neck_angle": 45}, table={"box": [-500, -500, -50, 500, 500, -10]},
                 clearance=3, yaw=[-30, 30], work_angle=10, travel_angle=[-5, 15], home=[0, -90, 90, 0, 0, 0],
                 solids=[{"name": "clamp", "step": "clamp.step", "at": [100, 0, 0, 0, 0, 90]},
                         {"name": "post", "cylinder": [0, 0, 0, 0, 0, 80, 12], "at": [50, 60, 0, 0, 0, 0]}])
    cell = read_cell(path, None)
    assert cell.arm.name == "KUKA KR 10 R1420" and cell.base[:3, 0] == pytest.approx([0, 1, 0])
    assert [name for name, _ in cell.solids] == ["table", "post"]
    assert cell.solids[1][1].distances(np.array([[50.0, 60.0, 90.0]])) == pytest.approx(10.0)
    ((name, mesh),) = cell.meshes
    corners = mesh.corners.reshape(-1, 3)
    # A quarter turn about X takes y to z and z to −y.
    assert name == "clamp" and corners.min(axis=0) == pytest.approx([100, -30, 0], abs=1e-6)
    assert corners.max(axis=0) == pytest.approx([110, 0, 20], abs=1e-6)
    assert np.degrees([*cell.yaw, *cell.work, *cell.travel]) == pytest.approx([-30, 30, 10, 10, -5, 15])
    # The wire's tip: body, then neck, nozzle and wire along the bend.
    straight = 80 + 60 + 15
    assert cell.torch.tcp[:3, 3] == pytest.approx([straight * 0.5**0.5, 0, 220 + straight * 0.5**0.5])


@pytest.mark.parametrize(("entries", "says"), [
    ({}, "No robot was named"), ({"robot": "R2"}, "no robot 'R2'"), ({"rob": "UR10e"}, "unknown key 'rob'"),
    ({"robot": "UR10e", "base": [1, 2]}, "base .* must be 6 numbers"),
    ({"robot": "UR10e", "torch": {"length": 3}}, "torch has an unknown key"),
    ({"robot": "UR10e", "torch": {"stick_out": 0}}, "stick_out must be a number above 0"),
    ({"robot": "UR10e", "yaw": [10, -10]}, "yaw must rise"), ({"robot": "UR10e", "clearance": -1}, "not be negative"),
    ({"robot": "UR10e", "home": [0, 0, 0, 0, 0, 400]}, "beyond the limits"),
    ({"robot": "UR10e", "table": 3}, "table must be a solid"),
    ({"robot": "UR10e", "solids": [{"box": [0, 0, 0, 0, 1, 1]}]}, "smaller corner first"),
    ({"robot": "UR10e", "solids": [{"name": "a"}]}, "must be a box, a cylinder or a step file"),
    ({"robot": "UR10e", "solids": [{"step": "none.step"}]}, "none.step")])
def test_what_is_refused(entries, says, tmp_path):
    with pytest.raises(InputError, match=says):
        read_cell(write(tmp_path, **entries), None)


def test_a_file_that_is_none(tmp_path):
    (tmp_path / "cell.json").write_text("{")
    with pytest.raises(InputError, match="not JSON"):
        read_cell(tmp_path / "cell.json", "UR10e")
    with pytest.raises(InputError, match="cannot be read"):
        read_cell(tmp_path / "no.json", "UR10e")
