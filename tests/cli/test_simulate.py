# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds simulate`` and ``register --method ffd-hsu`` from the command line."""
from __future__ import annotations

import numpy as np
import Part
import pytest

from ffds_workbench.scan import files


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.step"
    Part.makeBox(40, 30, 10).exportStep(str(path))
    return path


def test_scan_and_truth_are_written(ffds, box, tmp_path):
    done = ffds("simulate", box, "--out", "scan.ply", "--truth", "truth.npz", "--spacing", "0.5", "--noise", "0.05",
                "--view", "0,0,1", "-1,0,0.5", "--outliers", "0.01", "--seed", "3")
    assert done.returncode == 0, done.stderr
    points = files.read(tmp_path / "scan.ply").points
    assert f"{len(points)} points from 2 views" in done.stdout
    truth = np.load(tmp_path / "truth.npz")
    assert truth["views"].shape == (2, 3) and truth["edges"].shape == (12, 200, 3)
    assert np.array_equal(truth["nominal"], truth["warped"])
    top = np.abs(points[:, 2] - 10) < 0.3
    assert top.sum() > 4000      # 40 × 30 mm at 0.5 mm is 4800 from above alone


@pytest.mark.parametrize("wrong", [["--view", "0,0,0"], ["--spacing", "0"], ["--outliers", "2"], ["--view", "1,2"],
                                   ["--table", "3"], ["--seed", "-1"], ["--noise", "nan"]])
def test_bad_requests_are_one_line_and_no_file(ffds, box, tmp_path, wrong):
    done = ffds("simulate", box, "--out", "scan.ply", *wrong)
    assert done.returncode == 2 and len(done.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "scan.ply").exists()


def test_a_view_that_sees_nothing_is_refused(ffds, tmp_path):
    Part.makePlane(20, 20).exportStep(str(tmp_path / "sheet.step"))
    done = ffds("simulate", "sheet.step", "--out", "scan.ply", "--view", "0,0,-1")
    assert done.returncode == 3 and "see nothing" in done.stderr


def test_the_lattice_in_space_serves_as_a_method(ffds, box, tmp_path):
    rng = np.random.default_rng(0)
    xy = rng.uniform((0, 0), (40, 30), (20_000, 2))
    z = 10 + 0.8 * np.exp(-((xy - (20, 15)) ** 2).sum(1) / 200)
    np.savetxt(tmp_path / "scan.xyz", np.column_stack([xy, z]))
    top = next(i for i, face in enumerate(Part.read(str(box)).Faces, 1) if face.CenterOfMass.z > 9.99)
    done = ffds("register", box, "scan.xyz", "--out", "built.step", "--method", "ffd-hsu", "--lattice", "8x8",
                "--face", f"Face{top}")
    assert done.returncode == 0, done.stderr
    built = Part.read(str(tmp_path / "built.step"))
    assert len(built.Faces) == 6 and len(built.Edges) == 12 and built.isValid()
    grid = [(x, y) for x in (5, 20, 35) for y in (5, 15, 25)]
    for x, y in grid:
        height = 10 + 0.8 * np.exp(-((x - 20) ** 2 + (y - 15) ** 2) / 200)
        gap = built.Faces[top - 1].distToShape(Part.Vertex(x, y, height))[0]
        assert gap < 0.03      # closest points of a cloud 0.25 mm apart, on slopes up to 0.05
