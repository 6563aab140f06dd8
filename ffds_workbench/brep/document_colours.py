# SPDX-License-Identifier: LGPL-2.1-or-later
"""Face colours and visibility in FreeCAD documents: without a GUI, in the view providers' part of the file."""
from __future__ import annotations

import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

Colour = tuple[float, float, float, float]
"""Red, green, blue and transparency, 0…1, as FreeCAD's DiffuseColor has them."""

_GUI = "GuiDocument.xml"
_DOCUMENT = """<?xml version='1.0' encoding='utf-8'?>
<Document SchemaVersion="1">
    <ViewProviderData Count="{count}">{providers}
    </ViewProviderData>
    <Camera settings=""/>
</Document>
"""
_PROVIDER = """
        <ViewProvider name="{name}" expanded="0">
            <Properties Count="{count}" TransientCount="0">{colours}
                <Property name="Visibility" type="App::PropertyBool" status="1">
                    <Bool value="true"/>
                </Property>
            </Properties>
        </ViewProvider>"""
_COLOURS = """
                <Property name="DiffuseColor" type="App::PropertyColorList" status="1">
                    <ColorList file="{file}"/>
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


def add_views(path: Path, colours: Mapping[str, Sequence[Colour]]) -> None:
    """Give objects of a document without view data their face colours, if any, and make them visible.

    What a file without view data holds, FreeCAD's window opens hidden.

    Parameters
    ----------
    path : the document's file
    colours : by object name, one per face or none
    """
    providers = "".join(_PROVIDER.format(name=name, count=2 if faces else 1,
                                         colours=_COLOURS.format(file=_file(name)) if faces else "")
                        for name, faces in colours.items())
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(_GUI, _DOCUMENT.format(count=len(colours), providers=providers))
        for name, faces in colours.items():  # FreeCAD looks for these after the document that names them
            if faces:
                archive.writestr(_file(name), _packed(faces))


def _file(name: str) -> str:
    return f"{name}DiffuseColor"


def _packed(colours: Sequence[Colour]) -> bytes:
    channels = np.rint(np.clip(colours, 0, 1) * 255).astype("<u4")
    packed = (channels << np.array([24, 16, 8, 0], dtype=np.uint32)).sum(axis=1)
    return np.concatenate([[len(packed)], packed]).astype("<u4").tobytes()
