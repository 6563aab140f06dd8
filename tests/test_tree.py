# SPDX-License-Identifier: LGPL-2.1-or-later
"""The layers of the package and what may import what, as CONTRIBUTING.md says; licences in every source file."""
from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "ffds_workbench"
RANK = {"__init__": 0, "errors": 0, "compat": 0, "find_freecad": 0, "output": 0, "registration": 1, "scan": 2,
        "brep": 3,
        "seams": 4, "report": 4, "api": 5, "benchmark": 6, "cli": 7, "objects": 7, "gui": 8}
GUI_ONLY = {"FreeCADGui", "PySide", "PySide2", "PySide6", "pivy"}
FREECAD = {"FreeCAD", "Part", "Points", "Mesh", "Import"}
MODULES = sorted(PACKAGE.rglob("*.py"))
SOURCES = sorted(path for pattern in ("*.py", "*.sh", "ffds", ".ci/run") for path in ROOT.rglob(pattern)
                 if ".git" not in path.parts and path.is_file() and "out" not in path.relative_to(ROOT).parts[:1])


def _layer(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def _imports(path: Path) -> Iterator[str]:
    """Absolute dotted names of what a module of the package imports."""
    here = ["ffds_workbench", *path.relative_to(PACKAGE).with_suffix("").parts]
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = ".".join(here[: len(here) - node.level]) if node.level else ""
            module = ".".join(part for part in (base, node.module) if part)
            yield from (f"{module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_arrows_point_down(path):
    layer = _layer(path)
    for name in _imports(path):
        parts = name.split(".")
        if parts[0] == "ffds_workbench" and len(parts) > 1:
            other = parts[1] if parts[1] in RANK else "__init__"
            assert RANK[other] <= RANK[layer], f"{layer} must not import {other}"
        assert layer == "gui" or parts[0] not in GUI_ONLY, f"{layer} must not import {parts[0]}"
        assert layer != "registration" or parts[0] not in FREECAD, f"registration must not import {parts[0]}"


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_source_names_its_licence(path):
    head = path.read_text("utf-8").splitlines()[:2]
    assert any("SPDX-License-Identifier: LGPL-2.1-or-later" in line for line in head)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_modules_stay_short(path):
    assert len(path.read_text("utf-8").splitlines()) <= 420, "split this module by noun"
