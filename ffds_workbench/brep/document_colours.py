# SPDX-License-Identifier: LGPL-2.1-or-later
"""Face colours and visibility in FreeCAD documents: without a GUI, in the view providers' part of the file."""
from __future__ import annotations

import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import numpy as np

Colour = tuple[float, float, float, float]
"""Red, green, blue and transparency, 0…1, as FreeCAD's DiffuseColor has them."""

_GUI = "GuiDocument.xml"
_TEMPLATE = """<?xml version='1.0' encoding='utf-8'?>
<Document SchemaVersion="1">
    <ViewProviderData Count="1">
        <ViewProvider name="{name}" expanded="0">
            <Properties Count="{count}" TransientCount="0">{colours}
                <Property name="Visibility" type="App::PropertyBool" status="1">
                    <Bool value="true"/>
                </Property>
            </Properties>
        </ViewProvider>
    </ViewProviderData>
    <Camera settings=""/>
</Document>
"""
_COLOURS = """
                <Property name="DiffuseColor" type="App::PropertyColorList" status="1">
                    <ColorList file="DiffuseColor"/>
                </Property>"""


def read(path: Path, name: str) -> tuple[Colour, ...]:
    """The face colours of the object ``name`` in a document file; empty where the file holds none."""
    with zipfile.ZipFile(path) as archive:
        if _GUI not in archive.namelist():
            return ()
        root = ElementTree.fromstring(archive.read(_GUI))
        provider = root.find(f".//ViewProvider[@name='{name}']")
        colours = None if provider is None else provider.find(".//Property[@name='DiffuseColor']/ColorList")
        file = "" if colours is None else colours.get("file", "")
        if file not in archive.namelist():
            return ()
        packed = np.frombuffer(archive.read(file), "<u4")
    if len(packed) < 2 or packed[0] != len(packed) - 1:
        return ()
    channels = packed[1:, None] >> np.array([24, 16, 8, 0], dtype=np.uint32) & 255
    return tuple(tuple(row) for row in (channels / 255.0).tolist())


def add_view(path: Path, name: str, colours: tuple[Colour, ...]) -> None:
    """Give the object ``name`` of a document without view data its face colours, if any, and make it visible.

    What a file without view data holds, FreeCAD's window opens hidden.
    """
    channels = np.rint(np.clip(np.reshape(colours, (-1, 4)), 0, 1) * 255).astype(np.uint32)
    packed = (channels << np.array([24, 16, 8, 0], dtype=np.uint32)).sum(axis=1, dtype=np.uint32)
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        shown = {"count": 2, "colours": _COLOURS} if colours else {"count": 1, "colours": ""}
        archive.writestr(_GUI, _TEMPLATE.format(name=name, **shown))
        if colours:
            archive.writestr("DiffuseColor", np.uint32(len(packed)).tobytes() + packed.astype("<u4").tobytes())
