# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is selected, sorted into parts, their faces, scans, and what is neither."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import FreeCADGui as Gui

from .translating import tr

Place = tuple[float, float, float]
_REACH = 0.1
"""How far from a part, as a share of its size, the point of a scan may be that was clicked to mean one of its faces
(unit: scans of deformed parts lie nearer)."""


class _Clicks:
    """Remembers where selected objects were clicked: FreeCAD forgets it for those without faces."""

    def __init__(self) -> None:
        self.places: dict[tuple[str, str], list[Place]] = {}
        self.watching = False

    def addSelection(self, document: str, name: str, element: str, place: Place) -> None:
        """As FreeCAD tells it; picks in the tree come without a place."""
        if tuple(place) != (0.0, 0.0, 0.0):
            self.places.setdefault((document, name), []).append(tuple(place))

    def removeSelection(self, document: str, name: str, element: str) -> None:
        """As FreeCAD tells it."""
        self.places.pop((document, name), None)

    def clearSelection(self, document: str) -> None:
        """As FreeCAD tells it."""
        self.places.clear()


_clicks = _Clicks()


def watch_clicks() -> None:
    """From now on the places of clicks are known."""
    if not _clicks.watching:
        Gui.Selection.addObserver(_clicks)
        _clicks.watching = True


@dataclass
class Chosen:
    """The selection.

    Attributes
    ----------
    parts : objects with a shape, in the order of their selection
    faces : names of the selected faces, by the name of their part
    scans : Points objects
    places : where these were clicked in the view, (x, y, z) in mm
    others : labels of what is none of these, an edge as "Part.Edge3"
    refusal : why a part that is selected cannot be used, "" for none
    """

    parts: list[Any] = field(default_factory=list)
    faces: dict[str, list[str]] = field(default_factory=dict)
    scans: list[Any] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)
    others: list[str] = field(default_factory=list)
    refusal: str = ""


def chosen() -> Chosen:
    """The current selection; nested objects are taken as themselves."""
    found = Chosen(refusal=_through_links())
    for entry in Gui.Selection.getSelectionEx() if not found.refusal else ():
        item = entry.Object
        if item.isDerivedFrom("Points::Feature"):
            found.scans.append(item)
            found.places += _clicks.places.get((item.Document.Name, item.Name), [])
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


def face_at(document: Any, place: Place) -> tuple[Any, str] | None:
    """The visible part, and the name of its face, that lie nearest to a point of a scan; None where there is none near.

    ``place`` is in mm, in the document's coordinates.
    """
    import Part

    from ..brep.model_files import outer_placement

    vertex, best, found = Part.Vertex(*place), float("inf"), None
    for item in parts_shown(document):
        shape = Part.getShape(item).copy()
        shape.Placement = outer_placement(item).multiply(shape.Placement)
        near = min(best, _REACH * shape.BoundBox.DiagonalLength)
        for number, face in enumerate(shape.Faces, 1):
            box = face.BoundBox
            box.enlarge(near)
            if box.isInside(vertex.Point) and (distance := face.distToShape(vertex)[0]) < near:
                near = best = distance
                found = item, f"Face{number}"
    return found


def parts_shown(document: Any) -> list[Any]:
    """The visible parts of a document."""
    return [item for item in document.Objects if item.Visibility and _is_part(item)]


def scans_of(document: Any) -> list[Any]:
    """The point clouds of a document."""
    return [item for item in document.Objects if item.isDerivedFrom("Points::Feature")]


def _is_part(item: Any) -> bool:
    if item.isDerivedFrom("Sketcher::SketchObject"):
        return False
    return item.isDerivedFrom("App::Link") or bool(getattr(getattr(item, "Shape", None), "Faces", ()))
