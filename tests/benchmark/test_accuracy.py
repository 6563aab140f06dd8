# SPDX-License-Identifier: LGPL-2.1-or-later
"""The accuracy and speed benchmarks write their tables; their figures are those of single runs."""
import json

from ffds_workbench.benchmark import accuracy, speed


def test_accuracy(tmp_path, monkeypatch):
    monkeypatch.setattr(accuracy, "CASES", tmp_path / "absent")
    text = accuracy.run(tmp_path, lambda message: None, seeds=1)
    data = json.loads((tmp_path / "accuracy.json").read_text())
    assert data["sheet"]["A"]["robust"]["mean"] < 0.01 < data["sheet"]["A"]["ffds"]["mean"]
    assert "| A: noise alone" in text
    assert (tmp_path / "accuracy.png").stat().st_size > 10_000


def test_speed(tmp_path):
    text = speed.run(tmp_path, lambda message: None, sizes=(20_000, 40_000), repeats=2)
    assert "robust, cylinder" in text
    assert json.loads((tmp_path / "speed.json").read_text())["builds"]["k-d tree"]["builds"] == 1.0
