# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds seams --robot … --cell …``: the report's block, the programs, and what is left out of them."""
from __future__ import annotations

import json
from pathlib import Path

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.cli.main import main
from ffds_workbench.robot.arms import read_arm
from ffds_workbench.robot.cells import read_cell

SHARED = Path(__file__).resolve().parents[3] / "shared" / "data"


@pytest.fixture
def blocks(tmp_path, monkeypatch):
    """A block on a plate: two of its seams by name, in front of the robot and 3 m away."""
    plate = Part.makeBox(3200, 80, 8, FreeCAD.Vector(-40, -40, -8))
    near, far = (Part.makeBox(40, 40, 30, FreeCAD.Vector(x, -20, 0)) for x in (-20, 3000))
    Part.makeCompound([plate, near, far]).exportStep(str(tmp_path / "part.step"))
    shape = Part.read(str(tmp_path / "part.step"))
    monkeypatch.chdir(tmp_path)
    return [next(f"Edge{i}" for i, edge in enumerate(shape.Edges, 1)
                 if edge.CenterOfMass.isEqual(FreeCAD.Vector(x, -20, 0), 1e-6)) for x in (0, 3020)]


def run(edges, *more) -> int:
    return main(["seams", "part.step", "--edge", *edges, "--robot", "UR10e", *more])


def test_seams_that_the_robot_cannot_weld_are_in_no_program(blocks, tmp_path, capfd):
    assert run(blocks, "--out", "weld.script", "weld.csv", "--report", "seams.json") == 0
    said = capfd.readouterr().out
    assert "therefore they are left out of the programs" in said and "fail (reach)" in said
    report = json.loads((tmp_path / "seams.json").read_text())
    robot = report["robot"]
    good, bad = robot["seams"]
    assert robot["name"] == "Universal Robots UR10e"
    assert (good["name"], good["verdict"], good["first_failure"]) == (blocks[0], "pass", None)
    assert (bad["name"], bad["verdict"], bad["first_failure"]["reason"]) == (blocks[1], "fail", "reach")
    assert bad["first_failure"]["station"] == 0 and bad["stations"][0]["joints"] is None
    assert len(good["stations"]) == report["seams"][0]["stations"]
    arm, cell = read_arm("UR10e"), read_cell(None, "UR10e")
    for station in good["stations"]:
        assert len(station["joints"]) == 6 and station["clearance"] >= cell.clearance
        assert 0 < station["singularity"] <= 1
        tip = cell.base @ arm.chain.flange(np.array(station["joints"])) @ cell.torch.tcp
        assert tip[1:3, 3] == pytest.approx([-20.0, 0.0], abs=1e-4)
    text = (tmp_path / "weld.script").read_text()
    assert "seam 1 ends" in text and "seam 2" not in text
    # The first move is to joints: the configuration is sure.
    assert "movej([" in text and "set_tcp(p[" in text and "model_frame = p[0.78" in text


def test_failing_seams_are_kept_where_that_is_asked(blocks, tmp_path, capfd):
    assert run(blocks, "--keep-failing", "--out", "weld.src") == 0
    assert "in the programs all the same" in capfd.readouterr().out
    assert "seam 2 ends" in (tmp_path / "weld.src").read_text()


def test_no_seam_no_program(blocks, tmp_path, capfd):
    assert run(blocks[1:], "--out", "weld.src", "--report", "seams.json") == 3
    assert "can weld no seam" in capfd.readouterr().err
    assert {path.name for path in tmp_path.iterdir()} == {"part.step"}


def test_a_cell_counts(blocks, tmp_path, capfd):
    (tmp_path / "cell.json").write_text(json.dumps({"base": [2240, 0, 0, 0, 0, 0]}))
    assert run(blocks, "--cell", "cell.json", "--out", "a.csv", "--report", "seams.json") == 0
    verdicts = [seam["verdict"] for seam in json.loads((tmp_path / "seams.json").read_text())["robot"]["seams"]]
    assert verdicts == ["fail", "pass"]
    assert run(blocks, "--cell", "no.json", "--out", "a.csv") == 2
    assert "cannot be read" in capfd.readouterr().err


def test_a_process_counts_and_needs_a_robot(blocks, tmp_path, capfd):
    rows = [{"gap": 0.5, "speed": 7, "job": 3}]
    (tmp_path / "process.json").write_text(json.dumps({"tables": [{"rows": rows}]}))
    assert run(blocks[:1], "--process", "process.json", "--searches", "none", "--out", "a.ls", "a.jbi", "a.as") == 0
    assert "Arc Start[3]" in (tmp_path / "a.ls").read_text() and "7mm/sec" in (tmp_path / "a.ls").read_text()
    assert "ARCON ASF#(3)" in (tmp_path / "a.jbi").read_text()
    assert "SPEED 7 MM/S ALWAYS" in (tmp_path / "a.as").read_text()
    assert main(["seams", "part.step", "--edge", *blocks[:1], "--process", "process.json", "--out", "b.ls"]) == 2
    assert "needs a robot" in capfd.readouterr().err


def test_the_pipe_s_seam_in_one_pass(tmp_path, monkeypatch):
    """Around a pipe between two flats: with a free yaw and a lean it is one pass, with a fixed yaw it is not."""
    part = SHARED / "weld_pipe_on_angle" / "nominal.step"
    if not part.exists():
        pytest.skip("the folder ../shared/data is not there")
    monkeypatch.chdir(tmp_path)
    for name, yaw, verdict in (("free", "free", "pass"), ("fixed", 0, "fail")):
        (tmp_path / "cell.json").write_text(json.dumps({"yaw": yaw}))
        assert main(["seams", str(part), "--edge", "Edge42", "--robot", "KR 8 R1440-2", "--cell", "cell.json", "--out",
                     f"{name}.csv", "--report", f"{name}.json"]) == 0
        (seam,) = json.loads((tmp_path / f"{name}.json").read_text())["robot"]["seams"]
        assert seam["verdict"] == verdict
