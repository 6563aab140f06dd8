# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges and vertices that belong to no face, in a STEP text: complete, and at their place among the solids.

OCCT writes solids first and every free edge as a set of its own after them, and drops free vertices: numbers would
change. Here the items of the representation are put into the shape's order, and what lies together in a compound
becomes one set, its points included.
"""
from __future__ import annotations

import re
from collections.abc import Iterator

import Part

_ENTITY = re.compile(r"^#(\d+) = ([^;]*);\n", re.MULTILINE)
_REPRESENTATION = re.compile(r"\w*SHAPE_REPRESENTATION\('',\s*\(([#\d,\s]+)\),\s*#\d+\)")
_REFERENCE = re.compile(r"#(\d+)")
_SOLIDS = ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP")
_SHEET, _CURVES, _POINTS = "SHELL_BASED_SURFACE_MODEL", "GEOMETRIC_CURVE_SET", "GEOMETRIC_SET"

Free = list[Part.Shape]
"""Edges and vertices that lie together in one compound."""


def with_free_shapes(text: str, shape: Part.Shape) -> str:
    """The STEP text that OCCT wrote for a shape, with the shape's free edges and vertices where they belong.

    Text whose items are not those of the shape comes back as it is.
    """
    bodies = list(_bodies(shape))
    if not any(isinstance(body, list) for body in bodies):
        return text
    entities = {int(match[1]): match[2] for match in _ENTITY.finditer(text)}
    main, found = next(((number, found) for number, entity in entities.items()
                        if (found := _REPRESENTATION.match(entity))), (0, None))
    if found is None:
        return text
    items = [int(item) for item in _REFERENCE.findall(found[1])]
    kinds: tuple[tuple[str, ...], ...] = _SOLIDS, (_SHEET,), (_CURVES,), ("AXIS2_PLACEMENT_3D",)
    solids, sheets, curves, others = ([item for item in items if entities[item].startswith(kind)] for kind in kinds)
    free = [part for body in bodies if isinstance(body, list) for part in body]
    whole = [body.ShapeType for body in bodies if not isinstance(body, list)]
    told = whole.count("Solid"), len(whole) - whole.count("Solid"), sum(part.ShapeType == "Edge" for part in free)
    if told != (len(solids), len(sheets), len(curves)) or sum(told) + len(others) < len(items):
        return text
    order, new = _items(bodies, entities, iter(solids), iter(sheets), iter(curves))
    listed, dropped = ",".join(f"#{item}" for item in others + order), set(curves)
    new[main] = entities[main].replace(found[1], listed)

    def kept(match: re.Match[str]) -> str:
        number = int(match[1])
        return "" if number in dropped else f"#{number} = {new.pop(number)};\n" if number in new else match[0]

    head, tail = _ENTITY.sub(kept, text).rsplit("ENDSEC;", 1)
    return head + "".join(f"#{number} = {entity};\n" for number, entity in new.items()) + "ENDSEC;" + tail


def _items(bodies: list[Part.Shape | Free], entities: dict[int, str], solids: Iterator[int], sheets: Iterator[int],
           curves: Iterator[int]) -> tuple[list[int], dict[int, str]]:
    """The items of the representation in the order of the bodies, and the sets and points to add."""
    order: list[int] = []
    new: dict[int, str] = {}
    number = max(entities)
    for body in bodies:
        if not isinstance(body, list):
            order.append(next(solids if body.ShapeType == "Solid" else sheets))
            continue
        members: list[str] = []
        for part in body:
            if part.ShapeType == "Vertex":
                number += 1
                new[number] = "CARTESIAN_POINT('',({!r},{!r},{!r}))".format(*part.Point)
                members.append(f"#{number}")
            else:
                members += [f"#{member}" for member in _REFERENCE.findall(entities[next(curves)])]
        number += 1
        kind = _CURVES if any(part.ShapeType == "Edge" for part in body) else _POINTS
        new[number] = f"{kind}('',({','.join(members)}))"
        order.append(number)
    return order, new


def _bodies(shape: Part.Shape) -> Iterator[Part.Shape | Free]:
    """Solids, sheets, and runs of free edges and vertices, in the order in which sub-shapes are numbered."""
    if shape.ShapeType not in ("Compound", "CompSolid"):
        yield [shape] if shape.ShapeType in ("Edge", "Vertex") else shape
        return
    run: Free = []
    for child in shape.childShapes():
        if child.ShapeType in ("Edge", "Vertex"):
            run.append(child)
            continue
        if run:
            yield run
            run = []
        yield from _bodies(child)
    if run:
        yield run
