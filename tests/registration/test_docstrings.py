# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a reader of ``help()`` is told: every parameter by name, arrays with their shapes, and what is raised."""
from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "ffds_workbench"
ARRAYS = re.compile(r"\b(Array|Index|NDArray)\b")
SHAPE = re.compile(r"\([^()]*[,)]")


def _surface() -> dict[Path, set[str]]:
    """What the scripting surface hands out, by the module that it is in."""
    door = ast.parse((PACKAGE / "api" / "__init__.py").read_text("utf-8"))
    homes = next(ast.literal_eval(node.value) for node in door.body
                 if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "_HOMES")
    places = {home: (PACKAGE if home.startswith("..") else PACKAGE / "api").joinpath(*home.strip(".").split("."))
              for home in homes}
    return {place / "__init__.py" if place.is_dir() else place.with_suffix(".py"): set(homes[home])
            for home, place in places.items()}


SURFACE = {}
for home, names in _surface().items():
    # What a door hands on is in one of its modules.
    for path in sorted(home.parent.rglob("*.py")) if home.name == "__init__.py" else [home]:
        SURFACE[path] = SURFACE.get(path, set()) | names
MODULES = sorted({path for layer in ("registration", "api") for path in (PACKAGE / layer).rglob("*.py")} | set(SURFACE))


def _handed_out() -> set[str]:
    """What the doors of the packages hand out is public; all else is a room's own."""
    doors = [ast.parse(path.read_text("utf-8")) for path in (PACKAGE / "registration").rglob("__init__.py")]
    return {alias.name for door in doors for node in door.body if isinstance(node, ast.ImportFrom)
            for alias in node.names if not alias.name.startswith("_")}


PUBLIC = _handed_out()


def _names(path: Path) -> set[str]:
    """Public names that a module may hold."""
    return SURFACE.get(path, set()) | (PUBLIC if path.is_relative_to(PACKAGE / "registration") else set())


def _public(path: Path) -> Iterator[tuple[str, ast.FunctionDef, str]]:
    """Public functions and methods of a module with their names and what their class says of itself; all names of what
    lies in the open in `registration` are."""
    in_the_open = path.parent == PACKAGE / "registration"
    for node in ast.parse(path.read_text("utf-8")).body:
        if not isinstance(node, (ast.FunctionDef, ast.ClassDef)) or node.name.startswith("_"):
            continue
        if not (in_the_open or node.name in _names(path)):
            continue
        if isinstance(node, ast.FunctionDef):
            yield node.name, node, ""
        else:
            for item in node.body:
                if isinstance(item, ast.FunctionDef) and (not item.name.startswith("_") or item.name == "__call__"):
                    yield f"{node.name}.{item.name}", item, ast.get_docstring(node) or ""


def _is_array(annotation: ast.expr | None) -> bool:
    return annotation is not None and bool(ARRAYS.search(ast.unparse(annotation)))


def _gaps(name: str, function: ast.FunctionDef, of_class: str) -> Iterator[str]:
    text = ast.get_docstring(function)
    if not text:
        yield f"{name} has no docstring"
        return
    text = text + "\n" + of_class
    for argument in [*function.args.args, *function.args.kwonlyargs]:
        if argument.arg in ("self", "cls"):
            continue
        named = re.findall(rf"(?<![\w.]){re.escape(argument.arg)}(?!\w)(.*(?:\n.*)?)", text)
        if not named:
            yield f"{name}: {argument.arg} is not explained"
        elif _is_array(argument.annotation) and not any(map(SHAPE.search, named)):
            yield f"{name}: {argument.arg} has no shape"
    if _is_array(function.returns) and not SHAPE.search(text):
        yield f"{name}: the shape of what it returns is not told"
    raised = {ast.unparse(node.exc.func) for node in ast.walk(function)
              if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call)}
    yield from (f"{name}: {error} is not told" for error in sorted(raised) if error.split(".")[-1] not in text)


def _fields(path: Path) -> Iterator[str]:
    """Fields of public classes of a module that neither their docstrings nor the comments beside them tell, or arrays
    without a shape."""
    lines = path.read_text("utf-8").splitlines()
    for node in ast.parse("\n".join(lines)).body:
        if isinstance(node, ast.ClassDef) and node.name in _names(path):
            text = ast.get_docstring(node) or ""
            for item in node.body:
                if isinstance(item, ast.AnnAssign) and not ast.unparse(item.target).startswith("_"):
                    name = ast.unparse(item.target)
                    named = re.findall(rf"(?<![\w.]){re.escape(name)}(?!\w)(.*(?:\n.*)?)", text)
                    if not named and "  # " not in lines[item.lineno - 1]:
                        yield f"{node.name}.{name} is not explained"
                    elif _is_array(item.annotation) and not any(map(SHAPE.search, named)):
                        yield f"{node.name}.{name} has no shape"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_fields_are_told(path):
    assert not list(_fields(path))


@pytest.mark.parametrize("name", ["settings", "search_settings"])
def test_settings_of_the_alignment_say_where_they_come_from(name):
    """In one of three words, in the comment beside them or in the line below."""
    lines = (PACKAGE / "registration" / "rigid" / f"{name}.py").read_text("utf-8").splitlines()
    classes = [node for node in ast.parse("\n".join(lines)).body if isinstance(node, ast.ClassDef)]
    settings = [node for node in classes if node.name.endswith("Settings") and node.name != "RigidSettings"]
    assert settings
    for node in settings:
        for item in node.body:
            if isinstance(item, ast.AnnAssign):
                told = "\n".join(line for line in lines[item.lineno - 1 : (item.end_lineno or item.lineno) + 1])
                assert re.search(r"# .*\b(theory|unit|calibrated)\b", told), f"{node.name}.{ast.unparse(item.target)}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_parameters_shapes_and_errors_are_told(path):
    assert not [gap for item in _public(path) for gap in _gaps(*item)]
