# SPDX-License-Identifier: LGPL-2.1-or-later
"""Untrusted FreeCAD documents: a copy with the same shapes that neither runs code nor opens other files.

Opening a document, FreeCAD imports the Python modules that its proxies name, and makes objects of their classes; it
imports the module that is named before ``::`` in each object's type; and it opens the documents that links lead to.
"""
from __future__ import annotations

import importlib.machinery
import importlib.util
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import FreeCAD

_TEXT = "Document.xml"


def is_foreign(root: ElementTree.Element) -> bool:
    """Whether the text of a document names Python code or other files.

    Raises
    ------
    ValueError : an object is of a type that is defined outside of FreeCAD
    """
    modules = {element.get("type", "").partition("::")[0] for element in root.iter("Object")}
    if any(_elsewhere(module) for module in modules if module):
        raise ValueError("an object is of a type that is not FreeCAD's")
    return any(True for _ in root.iter("Python")) or any(True for _ in _outward_links(root))


def linking_elsewhere(root: ElementTree.Element) -> set[str]:
    """Names of the objects that a document's text links to other files."""
    return {item.get("name", "") for item in root.iterfind("ObjectData/Object")
            if any(True for _ in _outward_links(item))}


def copy(path: Path, root: ElementTree.Element, folder: Path) -> Path:
    """A copy of a document in ``folder``, whose objects have no proxies and whose links end in it.

    Parameters
    ----------
    root : the document's text; it is changed
    """
    for python in root.iter("Python"):
        python.attrib.clear()
        python.set("value", "")
    for link in _outward_links(root):
        link.attrib.clear()
        link.attrib.update({"file": "", "stamp": "", "name": ""})
    result = folder / path.name
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(result, "w") as target:
        for entry in source.infolist():
            text = ElementTree.tostring(root, "utf-8") if entry.filename == _TEXT else source.read(entry)
            target.writestr(entry, text)
    return result


def _outward_links(element: ElementTree.Element) -> Iterator[ElementTree.Element]:
    return (link for link in element.iter("XLink") if link.get("file"))


def _elsewhere(module: str) -> bool:
    """Whether a module would be run that is neither compiled nor a part of FreeCAD."""
    if not module.isidentifier():  # looking for a.b would run a
        return True
    try:
        found = importlib.util.find_spec(module)
    except (ImportError, ValueError):
        return True
    if found is None or found.origin is None or found.origin.endswith(tuple(importlib.machinery.EXTENSION_SUFFIXES)):
        return False
    homes = [Path(FreeCAD.getHomePath()), Path(FreeCAD.getResourceDir())]
    return not any(home in Path(found.origin).parents for home in homes)
