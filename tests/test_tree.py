# SPDX-License-Identifier: LGPL-2.1-or-later
"""The layers of the package and what may import what, as CONTRIBUTING.md says; names, sizes, licences."""
from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "ffds_workbench"
RANK = {"__init__": 0, "errors": 0, "compat": 0, "find_freecad": 0, "output": 0, "registration": 1, "scan": 2,
        "brep": 3, "fields": 4,
        "seams": 4, "report": 4, "inspection": 4.2, "robot": 4.5, "api": 5, "series": 6, "serve": 6.5,
        "benchmark": 6.5, "cli": 7, "objects": 7, "gui": 8}
GUI_ONLY = {"FreeCADGui", "PySide", "PySide2", "PySide6", "pivy"}
NETWORK = {"socket", "ssl", "urllib", "http", "ftplib", "smtplib", "requests", "webbrowser"}
FREECAD = {"FreeCAD", "Part", "Points", "Mesh", "Import"}
MODULES = sorted(PACKAGE.rglob("*.py"))
SOURCES = sorted(path for pattern in ("*.py", "*.sh", "ffds", ".ci/run") for path in ROOT.rglob(pattern)
                 if ".git" not in path.parts and path.is_file() and "out" not in path.relative_to(ROOT).parts[:1])


LONGEST, LONGEST_FUNCTION, ROOMIEST = 300, 45, 15
"""Lines of a module and of a function without its docstring, and modules of a folder."""
ARROWS = {"registration/joint": 75, "registration/rigid": 44}
"""How many arrows there may be between the rooms of a package, its modules and folders: so few that one can keep them
in mind."""
WHY_LONG = "# Long because "
"""A comment line that begins like this allows a module or the function that it stands in to be longer."""


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


def test_nothing_opens_a_connection():
    assert not {f"{path.name}: {name}" for path in MODULES for name in _imports(path) if name.split(".")[0] in NETWORK}


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_source_names_its_licence(path):
    head = path.read_text("utf-8").splitlines()[:2]
    assert any("SPDX-License-Identifier: LGPL-2.1-or-later" in line for line in head)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_modules_stay_short(path):
    lines = path.read_text("utf-8").splitlines()
    assert len(lines) <= LONGEST or any(line.startswith(WHY_LONG) for line in lines), "split this module by noun"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_functions_stay_short(path):
    text = path.read_text("utf-8")
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            lines = text.splitlines()[node.lineno - 1 : node.end_lineno]
            length = len(lines) - len((ast.get_docstring(node, clean=False) or "").splitlines())
            assert length <= LONGEST_FUNCTION or any(line.strip().startswith(WHY_LONG) for line in lines), node.name


@pytest.mark.parametrize("folder", sorted({path.parent for path in MODULES}),
                         ids=lambda folder: str(folder.relative_to(ROOT)))
def test_folders_stay_clear(folder):
    modules = [path for path in folder.glob("*.py") if path.stem != "__init__"]
    assert len(modules) <= ROOMIEST, f"{len(modules)} modules: make rooms by what a reader looks for"


def test_no_files_import_each_other_in_a_circle():
    names = {_module(path): path for path in MODULES}
    arrows = {name: {found for found in map(_file_of(names), _imports(path)) if found and found != name}
              for name, path in names.items()}
    try:
        TopologicalSorter(arrows).prepare()
    except CycleError as circle:
        raise AssertionError(" → ".join(circle.args[1])) from None


def test_the_picture_of_the_rooms_can_be_drawn(tmp_path):
    """Rooms that use each other in a circle have no floor to stand on."""
    script = ROOT / "resources" / "scripts" / "architecture.py"
    subprocess.run([sys.executable, script, tmp_path / "p.png"], check=True, capture_output=True)
    assert (tmp_path / "p.png").stat().st_size > 10_000  # a picture, not an empty page


@pytest.mark.parametrize("package", ARROWS)
def test_few_arrows_lead_from_room_to_room(package):
    prefix = _module(PACKAGE / package / "__init__.py") + "."
    found = {(_module(path).removeprefix(prefix).split(".")[0], name.removeprefix(prefix).split(".")[0])
             for path in (PACKAGE / package).rglob("*.py") if _module(path) + "." != prefix
             for name in map(_file_of({_module(module): module for module in MODULES}), _imports(path))
             if name and name.startswith(prefix)}
    assert sum(start != end for start, end in found) <= ARROWS[package]


def _module(path: Path) -> str:
    """Dotted name of a module or package."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def _file_of(names: dict[str, Path]):
    """The file that an imported name is in: a module, or what defines or hands on the name."""
    return lambda name: next((part for part in (name, name.rpartition(".")[0]) if part in names), None)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_private_names_stay_in_their_package(path):
    package = _module(path) if path.stem == "__init__" else _module(path).rpartition(".")[0]
    for name in _imports(path):
        home, _, last = name.rpartition(".")
        if home.startswith("ffds_workbench") and last.startswith("_") and not last.startswith("__"):
            inside = home if ROOT.joinpath(*home.split(".")).is_dir() else home.rpartition(".")[0]
            assert inside == package, f"{name} is private to its package"


def test_no_two_classes_have_one_name():
    homes = defaultdict(list)
    for path in MODULES:
        for node in ast.parse(path.read_text("utf-8")).body:
            if isinstance(node, ast.ClassDef):
                homes[node.name].append(str(path.relative_to(PACKAGE)))
    assert not {name: found for name, found in homes.items() if len(found) > 1}


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_constants_say_what_they_bound(path):
    bare = {"_MOST", "_LEAST", "_FEWEST", "_NEAR", "_FAR", "_FEW", "_MORE", "_SAME", "_CLOSE", "_ONE"}
    found = {node.id for node in ast.walk(ast.parse(path.read_text("utf-8")))
             if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    assert not found & bare, "name what the constant bounds: _LEAST_BAND_POINTS"


TUNED = sorted(path for room in ("registration", "brep") for path in (PACKAGE / room).rglob("*.py"))
ORIGIN = re.compile(r"(?:^|[(#*;.:] ?)\*?(theory|unit|units|calibrated)\*?(?=[):;,.*]|$)", re.IGNORECASE | re.MULTILINE)
"""Where a number comes from, in one word: "(unit: time)", "*theory*:", "# calibrated: by hand"."""


def _is_number(value: ast.expr | None) -> bool:
    """Whether a value is a number, or is made of numbers; tables of whole numbers are none, nor are enumerations."""
    if isinstance(value, ast.Constant):
        return type(value.value) in (int, float)
    if isinstance(value, ast.Tuple):
        rows = [row.elts for row in value.elts if isinstance(row, ast.Tuple)]
        if rows and all(isinstance(item, ast.Constant) and type(item.value) is int for row in rows for item in row):
            return False
        return any(map(_is_number, value.elts))
    if isinstance(value, ast.Call):
        named = isinstance(value.func, ast.Name) and value.func.id == "range"
        return not named and any(map(_is_number, [*value.args, *(word.value for word in value.keywords)]))
    if isinstance(value, ast.UnaryOp):
        return _is_number(value.operand)
    return isinstance(value, ast.BinOp) and (_is_number(value.left) or _is_number(value.right))


def _is_constant(node: ast.stmt, in_class: bool) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    names = [name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)]
    return bool(names) and (in_class or names[0].isupper()) and _is_number(node.value)


def _said_of(lines: list[str], body: list[ast.stmt], number: int) -> str:
    """The comments in and about a statement, and the docstring that follows it."""
    node = body[number]
    comments = [line.partition("#")[2] for line in lines[node.lineno - 1 : node.end_lineno]]
    for about, step in ((node.lineno - 2, -1), (node.end_lineno, 1)):
        while 0 <= about < len(lines) and lines[about].lstrip().startswith("#"):
            comments.append(lines[about].lstrip("# "))
            about += step
    after = body[number + 1] if number + 1 < len(body) else None
    if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
        comments.append(" ".join(str(after.value.value).split()))
    return "\n".join(comment.strip() for comment in comments)


@pytest.mark.parametrize("path", TUNED, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_numbers_say_where_they_come_from(path):
    """Each module-level number of the registration and the B-rep, and each field of a class of settings."""
    text = path.read_text("utf-8")
    module = ast.parse(text)
    rooms = [(module.body, False), *((node.body, True) for node in module.body
                                     if isinstance(node, ast.ClassDef) and node.name.endswith("Settings"))]
    silent = [text.splitlines()[node.lineno - 1] for body, in_class in rooms for number, node in enumerate(body)
              if _is_constant(node, in_class) and not ORIGIN.search(_said_of(text.splitlines(), body, number))]
    assert not silent, "say theory (and its source), unit (a physical assumption) or calibrated (by what, on what)"


def test_robust_factors_stand_once():
    """Of the median absolute deviation and of Tukey's cut-off; who needs one takes it from `robust_weights`."""
    homes = {path.stem for path in MODULES for node in ast.walk(ast.parse(path.read_text("utf-8")))
             if isinstance(node, ast.Constant) and isinstance(node.value, float)
             and (abs(node.value - 1.4826) < 2e-4 or abs(node.value - 4.685) < 1e-3 or abs(node.value - 0.6745) < 1e-4)}
    assert homes == {"robust_weights"}
