# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names and colours in STEP files, read from and written into the text (ISO 10303-21).

FreeCAD reads and writes them only with its GUI. Here the faces of the text are matched with the faces of the shape by
their order and surface types; where that does not fit (assemblies that place a part twice) the file keeps its
geometry and loses the decoration.
"""
from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .document_colours import Colour

_RECORD = re.compile(r"((?:[^';]+|'[^']*')*)(?:;|'|\Z)")
"""Up to the next semicolon outside of a string. It fits everywhere, a stray quote included, so that it takes as long as
the text is, whatever is damaged: a doubled quote within a string counts as two strings."""
_ENTITY = re.compile(r"#(\d{1,18})\s*=\s*([A-Z0-9_]*)\s*\((.*)\)", re.DOTALL)
_STRING = re.compile(r"'((?:[^']|'')*)'")
_REFERENCE = re.compile(r"#(\d+)")
_PRODUCT = re.compile(r"(=\s*PRODUCT\s*\(\s*)'((?:[^']|'')*)'(\s*,\s*)'((?:[^']|'')*)'")
_UNCERTAINTY = re.compile(r"(UNCERTAINTY_MEASURE_WITH_UNIT\(\s*LENGTH_MEASURE\()([^)]*)(\))")
_UNNAMED = "Open CASCADE STEP translator"
_SOLIDS = ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP")
_KINDS = {"PLANE": "Plane", "CYLINDRICAL_SURFACE": "Cylinder", "CONICAL_SURFACE": "Cone",
          "SPHERICAL_SURFACE": "Sphere", "TOROIDAL_SURFACE": "Toroid"}
_NAMED_COLOURS = {"red": (1, 0, 0), "green": (0, 1, 0), "blue": (0, 0, 1), "yellow": (1, 1, 0), "magenta": (1, 0, 1),
                  "cyan": (0, 1, 1), "black": (0, 0, 0), "white": (1, 1, 1)}
"""Red, green and blue of ISO 10303-46's named colours (theory)."""
_THROUGH_STYLE = ("PRESENTATION_STYLE_ASSIGNMENT", "PRESENTATION_STYLE_BY_CONTEXT", "SURFACE_STYLE_USAGE",
                  "SURFACE_SIDE_STYLE", "SURFACE_STYLE_FILL_AREA", "SURFACE_STYLE_RENDERING",
                  "SURFACE_STYLE_RENDERING_WITH_PROPERTIES", "FILL_AREA_STYLE", "FILL_AREA_STYLE_COLOUR")
_BODIES = (*_SOLIDS, "SHELL_BASED_SURFACE_MODEL", "CLOSED_SHELL", "OPEN_SHELL", "ORIENTED_CLOSED_SHELL")
_DEEPEST = 3
"""A face has a shell, that an oriented one around it, and that a solid or a model of surfaces (ISO 10303-42)
(theory)."""
_END = b"END-ISO-10303-21;"


@dataclass(frozen=True)
class Decoration:
    """What a STEP file contains besides the geometry; empty tuples where it contains nothing.

    Attributes
    ----------
    product : name of the product, "" where there is none or several
    solids : one name per solid
    faces : one name per face
    colours : one colour per face
    """

    product: str = ""
    solids: tuple[str, ...] = ()
    faces: tuple[str, ...] = ()
    colours: tuple[Colour, ...] = ()


@dataclass(frozen=True)
class _Face:
    number: int
    owners: tuple[int, ...]


class _Entities:
    """The simple entities of the text: type and parameters by number."""

    def __init__(self, text: str) -> None:
        records = (match[1].rstrip() for match in _RECORD.finditer(text))
        found = (_ENTITY.search(record) for record in records if record.endswith(")"))
        self.records = {int(m[1]): (m[2], m[3]) for m in found if m is not None}
        self._colours: dict[int, Colour | None] = {}

    def kind(self, number: int) -> str:
        return self.records.get(number, ("", ""))[0]

    def references(self, number: int) -> list[int]:
        parameters = _STRING.sub("''", self.records.get(number, ("", ""))[1])
        return [int(item) for item in _REFERENCE.findall(parameters)]

    def name(self, number: int) -> str:
        match = _STRING.match(self.records[number][1].lstrip())
        return _decoded(match[1]) if match else ""

    def of_kind(self, *kinds: str) -> Iterator[int]:
        return (number for number, (kind, _) in self.records.items() if kind in kinds)

    def faces(self) -> list[_Face]:
        """All faces, in the order in which a reader meets them: representation, body, shell, face."""
        bodies = [item for representation, (kind, _) in self.records.items() if kind.endswith("SHAPE_REPRESENTATION")
                  for item in self.references(representation)
                  if self.kind(item) in (*_SOLIDS, "SHELL_BASED_SURFACE_MODEL")]
        return [face for body in dict.fromkeys(bodies) for face in self._faces_below(body, ())]

    def _faces_below(self, number: int, owners: tuple[int, ...]) -> Iterator[_Face]:
        kind = self.kind(number)
        if kind in ("ADVANCED_FACE", "FACE_SURFACE"):
            yield _Face(number, owners)
        elif len(owners) < _DEEPEST and kind in _BODIES:
            for item in self.references(number):
                yield from self._faces_below(item, (number, *owners))

    def colour(self, number: int, depth: int = 0) -> Colour | None:
        """The colour at the end of a chain of styles."""
        kind = self.kind(number)
        parameters = self.records.get(number, ("", ""))[1]
        if kind == "COLOUR_RGB":
            return _rgb(_STRING.sub("", parameters).split(",")[1:4])
        if kind == "DRAUGHTING_PRE_DEFINED_COLOUR":
            named = _NAMED_COLOURS.get(self.name(number).lower())
            return (float(named[0]), float(named[1]), float(named[2]), 0.0) if named else None
        if kind not in _THROUGH_STYLE or depth > len(_THROUGH_STYLE):
            return None
        if number not in self._colours:
            self._colours[number] = None  # where a chain comes back to itself
            found = (self.colour(item, depth + 1) for item in self.references(number))
            self._colours[number] = next((colour for colour in found if colour is not None), None)
        return self._colours[number]


def _rgb(values: Sequence[str]) -> Colour | None:
    """A colour out of three numbers from 0 to 1, None where they are not."""
    try:
        red, green, blue = map(float, values)
    except ValueError:
        return None
    return (red, green, blue, 0.0) if all(0.0 <= value <= 1.0 for value in (red, green, blue)) else None


def read(text: str, kinds: Sequence[str]) -> Decoration:
    """Names and colours of a STEP text whose shape has faces of these ``kinds`` (Part's surface types), in order."""
    product = product_name(text)
    if "STYLED_ITEM" not in text and not re.search(r"(ADVANCED_FACE|_BREP|_VOIDS)\s*\(\s*'[^']", text):
        return Decoration(product)
    entities = _Entities(text)
    faces = entities.faces()
    if not _fits(entities, faces, kinds):
        return Decoration(product)
    solids = tuple(entities.name(number) for number in _solids(entities, faces))
    names = tuple(entities.name(face.number) for face in faces)
    return Decoration(product, solids if any(solids) else (), names if any(names) else (), _colours(entities, faces))


def _solids(entities: _Entities, faces: Sequence[_Face]) -> list[int]:
    owners = dict.fromkeys(face.owners[-1] for face in faces)
    return [number for number in owners if entities.kind(number) in _SOLIDS]


def _fits(entities: _Entities, faces: Sequence[_Face], kinds: Sequence[str]) -> bool:
    if len(faces) != len(kinds):
        return False
    surfaces = [next((_KINDS[entities.kind(item)] for item in entities.references(face.number)
                      if entities.kind(item) in _KINDS), None) for face in faces]
    return all(found is None or found == kind for found, kind in zip(surfaces, kinds, strict=True))


def _colours(entities: _Entities, faces: Sequence[_Face]) -> tuple[Colour, ...]:
    """One colour per face, its own or that of the shell or solid around it; none unless every face has one."""
    styled: dict[int, Colour] = {}
    for number in entities.of_kind("STYLED_ITEM", "OVER_RIDING_STYLED_ITEM"):
        references = entities.references(number)
        styles = [item for item in references if entities.kind(item).startswith("PRESENTATION_STYLE")]
        colour = next((found for found in map(entities.colour, styles) if found is not None), None)
        if colour is not None and len(references) > len(styles):
            styled[references[len(styles)]] = colour
    colours = [next((styled[item] for item in (face.number, *face.owners) if item in styled), None) for face in faces]
    if all(colour is None for colour in colours):
        return ()
    grey = (0.8, 0.8, 0.8, 0.0)
    return tuple(colour or grey for colour in colours)


def declared_unit(text: str) -> str:
    """"inches", "metres" or "centimetres" where the text says so; "" for mm, or where it says nothing."""
    if re.search(r"CONVERSION_BASED_UNIT\s*\(\s*'INCH'", text, re.IGNORECASE):
        return "inches"
    prefixes = set(re.findall(r"SI_UNIT\s*\(\s*(\$|\.[A-Z]+\.)\s*,\s*\.METRE\.", text))
    return {"$": "metres", ".CENTI.": "centimetres"}.get(prefixes.pop(), "") if len(prefixes) == 1 else ""


def product_name(text: str) -> str:
    """The name of the only product, "" where there are several or a nameless one."""
    names = {match[2] for match in _PRODUCT.finditer(text)}
    name = _decoded(names.pop()) if len(names) == 1 else ""
    return "" if name.startswith(_UNNAMED) else name


def decorate(text: str, decoration: Decoration, kinds: Sequence[str]) -> str:
    """The STEP text of a shape with these ``kinds`` of faces, with the names and colours written into it."""
    if decoration.product:
        name = _encoded(decoration.product)
        text = _PRODUCT.sub(lambda m: f"{m[1]}'{name}'{m[3]}'{name}'", text)
    if not (decoration.solids or decoration.faces or decoration.colours):
        return text
    entities = _Entities(text)
    faces = entities.faces()
    if not _fits(entities, faces, kinds):
        return text
    names = dict(zip((face.number for face in faces), decoration.faces, strict=False))
    solids = _solids(entities, faces)
    if len(solids) == len(decoration.solids):
        names.update(zip(solids, decoration.solids, strict=True))
    text = _with_names(text, {number: name for number, name in names.items() if name})
    colours = decoration.colours * len(faces) if len(decoration.colours) == 1 else decoration.colours
    return _with_colours(text, entities, faces, colours) if len(colours) == len(faces) else text


def with_uncertainty(text: str, least: float) -> str:
    """The STEP text with an uncertainty of length of at least ``least`` in mm.

    That is the largest gap between what the file says is connected (ISO 10303-43). OCCT writes the average tolerance,
    and its reader makes new pcurves where they end farther from their vertex than that.
    """
    def raised(match: re.Match[str]) -> str:
        return f"{match[1]}{max(float(match[2]), least):.3E}{match[3]}"

    return _UNCERTAINTY.sub(raised, text)


def _with_names(text: str, names: dict[int, str]) -> str:
    def named(match: re.Match[str]) -> str:
        name = names.get(int(match[1]))
        return match[0] if name is None else match[0].replace("''", f"'{_encoded(name)}'", 1)

    return re.sub(r"#(\d+) = [A-Z_]+\(''", named, text) if names else text


def _with_colours(text: str, entities: _Entities, faces: Sequence[_Face], colours: Sequence[Colour]) -> str:
    """Append a style per colour and a styled item per face (ISO 10303-46), as CAD systems write them."""
    context = next((refs[-1] for number in entities.records
                    if entities.kind(number).endswith("SHAPE_REPRESENTATION")
                    and (refs := entities.references(number))), None)
    if context is None:
        return text
    number = max(entities.records) + 1
    lines: list[str] = []
    styles: dict[Colour, int] = {}
    for colour in dict.fromkeys(colours):
        red, green, blue = colour[:3]
        lines += [f"#{number} = COLOUR_RGB('',{red:.6f},{green:.6f},{blue:.6f});",
                  f"#{number + 1} = FILL_AREA_STYLE_COLOUR('',#{number});",
                  f"#{number + 2} = FILL_AREA_STYLE('',(#{number + 1}));",
                  f"#{number + 3} = SURFACE_STYLE_FILL_AREA(#{number + 2});",
                  f"#{number + 4} = SURFACE_SIDE_STYLE('',(#{number + 3}));",
                  f"#{number + 5} = SURFACE_STYLE_USAGE(.BOTH.,#{number + 4});",
                  f"#{number + 6} = PRESENTATION_STYLE_ASSIGNMENT((#{number + 5}));"]
        styles[colour] = number + 6
        number += 7
    items = range(number, number + len(faces))
    lines += [f"#{item} = STYLED_ITEM('color',(#{styles[colour]}),#{face.number});"
              for item, face, colour in zip(items, faces, colours, strict=True)]
    listed = ",".join(f"#{item}" for item in items)
    lines.append(f"#{number + len(faces)} = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',({listed}),"
                 f"#{context});")
    head, tail = text.rsplit("ENDSEC;", 1)
    return head + "\n".join(lines) + "\nENDSEC;" + tail


def is_complete(path: Path) -> bool:
    """Whether the file ends as a STEP file must."""
    with path.open("rb") as stream:
        stream.seek(0, 2)
        stream.seek(max(0, stream.tell() - 100))
        return _END in stream.read()


def _encoded(name: str) -> str:
    """A string in the encoding of ISO 10303-21 (quotes doubled, \\X2\\ for what is not ASCII)."""
    escaped = name.replace("\\", "\\\\").replace("'", "''")
    return re.sub(r"[^ -~]+", lambda m: "\\X2\\" + m[0].encode("utf-16-be").hex().upper() + "\\X0\\", escaped)


def _decoded(text: str) -> str:
    text = re.sub(r"\\X2\\((?:[0-9A-Fa-f]{4})+)\\X0\\",
                  lambda m: bytes.fromhex(m[1]).decode("utf-16-be", "replace"), text)
    text = re.sub(r"\\X\\([0-9A-Fa-f]{2})", lambda m: chr(int(m[1], 16)), text)
    return text.replace("''", "'").replace("\\\\", "\\")
