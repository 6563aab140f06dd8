# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fuzz benchmark counts every file; what ends a worker is a row, and the batch goes on behind it."""
from __future__ import annotations

import importlib
import json

from ffds_workbench.benchmark import fuzz
from ffds_workbench.benchmark.fuzz import kinds, seeds

runner = importlib.import_module("ffds_workbench.benchmark.fuzz.run")


def rows(folder, **counts) -> dict[str, dict[str, int]]:
    """Outcomes by kind."""
    fuzz.run(folder, lambda text: None, models=0, **counts)
    return {row["kind"]: row["outcomes"] for row in json.loads((folder / "fuzz.json").read_text())["rows"]}


def test_every_file_is_counted(tmp_path, monkeypatch):
    monkeypatch.setattr(kinds, "in_process", lambda: ["scan .ply", "path .csv"])
    found = rows(tmp_path, scans=60)
    assert {kind: sum(outcomes.values()) for kind, outcomes in found.items()} == {"scan .ply": 60, "path .csv": 1}
    assert all(set(outcomes) <= {"taken", "refused"} for outcomes in found.values())
    assert not list((tmp_path / "failures").iterdir()) and "| scan .ply | 60 |" in (tmp_path / "fuzz.md").read_text()


def test_what_ends_a_worker_is_a_row(tmp_path, monkeypatch):
    """The third file of each batch ends the worker."""
    monkeypatch.setattr(kinds, "in_process", lambda: ["scan .xyz"])
    monkeypatch.setattr(runner, "_WORKER", runner._WORKER.replace("worker.main()", """
import os
outcome = worker._outcome
worker._outcome = lambda *a: os._exit(1) if (a[1].parent / "at").read_text().endswith("2") else outcome(*a)
worker.main()
"""))
    found = rows(tmp_path, scans=5)["scan .xyz"]
    assert found["ended the process"] == 1 and sum(found.values()) == 5
    assert [path.name for path in (tmp_path / "failures").iterdir()] == ["scan-.xyz-2.xyz"]


def test_there_are_models_to_damage():
    assert all(kinds.contents(kind)[0] for kind in kinds.by_command())


def test_the_scan_lies_on_the_plate():
    points = seeds.measured()[:, :3]
    bounds = seeds.plate().BoundBox
    assert (points[:, :2] > 0).all() and (points[:, :2] < bounds.XMax).all() and abs(bounds.ZMax) < 1e-12
