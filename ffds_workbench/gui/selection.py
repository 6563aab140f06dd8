# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is selected, sorted into parts, their faces, scans, and what is neither."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import FreeCADGui as Gui

from .translating import tr


@dataclass
class Chosen:
    """The selection.

    Attributes
    ----------
    parts : objects with a shape, in the order of their selection
    faces : names of the selected faces, by the name of their part
    scans : Points objects
    others : labels of what is none of these, an edge as "Part.Edge3"
    refusal : why a part that is selected cannot be used, "" for none
    """

    parts: list[Any] = field(default_factory=list)
    faces: dict[str, list[str]] = field(default_factory=dict)
    scans: list[Any] = field(default_factory=list)
    others: list[str] = field(default_factory=list)
    refusal: str = ""


def chosen() -> Chosen:
    """The current selection; nested objects are taken as themselves."""
    found = Chosen(refusal=_through_links())
    for entry in Gui.Selection.getSelectionEx() if not found.refusal else ():
        item = entry.Object
        if item.isDerivedFrom("Points::Feature"):
            found.scans.append(item)
        elif _is_part(item):
            if item not in found.parts:
                found.parts.append(item)
            found.faces.setdefault(item.Name, []).extend(
                name for name in entry.SubElementNames if name.startswith("Face"))
            found.others.extend(f"{item.Label}.{name}" for name in entry.SubElementNames
                                if name.startswith(("Edge", "Vertex")))
        else:
            found.others.append(item.Label)
    return found


def _through_links() -> str:
    """Why what is selected inside a link cannot be used: it stands elsewhere than the object that it shows."""
    for entry in Gui.Selection.getSelectionEx("", 0):
        for path in entry.SubElementNames:
            holders = entry.Object.getSubObjectList(path)[:-1]
            links = [item for item in holders if item.isDerivedFrom("App::Link")]
            if links and "." in path:
                return tr("This part is shown through the link {link}: pick it where it stands itself, or make a "
                          "simple copy of the link.").format(link=links[0].Label)
    return ""


def scans_of(document: Any) -> list[Any]:
    """The point clouds of a document."""
    return [item for item in document.Objects if item.isDerivedFrom("Points::Feature")]


def _is_part(item: Any) -> bool:
    if item.isDerivedFrom("Sketcher::SketchObject"):
        return False
    return item.isDerivedFrom("App::Link") or bool(getattr(getattr(item, "Shape", None), "Faces", ()))
