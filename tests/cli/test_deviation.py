# SPDX-License-Identifier: LGPL-2.1-or-later
"""``ffds deviation`` and the other commands that share its ways."""
from __future__ import annotations

import json

import numpy as np


def test_figures_of_a_known_offset(ffds, plate, tmp_path):
    x, y = np.random.default_rng(3).uniform((1, 1), (59, 39), (3000, 2)).T
    np.savetxt(tmp_path / "above.xyz", np.stack([x, y, np.full(3000, 5.25)], axis=1), fmt="%.6f")
    process = ffds("deviation", plate[0], "above.xyz", "--report", "d.json", "--picture", "d.png")
    assert process.returncode == 0, process.stderr
    report = json.loads((tmp_path / "d.json").read_text())
    for figure in report["deviation"].values():
        assert abs(figure - 0.25) < 1e-6  # six decimals in the file, exact planes
    assert [face["points"] for face in report["faces"]] == [0, 0, 0, 0, 0, 3000]
    assert (tmp_path / "d.png").read_bytes().startswith(b"\x89PNG")


def test_several_scans_and_units_are_fused(ffds, plate, tmp_path):
    x, y = np.random.default_rng(3).uniform((1, 1), (59, 39), (2000, 2)).T
    points = np.stack([x, y, np.full(2000, 5.1)], axis=1) / 1000
    np.savetxt(tmp_path / "a.xyz", points[:900], fmt="%.9f")
    np.savetxt(tmp_path / "b.csv", points[900:], fmt="%.9f", delimiter=";")
    process = ffds("deviation", plate[0], "a.xyz", "b.csv", "--scan-unit", "m", "--report", "d.json")
    assert process.returncode == 0, process.stderr
    report = json.loads((tmp_path / "d.json").read_text())
    assert report["scan"]["points"] == 2000 and report["scan"]["unit"] == "m"
    assert abs(report["deviation"]["mean"] - 0.1) < 1e-6


def test_a_scan_beside_the_model_is_refused(ffds, plate, tmp_path):
    np.savetxt(tmp_path / "beside.xyz", np.random.default_rng(3).uniform((69, 0, 0), (70, 40, 5), (500, 3)))
    process = ffds("deviation", plate[0], "beside.xyz", "--report", "d.json")
    assert (process.returncode, process.stdout) == (3, "")
    assert process.stderr.count("\n") == 1 and "align" in process.stderr
    assert not (tmp_path / "d.json").exists()


def test_an_unknown_benchmark_is_one_line(ffds):
    process = ffds("benchmark", "luck", "--out", "x")
    assert process.returncode == 2 and process.stderr.count("\n") == 1
