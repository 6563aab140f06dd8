# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads a model file in the current process: FreeCAD's importers, and what the file contains besides the shape.

Open CASCADE crashes or hangs on some damaged files: foreign files are read by `reading`, which runs this module in a
separate process. It loads FreeCAD and Part alone, so that it starts quickly.
"""
from __future__ import annotations

import json
import re
import struct
import tempfile
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import FreeCAD
import Part

from ...errors import InputError
from ...scan import xml_text
from . import harmless_document, step_colours
from .step_colours import Decoration

DOCUMENT = ".fcstd"
_DAMAGED = (RuntimeError, OSError, ValueError, KeyError, EOFError, struct.error, zlib.error, zipfile.BadZipFile,
            Part.OCCError, FreeCAD.Base.FreeCADError)
_PLAIN_NAME = re.compile(r"[^/\\:]+")


@dataclass(frozen=True)
class FileContent:
    """What a file holds: a shape, its name, the names and colours of its faces and solids, the unit it declares."""

    shape: Part.Shape
    label: str
    decoration: Decoration = Decoration()
    unit: str = ""


def read(path: Path, label: str | None) -> FileContent:
    """Read a file; ``label`` picks the object of a FreeCAD document.

    Raises
    ------
    InputError : the file is damaged, or there is no such object
    """
    return _read_document(path, label) if path.suffix.lower() == DOCUMENT else _read_exchange(path)


def write(content: FileContent, folder: Path) -> None:
    """Write what was read as ``shape.bin`` and ``about.json``, as `reading` takes it up."""
    if not content.shape.isNull():
        content.shape.exportBinary(str(folder / "shape.bin"))
    about = {"label": content.label, "decoration": asdict(content.decoration), "unit": content.unit}
    (folder / "about.json").write_text(json.dumps(about), "utf-8")


def _read_exchange(path: Path) -> FileContent:
    suffix = path.suffix.lower()
    try:
        shape = Part.read(str(path))
    except _DAMAGED as error:
        raise InputError(f"The model {path} cannot be read: it is damaged or not a {suffix} file.") from error
    if suffix not in (".step", ".stp"):
        return FileContent(shape, path.stem)
    text = path.read_text("utf-8", errors="replace")
    decoration = step_colours.read(text, surface_types(shape))
    return FileContent(shape, decoration.product or path.stem, decoration, step_colours.declared_unit(text))


def surface_types(shape: Part.Shape) -> list[str]:
    """Of each face, as Part calls them."""
    return [type(face.Surface).__name__ for face in shape.Faces]


def _read_document(path: Path, label: str | None) -> FileContent:
    from . import document_colours

    try:
        root = _checked_archive(path)
        elsewhere = harmless_document.linking_elsewhere(root)
        with _opened(path, root) as document:
            item = _pick(path, document, label, elsewhere)
            colours = document_colours.read(path, item.Name)
            return FileContent(placed_shape(item), item.Label, Decoration(colours=colours))
    except _DAMAGED as error:
        raise InputError(f"The model {path} is damaged or not a FreeCAD document.") from error


def _checked_archive(path: Path) -> Element:
    """The text of a document, refused if files would be unpacked to other folders than its own (ValueError)."""
    with zipfile.ZipFile(path) as archive:
        root = xml_text.parse(archive.read("Document.xml"))
    names = [element.get(key, "") for element in root.iter("FileIncluded") for key in ("file", "data")]
    if any(name and (name == ".." or not _PLAIN_NAME.fullmatch(name)) for name in names):
        raise ValueError("a file of the document belongs into another folder")
    return root


def open_document(path: Path) -> FreeCAD.Document | None:
    """The document of a file that is open in this process already."""
    for document in FreeCAD.listDocuments().values():
        if document.FileName and Path(document.FileName).resolve() == path.resolve():
            return document
    return None


@contextmanager
def _opened(path: Path, root: Element) -> Iterator[FreeCAD.Document]:
    """The document of a file: the one that is open already and stays so, or one opened for the moment, in which nothing
    is run that the file names."""
    document = open_document(path)
    if document is not None:
        yield document
        return
    with tempfile.TemporaryDirectory(prefix="ffds-") as folder:
        harmless = harmless_document.copy(path, root, Path(folder)) if harmless_document.is_foreign(root) else path
        document = FreeCAD.openDocument(str(harmless), hidden=True)
        try:
            yield document
        finally:
            FreeCAD.closeDocument(document.Name)


def placed_shape(item: object) -> Part.Shape:
    """A document object's shape in the document's coordinates."""
    shape = Part.getShape(item).copy()
    if not shape.isNull():
        shape.Placement = outer_placement(item).multiply(shape.Placement)
    return shape


def outer_placement(item: Any) -> FreeCAD.Placement:
    """From the coordinates of what holds a document object to the document's; a link does not know it itself."""
    holder = item.getParentGeoFeatureGroup()
    return holder.getGlobalPlacement() if holder is not None else FreeCAD.Placement()


def _pick(path: Path, document: Any, label: str | None, elsewhere: set[str]) -> Any:
    """The object that is asked for, or the only one that stands for itself; ``elsewhere`` names what links to other
    files."""
    empty = [item for item in document.Objects
             if item.Name in elsewhere and getattr(item, "LinkedObject", item) is None]
    candidates = [item for item in document.Objects if hasattr(item, "Shape") and item.Shape.Faces]
    if label is not None:
        named = [item for item in candidates if label in (item.Label, item.Name)]
        if not named:
            _refuse_links(path, [item for item in empty if label in (item.Label, item.Name)])
            known = ", ".join(f"'{item.Label}'" for item in candidates) or "none"
            raise InputError(f"{path} has no object '{label}' with faces; it has {known}.")
        return named[0]
    _refuse_links(path, empty)
    whole = [item for item in candidates if not any(hasattr(user, "Shape") for user in item.InList)]
    if not whole:
        raise InputError(f"{path} has no object with faces.")
    if len(whole) > 1:
        known = ", ".join(f"'{item.Label}'" for item in whole)
        raise InputError(f"{path} holds several objects: pick one with --object, of {known}.")
    return whole[0]


def _refuse_links(path: Path, links: list[Any]) -> None:
    """Say of links whose part lies in another file that they are not followed (InputError)."""
    if links:
        raise InputError(f"{path} links to another file in '{links[0].Label}', and such links are not followed: copy "
                         f"the linked part into this document, or pick another object with --object.")
