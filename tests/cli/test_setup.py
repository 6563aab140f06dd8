# SPDX-License-Identifier: LGPL-2.1-or-later
"""`./ffds setup`: harmless to run again, links the workbench, runs the example, and moves nothing of the user's."""
from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def checkout(tmp_path):
    """A copy of what setup needs, so that the example's output lands beside it and not in the checkout."""
    copy = tmp_path / "ffds"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".git", "out", "tests", "__pycache__", ".*_cache"))
    return copy


def run(checkout, home):
    environment = {**os.environ, "XDG_DATA_HOME": str(home)}
    return subprocess.run([str(checkout / "ffds"), "setup"], capture_output=True, text=True, env=environment,
                          timeout=300)


def test_setup_twice(checkout, tmp_path):
    link = tmp_path / "home" / "FreeCAD" / "Mod" / "FFDS"
    for _ in range(2):
        done = run(checkout, tmp_path / "home")
        assert done.returncode == 0, done.stderr
        assert link.resolve() == checkout.resolve()
        assert "topology" in done.stdout and "after" in done.stdout
        results = {path.suffix for path in (checkout / "out" / "demo").iterdir()}
        assert {".step", ".json", ".png"} <= results
        assert "Installing" not in done.stdout


def test_a_folder_in_the_way_stays(checkout, tmp_path):
    folder = tmp_path / "home" / "FreeCAD" / "Mod" / "FFDS"
    folder.mkdir(parents=True)
    (folder / "mine").write_text("kept")
    done = run(checkout, tmp_path / "home")
    assert done.returncode == 2 and "move it away" in done.stderr and "Traceback" not in done.stderr
    assert (folder / "mine").read_text() == "kept"
