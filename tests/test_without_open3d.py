# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where open3d is not installed, nothing is missing but the steps of ``prepare`` that are its own."""
from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
CORE = ["tests/scan/test_files.py", "tests/scan/test_normals.py", "tests/cli/test_deviation.py",
        "tests/api/test_register.py::test_a_shape_and_an_array", "tests/report/test_certificate.py"]
"""Reading, registering, judging, writing: what users do every day."""


@pytest.fixture
def without_open3d(tmp_path):
    """An environment for processes in which ``import open3d`` fails as it does where it is not installed."""
    package = tmp_path / "hidden" / "open3d"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("raise ModuleNotFoundError('No module named open3d', name='open3d')\n")
    return {**os.environ, "PYTHONPATH": str(package.parent)}


def test_the_core_of_the_suite_passes(without_open3d):
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *CORE], cwd=ROOT,
                          env=without_open3d, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout[-3000:]
    assert "No module named open3d" in done.stdout  # so says a skipped test: it was hidden


@pytest.mark.parametrize("options", [
    ["--remove-plane"], ["--remove-clutter"], ["--remove-outliers"], ["--spacing", "1"],
    ["--normals", "--view", "0,0,99"]])
def test_a_step_that_needs_it_says_so_in_one_sentence(ffds, plate, without_open3d, options):
    done = ffds("prepare", plate[1], "--out", "clean.ply", *options, env=without_open3d)
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
    assert "open3d is not installed" in done.stderr and "python3-open3d" in done.stderr


def test_a_box_needs_no_library(ffds, plate, without_open3d):
    done = ffds("prepare", plate[1], "--out", "clean.ply", "--box", "0,0,0,30,30,30", env=without_open3d)
    assert done.returncode == 0, done.stderr


def test_nothing_else_loads_it():
    homes = set()
    for path in (ROOT / "ffds_workbench").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else (
                [node.module or ""] if isinstance(node, ast.ImportFrom) and not node.level else
                [str(item.value) for item in node.args if isinstance(item, ast.Constant)]
                if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "import_module" else [])
            if any(name.partition(".")[0] == "open3d" for name in names):
                homes.add(str(path.relative_to(ROOT / "ffds_workbench").parent))
    assert homes <= {"scan/preparation", "benchmark", "benchmark/peer_study", "benchmark/simulated"}
