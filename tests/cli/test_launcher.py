# SPDX-License-Identifier: LGPL-2.1-or-later
"""The launcher itself: from anywhere, through a link, and quick where nothing has to be loaded."""
from __future__ import annotations

import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_help_lists_the_commands(ffds):
    start = time.monotonic()
    process = ffds("--help")
    assert process.returncode == 0
    for command in ("register", "deviation", "demo", "benchmark", "setup", "test"):
        assert command in process.stdout
    assert time.monotonic() - start < 5  # loads neither FreeCAD nor open3d; the limit is for busy machines


def test_a_link_to_the_launcher_works(tmp_path):
    (tmp_path / "linked").symlink_to(ROOT / "ffds")
    process = subprocess.run([tmp_path / "linked", "--version"], cwd=tmp_path, capture_output=True, text=True)
    assert process.returncode == 0 and process.stdout.startswith("FFDS ")


def test_a_module_in_the_working_folder_is_not_taken_for_ours(tmp_path, ffds):
    (tmp_path / "numpy.py").write_text("raise SystemExit(9)")
    assert ffds("deviation", "no.step", "no.ply").returncode == 2
