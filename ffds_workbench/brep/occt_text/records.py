# SPDX-License-Identifier: LGPL-2.1-or-later
"""Open CASCADE's BREP text (version 1) as records: parse, change, print.

This module owns the syntax: which record has how many tokens, and how shapes refer to each other. It knows nothing of
what the geometry means. Geometry and location records are kept verbatim, so whatever is not changed comes back as the
same number. Triangulations and polygons are dropped: they are display data of the old geometry.
"""
from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from ...errors import RefusedError
from .record_lengths import curve_2d_end, curve_3d_end, surface_end

_HEADER = "CASCADE Topology V1, (c) Matra-Datavision"
_SECTIONS = ("Locations", "Curve2ds", "Curves", "Polygon3D", "PolygonOnTriangulations", "Surfaces", "Triangulations",
             "TShapes")


@dataclass(frozen=True)
class ShapeReference:
    """A use of a shape: orientation ('+', '-', 'i', 'e'), position in `BrepText.shapes`, location (0: none)."""

    orientation: str
    shape: int
    location: int


@dataclass(frozen=True)
class VertexPoint:
    """A vertex: tolerance and point in mm, and its points on curves and surfaces as unread tokens."""

    tolerance: float
    point: tuple[float, float, float]
    representations: tuple[tuple[str, ...], ...] = ()


@dataclass(frozen=True)
class Curve3d:
    """The 3-D curve of an edge: indices from 1, parameter range."""

    curve: int
    location: int
    first: float
    last: float


@dataclass(frozen=True)
class CurveOnSurface:
    """The curve of an edge in a surface's (u, v): one pcurve, or the two of a seam ('+' takes the first)."""

    pcurves: tuple[int, ...]
    continuity: str
    surface: int
    location: int
    first: float
    last: float


@dataclass(frozen=True)
class Regularity:
    """The continuity of two surfaces across an edge."""

    continuity: str
    surface_a: int
    location_a: int
    surface_b: int
    location_b: int


@dataclass(frozen=True)
class EdgeCurves:
    """An edge: tolerance in mm, OCCT's three flags, and its representations."""

    tolerance: float
    same_parameter: bool
    same_range: bool
    degenerated: bool
    representations: tuple[Curve3d | CurveOnSurface | Regularity, ...]


@dataclass(frozen=True)
class FaceSurface:
    """A face: its surface by index from 1 (0: none, a mesh only) and that surface's location within the face."""

    natural_restriction: bool
    tolerance: float
    surface: int
    location: int


Geometry = VertexPoint | EdgeCurves | FaceSurface


@dataclass(frozen=True)
class TShape:
    """A shape without place or orientation: 'Ve', 'Ed', 'Wi', 'Fa', 'Sh', 'So', 'CS' or 'Co', and its parts."""

    kind: str
    geometry: Geometry | None
    flags: str
    children: tuple[ShapeReference, ...]


@dataclass
class BrepText:
    """A shape as records. Geometry is referred to by index from 1, shapes by position (children before parents)."""

    locations: list[str]
    curves_2d: list[str]
    curves_3d: list[str]
    surfaces: list[str]
    shapes: list[TShape]
    root: ShapeReference


def parse(text: str) -> BrepText:
    """Read the text that ``shape.exportBrepToString()`` gives.

    Raises
    ------
    RefusedError
        if the text is of another version or does not follow the format
    """
    if _HEADER not in text:
        raise RefusedError("This FreeCAD writes BREP text of a version not known here: use FreeCAD 0.20 to 1.0.")
    marks = list(re.finditer(r"^(" + "|".join(_SECTIONS) + r") +(\d+)[ \t]*$", text, re.MULTILINE))
    if [mark[1] for mark in marks] != list(_SECTIONS):
        raise RefusedError("The shape's BREP text is damaged: its sections are not the expected ones.")
    ends = [mark.start() for mark in marks[1:]] + [len(text)]
    section = {mark[1]: (text[mark.end():end].split(), int(mark[2])) for mark, end in zip(marks, ends, strict=True)
               if not mark[1].startswith(("Polygon", "Triangulation"))}
    try:
        shapes, root = _shapes(*section["TShapes"])
        return BrepText(_records(*section["Locations"], _location_end), _records(*section["Curve2ds"], curve_2d_end),
                        _records(*section["Curves"], curve_3d_end), _records(*section["Surfaces"], surface_end),
                        shapes, root)
    except (IndexError, ValueError, KeyError) as error:
        raise RefusedError("The shape's BREP text is damaged: a record does not have the expected form.") from error


def dump(brep: BrepText) -> str:
    """Print the records as text for ``shape.importBrepFromString``."""
    count = len(brep.shapes)
    parts = ["", _HEADER]
    for name, records in (("Locations", brep.locations), ("Curve2ds", brep.curves_2d), ("Curves", brep.curves_3d)):
        parts += [f"{name} {len(records)}", *records]
    parts += ["Polygon3D 0", "PolygonOnTriangulations 0", f"Surfaces {len(brep.surfaces)}", *brep.surfaces]
    parts += ["Triangulations 0", "", f"TShapes {count}"]
    for shape in brep.shapes:
        children = "".join(_reference_text(child, count) for child in shape.children)
        parts += [shape.kind, *_geometry_lines(shape.geometry), "", shape.flags, children + "*"]
    parts += ["", _reference_text(brep.root, count), ""]
    return "\n".join(parts)


def _reference_text(reference: ShapeReference, count: int) -> str:
    return f"{reference.orientation}{count - reference.shape} {reference.location} "


def _geometry_lines(geometry: VertexPoint | EdgeCurves | FaceSurface | None) -> list[str]:
    if isinstance(geometry, VertexPoint):
        points = [" ".join(tokens) for tokens in geometry.representations]
        return [repr(geometry.tolerance), " ".join(map(repr, geometry.point)), *points, "0 0"]
    if isinstance(geometry, FaceSurface):
        return [f"{geometry.natural_restriction:d}  {geometry.tolerance!r} {geometry.surface} {geometry.location}"]
    if isinstance(geometry, EdgeCurves):
        flags = f"{geometry.same_parameter:d} {geometry.same_range:d} {geometry.degenerated:d}"
        return [f" {geometry.tolerance!r} {flags}", *map(_representation_line, geometry.representations), "0"]
    return []


def _representation_line(item: Curve3d | CurveOnSurface | Regularity) -> str:
    if isinstance(item, Curve3d):
        return f"1  {item.curve} {item.location} {item.first!r} {item.last!r}"
    if isinstance(item, Regularity):
        return f"4 {item.continuity} {item.surface_a} {item.location_a} {item.surface_b} {item.location_b}"
    place = f"{item.surface} {item.location} {item.first!r} {item.last!r}"
    if len(item.pcurves) == 1:
        return f"2  {item.pcurves[0]} {place}"
    return f"3  {item.pcurves[0]} {item.pcurves[1]}{item.continuity} {place}"


def _records(tokens: list[str], count: int, find_end: Callable[[list[str], int], int]) -> list[str]:
    records, start = [], 0
    for _ in range(count):
        end = find_end(tokens, start)
        records.append(" ".join(tokens[start:end]))
        start = end
    if start != len(tokens):
        raise ValueError("tokens are left over")
    return records


def _location_end(tokens: list[str], start: int) -> int:
    if tokens[start] == "1":
        return start + 13
    end = start + 1
    while tokens[end] != "0":
        end += 2
    return end + 1


def _shapes(tokens: list[str], count: int) -> tuple[list[TShape], ShapeReference]:
    read: dict[str, Callable[[list[str], int], tuple[Geometry, int]]] = {"Ve": _vertex, "Ed": _edge, "Fa": _face}
    shapes, at = [], 0
    for _ in range(count):
        kind, at = tokens[at], at + 1
        geometry: Geometry | None = None
        if kind in read:
            geometry, at = read[kind](tokens, at)
        flags, at = tokens[at], at + 1
        children = []
        while tokens[at] != "*":
            children.append(_reference(tokens[at], tokens[at + 1], count))
            at += 2
        at += 1
        shapes.append(TShape(kind, geometry, flags, tuple(children)))
    return shapes, _reference(tokens[at], tokens[at + 1], count)


def _reference(shape: str, location: str, count: int) -> ShapeReference:
    return ShapeReference(shape[0], count - int(shape[1:]), int(location))


def _vertex(tokens: list[str], at: int) -> tuple[VertexPoint, int]:
    tolerance, x, y, z = map(float, tokens[at : at + 4])
    at += 4
    points = []
    while tokens[at + 1] != "0":
        length = {"1": 4, "2": 5, "3": 5}[tokens[at + 1]]
        points.append(tuple(tokens[at : at + length]))
        at += length
    return VertexPoint(tolerance, (x, y, z), tuple(points)), at + 2


def _edge(tokens: list[str], at: int) -> tuple[EdgeCurves, int]:
    tolerance = float(tokens[at])
    flags = [token == "1" for token in tokens[at + 1 : at + 4]]
    at += 4
    items: list[Curve3d | CurveOnSurface | Regularity] = []
    while tokens[at] != "0":
        kind = tokens[at]
        if kind == "1":
            items.append(Curve3d(int(tokens[at + 1]), int(tokens[at + 2]),
                                 float(tokens[at + 3]), float(tokens[at + 4])))
            at += 5
        elif kind in "23":
            pcurves, continuity, at = _pcurves(tokens, at)
            items.append(CurveOnSurface(pcurves, continuity, int(tokens[at]), int(tokens[at + 1]),
                                        float(tokens[at + 2]), float(tokens[at + 3])))
            at += 4
        elif kind == "4":
            items.append(Regularity(tokens[at + 1], *map(int, tokens[at + 2 : at + 6])))
            at += 6
        else:
            at += {"5": 3, "6": 4, "7": 5}[kind]
    return EdgeCurves(tolerance, flags[0], flags[1], flags[2], tuple(items)), at + 1


def _pcurves(tokens: list[str], at: int) -> tuple[tuple[int, ...], str, int]:
    if tokens[at] == "2":
        return (int(tokens[at + 1]),), "", at + 2
    # OCCT prints the continuity of a seam without a space after the second index.
    second = re.fullmatch(r"(\d+)([A-Z]\w)?", tokens[at + 2])
    if second is None:
        raise ValueError(f"{tokens[at + 2]} is no pcurve index")
    if second[2]:
        return (int(tokens[at + 1]), int(second[1])), second[2], at + 3
    return (int(tokens[at + 1]), int(second[1])), tokens[at + 3], at + 4


def _face(tokens: list[str], at: int) -> tuple[FaceSurface, int]:
    face = FaceSurface(tokens[at] == "1", float(tokens[at + 1]), int(tokens[at + 2]), int(tokens[at + 3]))
    at += 4
    # A triangulation, "2 index", may stand before the seven flag digits.
    return face, at + 2 if tokens[at] == "2" else at
