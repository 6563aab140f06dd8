# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds weld``: the whole way, from a scan to programs and a page, on a small plate."""
from __future__ import annotations

import json
import re

import numpy as np
import Part
import pytest

from ffds_workbench import RESOURCES
from ffds_workbench.cli import weld
from ffds_workbench.cli.main import main


@pytest.fixture
def job(tmp_path, monkeypatch):
    """A plate whose top was scanned 0.5 mm too high in the middle, 0.4 mm apart, σ = 0.02 mm; and its upper border."""
    plate = Part.makeBox(60, 40, 4)
    plate.exportStep(str(tmp_path / "plate.step"))
    rng = np.random.default_rng(1)
    xy = np.stack(np.meshgrid(np.arange(0.2, 60, 0.4), np.arange(0.2, 40, 0.4), indexing="ij"), axis=-1).reshape(-1, 2)
    z = 4.0 + 0.5 * np.sin(np.pi * xy[:, 0] / 60) + rng.normal(0.0, 0.02, len(xy))
    np.savetxt(tmp_path / "scan.xyz", np.column_stack([xy, z]), fmt="%.5f")
    shape = Part.read(str(tmp_path / "plate.step"))
    edge = next(i for i, e in enumerate(shape.Edges, 1) if e.CenterOfMass.isEqual(Part.Vertex(30, 0, 4).Point, 1e-6))
    face = next(i for i, f in enumerate(shape.Faces, 1) if f.CenterOfMass.z > 3.9)
    monkeypatch.chdir(tmp_path)
    return f"Edge{edge}", f"Face{face}"


def test_from_scan_to_programs(job, tmp_path, capfd):
    edge, face = job
    assert main(["weld", "plate.step", "scan.xyz", "--face", face, "--edge", edge, "--out", "job", "--robot", "kuka",
                 "ur"]) == 0
    text = capfd.readouterr().out
    assert edge in text and "order kept, valid, closed" in text
    names = {path.name for path in (tmp_path / "job").iterdir()}
    assert names == {"as_built.step", "report.json", "deviation.png", "seams.csv", "seams.src", "seams.dat",
                     "seams.script", "seams.FCStd", "seams.json", "seams.png", "report.html"}
    # The seam rises with the surface that was scanned: 0.5 mm in the middle, as far as one noisy face tells its border.
    (seam,) = json.loads((tmp_path / "job" / "seams.json").read_text())["seams"]
    assert seam["largest"]["normal"] == pytest.approx(0.5 * 0.5**0.5, abs=0.05)
    page = (tmp_path / "job" / "report.html").read_text()
    assert re.findall(r"<h2><span>\d</span>([^<]+)", page) == ["Scan", "As-built model", "Weld seams", "Robot programs"]
    assert set(re.findall(r'(?:href|src)="([^"]+)"', page)) <= names


def test_the_alignment_is_told_and_kept_in_the_report(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    example = RESOURCES / "examples"
    assert main(["weld", str(example / "bracket.step"), str(example / "bracket_scan.ply"), "--face", "Face9", "--align",
                 "fine", "--edge", "Edge7", "--out", "job", "--robot", "kuka"]) == 0
    found = json.loads((tmp_path / "job" / "report.json").read_text())["alignment"]
    assert found["verdict"] == "ok" and np.shape(found["T_model_scan"]) == (4, 4)
    assert capfd.readouterr().out.count("Alignment ") == 1
    page = (tmp_path / "job" / "report.html").read_text()
    assert re.findall(r"<h2><span>\d</span>([^<]+)", page)[:3] == ["Alignment", "Scan", "As-built model"]


def test_what_is_refused(job, tmp_path, capfd):
    edge, _ = job
    assert main(["weld", "plate.step", "scan.xyz", "--out", "job"]) == 2
    assert "No seam was named" in capfd.readouterr().err
    assert main(["weld", "plate.step", "scan.xyz", "--edge", edge, "--tool", "1,2", "--out", "job"]) == 2
    assert "no tool or base" in capfd.readouterr().err
    assert not (tmp_path / "job").exists()


def test_robots_and_dialects_are_told_apart():
    """Without a robot the dialects are the usual three, as ever; a robot's name may have several words."""
    usual, every = list(weld.DIALECTS), list(weld.ALL_DIALECTS)
    assert weld.read_robot([]) == (None, usual) and weld.read_robot(["kuka", "ur"]) == (None, ["kuka", "ur"])
    assert weld.read_robot(["KR", "8", "R1440-2"]) == ("KR 8 R1440-2", every)
    assert weld.read_robot(["UR10e", "fanuc"]) == ("UR10e", ["fanuc"])
