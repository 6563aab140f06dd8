# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where FreeCAD 0.20 and 1.0 differ, and Qt 5 and 6: no other module knows which one it runs in. Loads neither of them
before it is needed.
"""
from __future__ import annotations

import importlib
import zipfile
from functools import lru_cache
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

Colour = tuple[float, float, float, float]
"""Red, green, blue and transparency, 0…1, as FreeCAD's DiffuseColor has them."""

_MATERIAL = np.dtype([("ambient", "<u4"), ("diffuse", "<u4"), ("specular", "<u4"), ("emissive", "<u4"),
                      ("shininess", "<f4"), ("transparency", "<f4")])


def qt(module: str) -> Any:
    """A module of Qt, "QtCore" for instance, of the Qt that this FreeCAD's own ``PySide`` hands out.

    QtGui holds what Qt 5 has among the widgets, too.
    """
    binding = importlib.import_module("PySide.QtCore").QObject.__module__.partition(".")[0]  # "PySide2" or "PySide6"
    return importlib.import_module("PySide.QtGui" if module == "QtGui" else f"{binding}.{module}")


def freecad_version() -> str:
    """Major, minor and patch of the FreeCAD that runs, "1.1.3" for instance."""
    import FreeCAD

    return ".".join(FreeCAD.Version()[:3])


def stored_edges(wire: Any, face: Any) -> list[Any]:
    """The edges of a face's wire, in the order and with the orientation in which it holds them; a seam stands there
    twice, which FreeCAD 1.0 and later list once."""
    edges = wire.childShapes(False, True)
    if not _lists_seams_once() or not any(edge.isSeam(face) for edge in edges):
        return edges
    # A face cut out of a closed one may call seam what it meets once: only the text of the wire tells how often.
    text = wire.exportBrepToString()
    children = text[text.rindex("\nWi\n"):].split("*")[0].split()[2:]
    uses = [(use[0], use[1:], location) for use, location in zip(children[::2], children[1::2], strict=True)]
    by_number = dict(zip(dict.fromkeys(use[1:] for use in uses), edges, strict=True))
    listed = {"+": "Forward", "-": "Reversed"}
    return [edge if listed.get(sign, edge.Orientation) == edge.Orientation else edge.reversed()
            for sign, edge in ((sign, by_number[number, location]) for sign, number, location in uses)]


@lru_cache(maxsize=None)
def _lists_seams_once() -> bool:
    import Part

    return len(Part.makeCylinder(1.0, 1.0).Faces[0].Wires[0].childShapes(False, True)) == 3


def execute(loop_or_dialog: Any) -> int:
    """Run a dialog or an event loop until it ends: ``exec_`` in Qt 5, ``exec`` in Qt 6."""
    run = getattr(loop_or_dialog, "exec", None) or loop_or_dialog.exec_
    return run()


def number_of(flags: Any) -> int:
    """Flags of Qt as the number that FreeCAD wants; those of Qt 6 do not convert by themselves."""
    return flags.value if hasattr(flags, "value") else int(flags)


def shortcut(key: Any, window: Any) -> Any:
    """A QShortcut."""
    gui = qt("QtGui")
    return gui.QShortcut(gui.QKeySequence(key), window)


class Stateless:
    """Base of what FreeCAD holds as a proxy, where everything that has to be saved is in properties.

    FreeCAD before 0.21 asks for ``__getstate__`` and ``__setstate__``, later ones for ``dumps`` and ``loads``.
    """

    def dumps(self) -> None:
        """Nothing to save."""

    def loads(self, state: object) -> None:
        """Nothing to restore."""

    __getstate__ = dumps
    __setstate__ = loads


def write_step(shape: Any, path: Path) -> None:
    """Write a STEP file with the curves of the edges in their faces' parameters, which FreeCAD 1.0 leaves out unasked.

    Without them readers project the edges anew: seams get lost and tolerances do not hold.
    """
    import FreeCAD
    import Part

    wished = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Part/General").GetInt(
        "WriteSurfaceCurveMode", 1 if FreeCAD.Version()[0] == "0" else 0)
    Part.setStaticValue("write.surfacecurve.mode", 1)
    try:
        shape.exportStep(str(path))
    finally:
        Part.setStaticValue("write.surfacecurve.mode", wished)


def face_colours(provider: Element, archive: zipfile.ZipFile) -> tuple[Colour, ...]:
    """The face colours that a document file has for one view provider; empty where it has none.

    FreeCAD 0.20 writes them as ``DiffuseColor``, a list of packed colours, 1.0 as ``ShapeAppearance``, a list of
    materials with their textures behind it.
    """
    for name, kind, unpack in (("ShapeAppearance", "MaterialList", _of_materials),
                               ("DiffuseColor", "ColorList", _of_packed)):
        holder = provider.find(f".//Property[@name='{name}']/{kind}")
        file = "" if holder is None else holder.get("file", "")
        if file in archive.namelist():
            return unpack(archive.read(file))
    return ()


def _of_packed(content: bytes) -> tuple[Colour, ...]:
    count = _count(content)
    if not count or len(content) != 4 + 4 * count:
        return ()
    return _colours(np.frombuffer(content, "<u4", count, 4))


def _of_materials(content: bytes) -> tuple[Colour, ...]:
    count = _count(content)
    if not count or len(content) < 4 + _MATERIAL.itemsize * count:
        return ()
    materials = np.frombuffer(content, _MATERIAL, count, 4)
    return tuple((red, green, blue, float(transparency)) for (red, green, blue, _), transparency in
                 zip(_colours(materials["diffuse"]), materials["transparency"], strict=True))


def _count(content: bytes) -> int:
    return int.from_bytes(content[:4], "little")


def _colours(packed: np.ndarray) -> tuple[Colour, ...]:
    channels = packed[:, None] >> np.array([24, 16, 8, 0], dtype=np.uint32) & 255
    return tuple((red, green, blue, other) for red, green, blue, other in (channels / 255.0).tolist())
