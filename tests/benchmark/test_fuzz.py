# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fuzz benchmark counts every file; what ends a worker is a row, and the batch goes on behind it."""
from __future__ import annotations

import importlib
import json
import os
import signal

from ffds_workbench.benchmark import fuzz
from ffds_workbench.benchmark.fuzz import commands, kinds, seeds, worker

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


def test_a_command_that_ends_its_process_is_told_from_one_that_refuses(tmp_path, monkeypatch):
    """The commands are run as ``./ffds`` runs them; of what they do to their process nothing reaches this one."""
    arguments = ["deviation", str(tmp_path / "none.step"), str(tmp_path / "none.ply")]
    refused = commands.run(arguments, tmp_path / "said", 30.0)
    assert refused.code == 2 and refused.text.count("\n") == 1 and worker._of_command(refused) == "refused"
    monkeypatch.setattr(commands, "main", lambda arguments: os.kill(os.getpid(), signal.SIGKILL))
    ended = commands.run(arguments, tmp_path / "said", 30.0)
    assert ended.code == -signal.SIGKILL and worker._of_command(ended) == "exit -9, no line"


def test_a_command_without_an_end_is_ended(tmp_path, monkeypatch):
    monkeypatch.setattr(commands, "main", lambda arguments: sum(iter(int, 1)))
    ended = commands.run([], tmp_path / "said", 0.0)
    assert ended.code is None and worker._of_command(ended) == "did not end"


def test_there_are_models_to_damage():
    assert all(kinds.contents(kind)[0] for kind in kinds.by_command())


def test_the_scan_lies_on_the_plate():
    points = seeds.measured()[:, :3]
    bounds = seeds.plate().BoundBox
    assert (points[:, :2] > 0).all() and (points[:, :2] < bounds.XMax).all() and abs(bounds.ZMax) < 1e-12
