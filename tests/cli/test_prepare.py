# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds prepare``: the file and report it writes, and what it says of what it cannot do."""
from __future__ import annotations

import json

import numpy as np
import pytest

from ffds_workbench.scan import files

pytest.importorskip("open3d", reason="the steps of preparation are open3d's")


@pytest.fixture
def scan(plate, tmp_path):
    """The plate's scan, with a table 5 mm below the face and 20 points far away."""
    random = np.random.default_rng(0)
    points = np.loadtxt(plate[1])
    table = np.column_stack([random.uniform((-40, -40), (100, 80), (20000, 2)), random.normal(0, 0.05, 20000)])
    path = tmp_path / "dirty scan ä.xyz"
    np.savetxt(path, np.concatenate([points, table, random.uniform(100, 200, (20, 3))]), fmt="%.6f")
    return path


def test_a_scan_is_cleaned_and_reported(ffds, plate, scan, tmp_path):
    done = ffds("prepare", scan, "--out", "clean.ply", "--report", "clean.json", "--near", plate[0], 30,
                "--remove-plane", "--remove-clutter", "--spacing", 1, "--normals", "--view", "0,0,500")
    assert done.returncode == 0, done.stderr
    cloud = files.read(tmp_path / "clean.ply")
    assert 0.9 * 60 * 40 < len(cloud.points) < 1.5 * 60 * 40 and cloud.points[:, 2].min() > 4.5
    assert (cloud.normals[:, 2] > 0.8).all()
    report = json.loads((tmp_path / "clean.json").read_text())
    assert [step["name"] for step in report["steps"]] == ["near", "plane", "clutter", "normals", "spacing"]
    assert 8000 <= report["steps"][1]["after"] < 8000 + 0.01 * 20000  # beyond 3 σ are 0.1 % of the table
    assert report["steps"][-1]["after"] == len(cloud.points)
    assert "plane" in done.stdout and "Written: clean.ply, clean.json" in done.stdout


def test_several_scans_and_their_poses(ffds, scan, tmp_path):
    """The same scan twice, the second 7 mm off as its pose says but for 0.3 mm: afterwards one lies on the
    other within its noise."""
    points = files.read(scan).points
    np.savetxt(tmp_path / "b.xyz", points - (7, 0, 0), fmt="%.6f")
    pose = np.eye(4)
    pose[:3, 3] = (7, 0, 0.3)
    (tmp_path / "poses.json").write_text(json.dumps([np.eye(4).tolist(), {"T_model_scan": pose.tolist()}]))
    done = ffds("prepare", scan, "b.xyz", "--out", "both.ply", "--poses", "poses.json")
    assert done.returncode == 0, done.stderr
    both = files.read(tmp_path / "both.ply").points
    apart = (both[: len(points)] - both[len(points) :])[:28000]  # without the points far away
    assert len(both) == 2 * len(points) and np.abs(apart[:, 2]).max() < 0.05


@pytest.mark.parametrize("arguments, code, words", [
    ((), 2, "No step was asked for"),
    (("--near", "none.step", "5"), 2, "does not exist"),
    (("--near", "none.step", "five"), 2, "a distance in mm"),
    (("--box", "0,0,0,1,1"), 2, "6 numbers"),
    (("--box", "5,0,0,1,1,1"), 2, "lower corner first"),
    (("--box", "-9,-9,-9,-8,-8,-8"), 3, "Nothing of the scan lies in the box"),
    (("--spacing", "0"), 2, "above 0 mm"),
    (("--view", "0,0,1"), 2, "--normals"),
    (("--poses", "none.json"), 2, "cannot be read"),
    (("--remove-plane", "--out", "clean.xyz"), 2, "written as .ply")])
def test_errors_are_one_sentence(ffds, plate, tmp_path, arguments, code, words):
    done = ffds("prepare", plate[1], "--out", "clean.ply", *arguments)
    assert done.returncode == code and words in done.stderr and len(done.stderr.splitlines()) == 1
    assert not list(tmp_path.glob("clean*"))
