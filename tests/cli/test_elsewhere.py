# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines unlike ours: no shell, paths with blanks and umlauts, nothing writable but the output, lines ending CRLF."""
from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.scan import files

ROOT = Path(__file__).resolve().parents[2]


def _files(folder: Path) -> set[Path]:
    return {path for path in folder.rglob("*") if "__pycache__" not in path.parts}


@pytest.fixture
def bare(tmp_path):
    """Runs ``python -m ffds_workbench.cli`` of a read-only copy in a folder "Mod ä", with no program on the path, a
    home that cannot be made and, as on Windows, no module ``resource``. Who is root may write all the same: so the
    copy is also looked at afterwards."""
    mod = tmp_path / "Blech ß" / "Mod ä" / "FFDS"
    shutil.copytree(ROOT / "ffds_workbench", mod / "ffds_workbench", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(ROOT / "resources" / "translations", mod / "resources" / "translations")
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "resource.py").write_text("raise ModuleNotFoundError('resource', name='resource')\n")
    folders = [path for path in (mod, *mod.rglob("*")) if path.is_dir()]
    for folder in folders:
        folder.chmod(0o555)
    before = _files(mod)

    def run(*arguments: object) -> subprocess.CompletedProcess:
        return subprocess.run(
            [sys.executable, "-P", "-m", "ffds_workbench.cli", *map(str, arguments)], cwd=tmp_path, text=True,
            stdin=subprocess.DEVNULL, capture_output=True, timeout=120,
            env={"PATH": "/nonexistent", "HOME": "/dev/null/home",
                 "PYTHONPATH": os.pathsep.join([str(hidden), str(mod)]), "LC_ALL": "C"})

    yield run
    for folder in folders:
        folder.chmod(0o755)
    assert _files(mod) == before


def test_the_command_line_needs_neither_shell_nor_home(bare, plate, tmp_path):
    model, scan = tmp_path / "Blech 1 ä.step", tmp_path / "Aufnahme ö.xyz"
    shutil.copy(plate[0], model)
    scan.write_bytes(plate[1].read_bytes().replace(b"\n", b"\r\n"))
    out = tmp_path / "Ergebnis ü"
    out.mkdir()
    done = bare("register", model, scan, "--face", "Face6", "--out", out / "gebaut ß.step", "--report", out / "r.json",
                "--picture", out / "Bild é.png")
    assert done.returncode == 0, done.stderr
    assert {path.name for path in out.iterdir()} == {"gebaut ß.step", "r.json", "Bild é.png"}


def test_errors_are_one_line_there_too(bare):
    done = bare("register", "kein Modell.step", "kein Scan ä.ply", "--out", "x.step")
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1 and "ä" in done.stderr


PLY = ("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
       "1 2 3\n4 5 6\n")
PCD = ("VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
       "1 2 3\n4 5 6\n")
STL = ("solid s\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 4 5 6\nvertex 1 5 3\nendloop\nendfacet\n"
       "endsolid s\n")


@pytest.mark.parametrize("name, text", [
    ("a.ply", PLY), ("a.pcd", PCD), ("a.stl", STL), ("a.xyz", "1 2 3\n4 5 6\n"),
    ("a.csv", "x;y;z\n1,0;2,0;3,0\n4;5;6\n"), ("a.pts", "2\n1 2 3\n4 5 6\n"),
    ("a.asc", "# c\n1 2 3\n4 5 6\n"), ("a.txt", "x y z\n1 2 3\n4 5 6\n")])
def test_lines_may_end_as_in_windows(tmp_path, name, text):
    (tmp_path / name).write_bytes(text.replace("\n", "\r\n").encode())
    assert np.array_equal(files.read(tmp_path / name).points[:2], [[1, 2, 3], [4, 5, 6]])
