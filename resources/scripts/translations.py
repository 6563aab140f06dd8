# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collects the texts of the window and brings the .ts files of ``resources/translations`` up to them.

    python3 resources/scripts/translations.py [LRELEASE]

Translations that are there are kept, texts that are gone are dropped, new ones are left open for the translator. With
the path of Qt's ``lrelease`` (Debian: qttools5-dev-tools) the .qm files are made anew. English is the language of the
sources. What is collected: ``tr("…")`` and the titles of undo steps, the texts of commands and of the preferences page,
and the tooltips of properties; their names stay as Python and expressions know them. Of the layers below the window,
which know no Qt, what they say to the user: refusals, stages of work and notes, with ``{0}`` for their first value.
"""
from __future__ import annotations

import ast
import itertools
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "resources" / "translations"
LANGUAGES = ("de",)
Text = tuple[str, str]
"""Context and text."""
LAYERS = ("registration", "scan", "brep", "seams", "report", "api", "objects")
SAYING = {"InputError": 0, "RefusedError": 0, "stage": 1, "tell": 0, "progress": 0, "report": 0, "_no_answer": 0}
"""Calls that say something, and which argument it is."""
PHRASES = {"sentences", "reason", "lost", "where", "missing", "was", "renamed", "phrases", "notes", "left_out"}
"""Variables that hold sentences, or a part of one."""
ANSWERS = {"text", "doubts", "turn_name", "_branching", "blocked_ways", "check_verdict", "far_scan_refusal",
           "_why_failed", "verdict_sentence", "_off_text", "_thin_text", "_carried_text", "_boolean_text"}
"""Functions that return one."""
WORDS = ("scan", "part", "faces", "edges", "vertices")
"""Words that stand where a sentence has a value."""


def texts() -> list[Text]:
    """All texts, each once, in order."""
    found: list[Text] = [("Workbench", "Deform a CAD model to a scan; its topology stays")]
    found += (("Workbench", title) for group in _groups() for title in (group, f"FFDS {group}"))
    for path in sorted((ROOT / "ffds_workbench" / "gui").rglob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        found += _of_calls(tree)
        found += _of_commands(tree)
        found += _of_properties(tree)
    for path in sorted((ROOT / "ffds_workbench" / "objects").glob("*.py")):
        found += _of_properties(ast.parse(path.read_text("utf-8")))
    found += _of_page(ROOT / "resources" / "ui" / "preferences.ui")
    for path in (path for layer in LAYERS for path in sorted((ROOT / "ffds_workbench" / layer).rglob("*.py"))):
        found += (("Sentence", text) for text in _said(ast.parse(path.read_text("utf-8"))))
    found += (("Sentence", word) for word in WORDS)
    return list(dict.fromkeys(found))


def _said(tree: ast.AST) -> Iterator[str]:
    """What a module says to the user, as templates."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            told = name == "append" and getattr(node.func.value, "id", "") in PHRASES
            spoken = node.args[SAYING.get(name, 0):][:1] if name in SAYING or told else []
        elif isinstance(node, (ast.Assign, ast.AugAssign)):
            names = {getattr(item, "id", "") for target in getattr(node, "targets", None) or [node.target]
                     for item in ast.walk(target)}
            spoken = [node.value] if names & PHRASES else []
        elif isinstance(node, ast.FunctionDef) and node.name in ANSWERS:
            spoken = [item.value for item in ast.walk(node) if isinstance(item, ast.Return) and item.value is not None]
        else:
            continue
        for value in spoken:
            yield from (text for text in _templates(value) if not text.startswith("\t"))  # a line of a program


def _templates(node: ast.expr) -> Iterator[str]:
    """The texts that an expression can be, and those that can be values in them; lists give those of their items."""
    if isinstance(node, (ast.List, ast.Tuple)):
        for item in node.elts:
            yield from _templates(item)
    elif isinstance(node, (ast.ListComp, ast.GeneratorExp)):
        yield from _templates(node.elt)
    elif isinstance(node, ast.IfExp):
        yield from _templates(node.body)
        yield from _templates(node.orelse)
    elif isinstance(node, ast.BoolOp):
        for item in node.values:
            yield from _templates(item)
    elif isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "format":
        if isinstance(node.func.value, ast.Constant):
            numbers = itertools.count()
            yield re.sub(r"\{[^}]*\}", lambda _: f"{{{next(numbers)}}}", node.func.value.value)
    else:
        parts = list(_parts(node))
        text = "".join(f"{{{sum(not isinstance(other, str) for other in parts[:k])}}}" if not isinstance(part, str)
                       else part for k, part in enumerate(parts))
        if any(isinstance(part, str) and " " in part.strip() for part in parts) or len(parts) > 1 and ": " in text:
            yield text
        for part in parts:
            if not isinstance(part, str) and part is not node:
                yield from _templates(part)


def _parts(node: ast.expr) -> Iterator[str | ast.expr]:
    """The letters of a text, and expressions where it has values."""
    if isinstance(node, ast.Constant):
        yield str(node.value)
    elif isinstance(node, ast.JoinedStr):
        for part in node.values:
            yield from _parts(part)
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        yield from _parts(node.left)
        yield from _parts(node.right)
    else:
        yield node.value if isinstance(node, ast.FormattedValue) else node


def _of_calls(tree: ast.AST) -> Iterator[Text]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            place = {"tr": 0, "call": 1}.get(name)
            if place is not None and len(node.args) > place and isinstance(node.args[place], ast.Constant):
                yield "FFDS", node.args[place].value


def _groups() -> list[str]:
    """Titles of the submenus and toolbars."""
    tree = ast.parse((ROOT / "ffds_workbench" / "gui" / "commands" / "__init__.py").read_text("utf-8"))
    return next([key.value for key in node.value.keys] for node in tree.body
                if isinstance(node, ast.Assign) and isinstance(node.value, ast.Dict))


def _of_commands(tree: ast.AST) -> Iterator[Text]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            values = {target.id: item.value.value for item in node.body if isinstance(item, ast.Assign)
                      and isinstance(item.value, ast.Constant) for target in item.targets
                      if isinstance(target, ast.Name)}
            if values.get("NAME"):
                yield from ((values["NAME"], values[name]) for name in ("MENU", "TIP", "HELP"))
            if values.get("NEEDS"):
                yield "FFDS", values["NEEDS"]


def _of_properties(tree: ast.AST) -> Iterator[Text]:
    """Tooltips in the tables of properties: ``Property("Name", …, "tip")`` and ``("App::…", "Name", …, "tip")``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("Property", "_figure"):
            tip = node.args[3 if node.func.id == "Property" else 1]
            if isinstance(tip, ast.Constant):
                yield "App::Property", tip.value
        items = node.elts if isinstance(node, ast.Tuple) else node.args if isinstance(node, ast.Call) else []
        values = [item.value for item in items if isinstance(item, ast.Constant) and isinstance(item.value, str)]
        if values and values[0].startswith("App::Property") and len(values) > 2:
            yield "App::Property", values[-1]


def _of_page(path: Path) -> Iterator[Text]:
    root = ElementTree.parse(path).getroot()
    context = root.findtext("class") or ""
    yield from ((context, item.text) for item in root.iter("string") if item.text and item.text.strip(" m"))


def update(language: str) -> int:
    """Bring a .ts file up to the texts; returns how many are not translated."""
    path = FOLDER / f"FFDS_{language}.ts"
    known: dict[Text, str] = {}
    if path.exists():
        for context in ElementTree.parse(path).getroot().iter("context"):
            for message in context.iter("message"):
                key = context.findtext("name") or "", message.findtext("source") or ""
                known[key] = message.findtext("translation") or ""
    root = ElementTree.Element("TS", version="2.1", language=language, sourcelanguage="en")
    contexts: dict[str, ElementTree.Element] = {}
    missing = 0
    for key in sorted(texts()):
        if key[0] not in contexts:
            contexts[key[0]] = ElementTree.SubElement(root, "context")
            ElementTree.SubElement(contexts[key[0]], "name").text = key[0]
        message = ElementTree.SubElement(contexts[key[0]], "message")
        ElementTree.SubElement(message, "source").text = key[1]
        translation = ElementTree.SubElement(message, "translation")
        translation.text = known.get(key, "")
        if not translation.text:
            translation.set("type", "unfinished")
            missing += 1
    ElementTree.indent(root)
    text = ElementTree.tostring(root, "unicode")
    path.write_text(f'<?xml version="1.0" encoding="utf-8"?>\n<!-- SPDX-License-Identifier: LGPL-2.1-or-later -->\n'
                    f"<!DOCTYPE TS>\n{text}\n", "utf-8")
    return missing


if __name__ == "__main__":
    for name in LANGUAGES:
        print(f"{name}: {update(name)} of {len(texts())} texts are not translated")
        if len(sys.argv) > 1:
            source = FOLDER / f"FFDS_{name}.ts"
            subprocess.run([sys.argv[1], "-silent", str(source), "-qm", str(source.with_suffix(".qm"))], check=True)
