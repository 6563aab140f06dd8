# SPDX-License-Identifier: LGPL-2.1-or-later
"""The documentation: every link and picture is there, every test that it names exists, every command can be given."""
from __future__ import annotations

import ast
import re
import shlex
from pathlib import Path

import pytest

from ffds_workbench.cli.main import command_line
from ffds_workbench.errors import InputError

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
