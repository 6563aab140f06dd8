# SPDX-License-Identifier: LGPL-2.1-or-later
"""The launcher itself: from anywhere, through a link, and quick where nothing has to be loaded."""
from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_help_lists_the_commands(ffds):
    process = ffds("--help", env={**os.environ, "PYTHONPROFILEIMPORTTIME": "1"})
    assert process.returncode == 0
    for command in ("register", "deviation", "demo", "benchmark", "setup", "test"):
        assert command in process.stdout
    loaded = {line.rpartition("|")[2].strip() for line in process.stderr.splitlines()}
    assert "ffds_workbench.cli.main" in loaded and not loaded & {"FreeCAD", "Part", "open3d"}


def test_a_link_to_the_launcher_works(tmp_path):
    (tmp_path / "linked").symlink_to(ROOT / "ffds")
    process = subprocess.run([tmp_path / "linked", "--version"], cwd=tmp_path, capture_output=True, text=True)
    assert process.returncode == 0 and process.stdout.startswith("FFDS ")


def test_a_module_in_the_working_folder_is_not_taken_for_ours(tmp_path, ffds):
    (tmp_path / "numpy.py").write_text("raise SystemExit(9)")
    assert ffds("deviation", "no.step", "no.ply").returncode == 2


def test_a_copy_among_freecads_modules_is_not_taken_for_ours(tmp_path):
    """A checkout beside an installed copy: processes that are started import from sys.path, so that comes first."""
    for home in ("Mod", "v1-1/Mod"):
        package = tmp_path / home / "FFDS" / "ffds_workbench"
        package.mkdir(parents=True)
        (package / "__init__.py").write_text("raise SystemExit(9)")
    found = subprocess.run(
        [sys.executable, "-c",
         "import importlib.util, sys; from ffds_workbench import find_freecad; find_freecad.activate(); "
                               "del sys.modules['ffds_workbench']; "
                               "print(importlib.util.find_spec('ffds_workbench').origin)"],
        env={**os.environ, "PYTHONPATH": str(ROOT), "FREECAD_USER_HOME": str(tmp_path)}, cwd=tmp_path,
        capture_output=True, text=True)
    assert found.stdout.splitlines()[-1:] == [str(ROOT / "ffds_workbench" / "__init__.py")], found.stderr
