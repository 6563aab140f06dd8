# SPDX-License-Identifier: LGPL-2.1-or-later
"""``process.json``: rows by gap, stretches that are refused, statements in the programs, and touches where needed."""
from __future__ import annotations

import json

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench import api
from ffds_workbench.errors import InputError
from ffds_workbench.robot.process import read_process, welding_of

ROWS = [{"gap": 0.3, "speed": 10, "job": 1},
        {"gap": 1.0, "speed": 6, "job": 2, "weave": {"schedule": 4}}]


@pytest.fixture(scope="module")
def wedge():
    """A block on a plate, tipped so that its long lower edge gapes by 0 mm at one end and 1.2 mm at the other."""
    plate = Part.makeBox(200, 100, 8, FreeCAD.Vector(-100, -50, -8))
    block = Part.makeBox(120, 20, 40, FreeCAD.Vector(-60, -10, 0))
    block.rotate(FreeCAD.Vector(-60, 0, 0), FreeCAD.Vector(0, 1, 0), -np.degrees(np.arcsin(1.2 / 120.0)))
    shape = Part.makeCompound([plate, block])
    middle = FreeCAD.Vector(0, -10, 0.6)
    edge = min(range(len(shape.Edges)), key=lambda i: (shape.Edges[i].CenterOfMass - middle).Length)
    return shape, f"Edge{edge + 1}"


@pytest.fixture(scope="module")
def seam(wedge):
    shape, edge = wedge
    return api.plan_seams(shape, [edge], auto=2.0, limits=api.SeamLimits(gap=5.0))


def write(folder, **entries):
    (folder / "process.json").write_text(json.dumps(entries))
    return folder / "process.json"


def test_rows_follow_the_gap(seam, tmp_path):
    """Row 1 up to 0.3 mm, a quarter of the length; row 2 up to 1 mm; beyond it nothing."""
    process = read_process(write(tmp_path, tables=[{"joint": "any", "rows": ROWS[::-1]}]))
    (one,) = seam.seams
    found = welding_of(process, one)
    gap = np.maximum(one.stations.gap[1:], one.stations.gap[:-1])
    assert found.row.tolist() == [0 if g <= 0.3 else 1 if g <= 1.0 else -1 for g in gap]
    assert {0, 1, -1} == set(found.row.tolist())
    ((first, last, said),) = found.refused
    assert (gap[first:last] > 1.0).all() and "beyond the table's 1 mm" in said


def test_programs_follow_the_process(seam, tmp_path):
    process = write(tmp_path, tables=[{"joint": ["T", "corner", "lap"], "rows": ROWS}])
    cell = api.read_cell("ARC Mate 100iD")
    robot, planned = api.plan_robot(seam, cell, process=process)
    (found,) = robot.record()["seams"]
    assert found["verdict"] == "pass" and len(found["not_welded"]) == 1 and not found["searches"]
    api.write_seams(seam, [tmp_path / f"a.{kind}" for kind in ("ls", "jbi", "src", "mod", "script", "as")],
                    planned=planned)
    listing = (tmp_path / "a.ls").read_text()
    order = ["seam 1 starts", "Arc Start[", "Arc End[", "seam 1 ends"]
    assert sorted(order, key=listing.index) == order
    assert "Arc Start[1]" in listing and "Arc Start[2]" in listing and "Arc End[2]" in listing
    assert "10mm/sec" in listing and "6mm/sec" in listing
    job = (tmp_path / "a.jbi").read_text()
    assert all(line in job for line in ("ARCON ASF#(1)", "WVON WEV#(4)", "WVOF", "ARCOF AEF#(2)"))
    assert "$VEL.CP=0.006" in (tmp_path / "a.src").read_text()
    # The stretch that gapes too wide is in none: no pose lies there.
    (one,) = seam.seams
    gone = one.stations.positions[one.stations.gap > 1.0 + 1e-6]
    poses = api.read_program(tmp_path / "a.ls")[:, :3, 3]
    assert np.linalg.norm(poses[None] - gone[1:-1, None], axis=2).min() > 0.5


def test_stitches(seam, tmp_path):
    process = write(tmp_path, tables=[{"rows": [{"gap": 2, "speed": 8, "job": 7}]}], stitch={"length": 20, "gap": 20})
    _, planned = api.plan_robot(seam, api.read_cell("UR10e"), process=process)
    (one,) = planned.seams
    lines = [line for lines in one.statements["fanuc"].values() for line in lines]
    assert lines == ["Arc Start[7]", "Arc End[7]"] * 3


def test_touches_only_where_the_band_needs_them(wedge, tmp_path):
    """Bands of 0.2 mm and 0.9 mm against a tolerance of 0.5 mm, and no report at all."""
    shape, edge = wedge
    process = write(tmp_path, tables=[{"rows": [{"gap": 2, "speed": 8, "job": 7}]}], tolerance=0.5)
    cell = api.read_cell("KR 10 R1420")
    for band, count in ((0.2, 0), (0.9, 4), (None, 0)):
        report = None if band is None else {"edges": [], "faces": [
            {"name": f"Face{i}", "flag": "observed", "band": band} for i in range(1, len(shape.Faces) + 1)]}
        plan = api.plan_seams(shape, [edge], auto=2.0, bands=report, limits=api.SeamLimits(gap=5.0))
        robot, planned = api.plan_robot(plan, cell, process=process)
        (found,) = robot.record()["seams"]
        assert found["verdict"] == "pass" and len(found["searches"]) == count
        (text,) = ["\n".join(line for lines in seam.statements["kuka"].values() for line in lines)
                   for seam in planned.seams]
        assert text.count("TOUCH_SEARCH(") == count
        for search in found["searches"]:
            # Over the plate straight down, to the block sideways.
            step = np.subtract(search["to"], search["from"])
            normals = plan.seams[0].stations
            assert np.abs(step / np.linalg.norm(step) + getattr(normals, f"n{search['face']}")[0]).max() < 1e-6
        if count:
            again, _ = api.plan_robot(plan, cell, process=process, searching=False)
            assert not again.record()["seams"][0]["searches"]


def test_own_templates(seam, tmp_path):
    (tmp_path / "t.json").write_text(json.dumps({"fanuc": {"arc_on": ["DO[{job}]=ON"]}}))
    path = write(tmp_path, tables=[{"rows": [{"gap": 2, "speed": 8, "job": 7}]}], templates="t.json")
    _, planned = api.plan_robot(seam, api.read_cell("UR10e"), process=path)
    lines = [line for lines in planned.seams[0].statements["fanuc"].values() for line in lines]
    assert lines == ["DO[7]=ON", "Arc End[7]"]
    (tmp_path / "t.json").write_text(json.dumps({"fanuc": {"arc_on": ["WFS[{wire}]"]}}))
    with pytest.raises(InputError, match="fanuc template's arc_on asks for 'wire'"):
        api.plan_robot(seam, api.read_cell("UR10e"), process=path)


def test_a_joint_without_a_table_is_not_welded(seam, tmp_path):
    process = write(tmp_path, tables=[{"joint": "butt", "rows": ROWS}])
    robot, planned = api.plan_robot(seam, api.read_cell("UR10e"), process=process)
    failure = robot.seams[0].path.failure
    assert failure.reason == "process" and "no table" in failure.said and not planned.seams


@pytest.mark.parametrize(("entries", "says"), [
    ({}, "must have tables"), ({"tables": [{"rows": []}]}, "must have rows"), ({"table": 1}, "unknown key 'table'"),
    ({"tables": [{"rows": [{"gap": 1, "speed": 5}]}]}, "must name a job"),
    ({"tables": [{"rows": [{"gap": 1, "speed": 0, "job": 1}]}]}, "velocity"),
    ({"tables": [{"rows": [{"gap": -1, "speed": 1, "job": 1}]}]}, "gap must be a number"),
    ({"tables": [{"rows": ROWS}], "templates": "no.json"}, "cannot be read")])
def test_what_is_refused(entries, says, tmp_path):
    with pytest.raises(InputError, match=says):
        read_process(write(tmp_path, **entries))
