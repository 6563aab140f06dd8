# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds seams`` and ``./ffds carry``: files in, files out, one clear line where that cannot be."""
from __future__ import annotations

import csv
import json

import FreeCAD
import Part
import pytest

from ffds_workbench.cli.main import main

HEAD = ("s,x,y,z,tx,ty,tz,n1x,n1y,n1z,n2x,n2y,n2z,qx,qy,qz,qw,gap,band,flag,curvature,work_angle,travel_angle,"
        "lateral,normal,longitudinal,opening_angle,torch_rotation")


@pytest.fixture(scope="module")
def models(tmp_path_factory):
    """A tube on a plate, and the same with the tube lifted by 0.2 mm."""
    folder = tmp_path_factory.mktemp("models")
    plate = Part.makeBox(80, 80, 8, FreeCAD.Vector(-40, -40, -8))
    tube = Part.makeCylinder(20, 40).cut(Part.makeCylinder(17, 40)).Solids[0]
    Part.makeCompound([plate, tube]).exportStep(str(folder / "nominal.step"))
    tube.translate(FreeCAD.Vector(0, 0, 0.2))
    Part.makeCompound([plate, tube]).exportStep(str(folder / "built.step"))
    return folder / "nominal.step", folder / "built.step"


def rows(path) -> list[dict[str, str]]:
    with path.open() as stream:
        return list(csv.DictReader(stream))


def test_everything_in_one_command(ffds, tmp_path, models):
    nominal, built = models
    entries = [{"name": f"Face{i}", "flag": "observed", "band": 0.05} for i in range(1, 11)]
    (tmp_path / "bands.json").write_text(json.dumps({"faces": entries, "edges": []}))
    names = ["weld.csv", "weld.src", "weld.mod", "weld.script", "weld.FCStd"]
    done = ffds("seams", built, "--auto", "0.05", "--nominal", nominal, "--bands", "bands.json", "--start", "-20,0,0",
                "--limit", "gap=0.1", "--out", *names, "--report", "seams.json", "--picture", "seams.png")
    assert done.returncode == 3 and "no program was written" in done.stderr and not (tmp_path / "weld.csv").exists()
    done = ffds("seams", built, "--auto", "0.05", "--nominal", nominal, "--bands", "bands.json", "--start", "-20,0,0",
                "--limit", "gap=0.1", "--out", *names, "--report", "seams.json", "--picture", "seams.png",
                "--keep-failing")
    assert done.returncode == 0, done.stderr
    assert "fail: gap" in done.stdout and "but included in the programs" in done.stdout
    text = (tmp_path / "weld.csv").read_text()
    assert text.startswith(HEAD)
    table = rows(tmp_path / "weld.csv")
    assert {row["seam"] for row in table} == {"1", "2"} and {row["flag"] for row in table} == {"observed"}
    for row in table:
        assert float(row["gap"]) == pytest.approx(0.2, abs=1e-5) and float(row["band"]) == 0.05
        assert float(row["normal"]) == pytest.approx(0.2 * 0.5**0.5, abs=1e-5)
    assert [float(table[0][k]) for k in "xyz"] == pytest.approx([-20.0, 0.0, 0.2], abs=1e-5)
    report = json.loads((tmp_path / "seams.json").read_text())
    assert [seam["verdict"] for seam in report["seams"]] == ["fail", "fail"]
    assert report["seams"][0]["largest"]["gap"] == pytest.approx(0.2, abs=1e-5) and report["seams"][0]["closed"]
    written = {path.name for path in tmp_path.iterdir()}
    assert written == {*names, "weld.dat", "seams.json", "seams.png", "bands.json"}
    assert (tmp_path / "seams.png").read_bytes().startswith(b"\x89PNG")


def test_a_seam_that_was_not_observed_is_flagged(ffds, tmp_path, models):
    (tmp_path / "bands.json").write_text(json.dumps({"faces": [{"name": "Face6", "flag": "observed", "band": 0.1}]}))
    done = ffds("seams", models[1], "--auto", "0.5", "--bands", "bands.json", "--out", "weld.csv")
    assert done.returncode == 0
    assert "was not observed by the scan over all its length (nominal): check it before welding" in done.stdout
    assert {row["flag"] for row in rows(tmp_path / "weld.csv")} == {"nominal"}


def test_carry(ffds, tmp_path, models):
    nominal, built = models
    (tmp_path / "taught.csv").write_text("x,y,z,a,b,c\n20,0,0,0,0,180\n0,20,0,0,0,180\n30,0,0,0,0,180\n")
    done = ffds("carry", nominal, built, "taught.csv", "--out", "new.csv")
    assert done.returncode == 0, done.stderr
    assert "3 poses carried along" in done.stdout
    # Two poses on the tube's edge rise with it; the third lies on the plate, which stayed.
    assert [float(row["z"]) for row in rows(tmp_path / "new.csv")] == pytest.approx([0.2, 0.2, 0.0], abs=1e-6)


@pytest.mark.parametrize(("arguments", "code", "says"), [
    (["--out", "a.csv"], 2, "No seam was named"),
    (["--edge", "Edge99", "--out", "a.csv"], 2, "There is no Edge99"),
    (["--edge", "Edge1"], 2, "--out"),
    (["--edge", "Edge1", "--out", "a.txt"], 2, "unknown format"),
    (["--edge", "Edge1", "--out", "nowhere/a.csv"], 2, "does not exist"),
    (["--edge", "Edge1", "--out", "a.csv", "--bands", "built.json"], 2, "cannot be read"),
    (["--edge", "Edge1", "--out", "a.csv", "--velocity", "0"], 2, "velocity"),
    (["--edge", "Edge1", "--out", "a.csv", "--start", "1,2"], 2, "3 numbers"),
    (["--edge", "Edge1", "--out", "a.mod", "--tool", "4"], 2, "name their tools"),
    (["--edge", "Edge1", "--auto", "0.05", "--out", "a.csv"], 3, "lies on no other part"),
    (["--edge", "Edge1", "Edge2", "Edge3", "Edge4", "Edge9", "--out", "a.csv"], 3, "does not branch"),
    (["--auto", "0.05", "--out", "a.csv"], 3, "No part lies on another")])
def test_what_is_refused(tmp_path, models, arguments, code, says, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    assert main(["seams", str(models[1]), *arguments]) == code
    error = capfd.readouterr().err
    assert says in error and len(error.strip().splitlines()) == 1 and "Traceback" not in error
    assert not list(tmp_path.iterdir())


def test_failure_keeps_an_earlier_file(ffds, tmp_path, models):
    (tmp_path / "a.csv").write_text("earlier")
    assert ffds("seams", models[1], "--auto", "0.05", "--out", "a.csv").returncode == 3
    assert ffds("carry", *models, "missing.csv", "--out", "a.csv").returncode == 2
    assert (tmp_path / "a.csv").read_text() == "earlier"
