# SPDX-License-Identifier: LGPL-2.1-or-later
"""Face colours and visibility in FreeCAD documents: without a GUI, in the view providers' part of the file."""
from __future__ import annotations

import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ...compat import Colour, face_colours
from ...scan import xml_text

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
        root = xml_text.parse(archive.read(_GUI))
        provider = root.find(f".//ViewProvider[@name='{name}']")
        return () if provider is None else face_colours(provider, archive)


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
