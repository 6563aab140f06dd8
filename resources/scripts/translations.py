# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collects the texts of the window and brings the .ts files of ``resources/translations`` up to them.

    python3 resources/scripts/translations.py [LRELEASE]

Translations that are there are kept, texts that are gone are dropped, new ones are left open for the translator. With
the path of Qt's ``lrelease`` (Debian: qttools5-dev-tools) the .qm files are made anew. English is the language of the
sources. What is collected: ``tr("…")`` and the titles of undo steps, the texts of commands and of the preferences page,
and the tooltips of properties; their names stay as Python and expressions know them.
"""
from __future__ import annotations

import ast
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


def texts() -> list[Text]:
    """All texts, each once, in order."""
    found: list[Text] = [("Workbench", "Deform a CAD model to a scan; its topology stays")]
    for path in sorted((ROOT / "ffds_workbench" / "gui").rglob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        found += _of_calls(tree)
        found += _of_commands(tree)
        found += _of_properties(tree)
    for path in sorted((ROOT / "ffds_workbench" / "objects").glob("*.py")):
        found += _of_properties(ast.parse(path.read_text("utf-8")))
    found += _of_page(ROOT / "resources" / "ui" / "preferences.ui")
    return list(dict.fromkeys(found))


def _of_calls(tree: ast.AST) -> Iterator[Text]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            place = {"tr": 0, "call": 1}.get(name)
            if place is not None and len(node.args) > place and isinstance(node.args[place], ast.Constant):
                yield "FFDS", node.args[place].value


def _of_commands(tree: ast.AST) -> Iterator[Text]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            values = {target.id: item.value.value for item in node.body if isinstance(item, ast.Assign)
                      and isinstance(item.value, ast.Constant) for target in item.targets
                      if isinstance(target, ast.Name)}
            if values.get("NAME"):
                yield from ((values["NAME"], values[name]) for name in ("MENU", "TIP", "HELP"))


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
