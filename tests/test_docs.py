# SPDX-License-Identifier: LGPL-2.1-or-later
"""The documentation: every link and picture is there, every test that it names exists, every command can be given."""
from __future__ import annotations

import ast
import json
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.cli.main import command_line, main
from ffds_workbench.errors import InputError
from ffds_workbench.scan.sensor.files import write_ply

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "resources" / "docs").rglob("*.md"))]
BLOCK = re.compile(r"^```\{?(\w+)\}?[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)
NOT_PYTHON = {"setup", "test"}
"""Commands of the launcher itself."""


def _name(path):
    return str(path.relative_to(ROOT))


@pytest.mark.parametrize("page", PAGES, ids=_name)
def test_links_lead_somewhere(page):
    text = re.sub(r"```.*?```", "", page.read_text("utf-8"), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if not re.match(r"https?://|#|mailto:", target):
            assert (page.parent / target.partition("#")[0]).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=_name)
def test_tests_that_are_named_exist(page):
    folder = None
    for path, test in re.findall(r"`(tests/[\w/]+\.py)?(?:::(\w+))?`", page.read_text("utf-8")):
        folder = path or folder
        if folder and (path or test):
            assert (ROOT / folder).is_file(), folder
            assert not test or f"def {test}(" in (ROOT / folder).read_text("utf-8"), f"{folder}::{test}"


@pytest.mark.parametrize("page", PAGES, ids=_name)
def test_blocks_can_be_run(page):
    """Commands are known with all their options; Python is Python."""
    for language, code in BLOCK.findall(page.read_text("utf-8")):
        if language == "python":
            ast.parse(code)
        if language != "sh":
            continue
        for line in code.replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if words[:1] == ["./ffds"] and words[1] not in NOT_PYTHON and "--help" not in words:
                try:
                    command_line().parse_args(words[1:])
                except InputError as error:
                    raise AssertionError(f"{line}: {error}") from None


def test_the_pages_build_without_a_warning(tmp_path):
    for name in ("sphinx", "myst_parser"):
        pytest.importorskip(name, reason="Sphinx or MyST is not installed: the documentation is not built")
    done = subprocess.run(["sh", str(ROOT / "resources" / "scripts" / "docs.sh"), str(tmp_path)], text=True,
                          capture_output=True)
    assert done.returncode == 0, done.stderr
    assert "--remove-clutter" in (tmp_path / "commands.html").read_text("utf-8")


def test_refusals_in_the_faq_are_refusals():
    """What the first column quotes stands in the sources, but for what is filled in."""
    texts = [node.value for path in (ROOT / "ffds_workbench").rglob("*.py")
             for node in ast.walk(ast.parse(path.read_text("utf-8")))
             if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    rows = re.findall(r"^\| ([^|]+) \|", (ROOT / "resources" / "docs" / "faq.md").read_text("utf-8"), re.MULTILINE)
    for row in rows[1:]:
        for piece in re.split(r"…|Face7|\bN\b|the scan seems to be in metres", row):
            assert any(piece.strip(" :") in text for text in texts), row


ELSEWHERE = {"gallery.md", "robot.md", "series.md", "fields.md", "inspection.md"}
"""Pages of resources/docs whose blocks are not run here. `resources/scripts/gallery.py` runs the gallery's, the same
commands as here but for the edges of the bracket. The rest need files or parts that the workplace has not; what
they do is tested in `tests/robot`, `tests/series`, `tests/fields` and `tests/inspection`."""
RUN = [page for page in PAGES if page != ROOT / "CONTRIBUTING.md"
       and str(page.relative_to(ROOT)) not in {f"resources/docs/{name}" for name in ELSEWHERE}
       and re.search(r"^```(?:sh|python)$", page.read_text("utf-8"), re.MULTILINE)]


@pytest.fixture
def workplace(plate, tmp_path, monkeypatch):
    """A folder in which the pages' files lie: the plate stands in for the bracket, so that all goes quickly."""
    import FreeCAD
    import Part

    random = np.random.default_rng(0)
    shutil.copy(plate[0], tmp_path / "bracket.step")
    points = np.loadtxt(plate[1])
    for name in ("bracket_scan", "scan", "a", "b", "c"):
        write_ply(tmp_path / f"{name}.ply", points if len(name) > 1 else points + random.normal(0, 0.01, points.shape))
    np.savetxt(tmp_path / "scan.xyz", points / 1000.0)
    (tmp_path / "poses.json").write_text(json.dumps([np.eye(4).tolist()] * 3))
    document = FreeCAD.newDocument("Part")
    document.addObject("Part::Feature", "Bracket").Shape = Part.read(str(plate[0]))
    document.saveAs(str(tmp_path / "part.FCStd"))
    FreeCAD.closeDocument(document.Name)
    write_ply(tmp_path / "flat_datum.ply", np.column_stack([random.uniform(0, 40, (9000, 2)),
                                                            random.normal(0, 0.05, 9000)]))
    (tmp_path / "taught.src").write_text("DEF taught()\nLIN {X 10, Y 0, Z 5, A 0, B 0, C 180}\n"
                                         "LIN {X 50, Y 0, Z 5, A 0, B 0, C 180}\nEND\n")
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("page", RUN, ids=_name)
def test_what_the_pages_say_runs(page, workplace):
    import FreeCAD

    for language, code in BLOCK.findall(page.read_text("utf-8")):
        if language == "python":
            exec(compile(code, page.name, "exec"), {})
        for line in code.replace("\\\n", " ").splitlines() if language == "sh" else ():
            words = shlex.split(line, comments=True)[1:]
            if not words or words[0] in NOT_PYTHON | {"series", "benchmark"}:
                continue
            if words[0] == "prepare":
                pytest.importorskip("open3d", reason="this page prepares a scan, which is open3d's")
            assert main(words) == 0, line
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
