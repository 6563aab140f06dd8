# SPDX-License-Identifier: LGPL-2.1-or-later
"""What FreeCAD 0.20 and 1.0 do in different ways is read and written alike."""
from __future__ import annotations

import zipfile

import FreeCAD
import Part
import pytest

from ffds_workbench import compat
from ffds_workbench.brep.model_files import document_colours, model_file

_PROVIDER = """<?xml version='1.0' encoding='utf-8'?>
<Document SchemaVersion="1"><ViewProviderData Count="1"><ViewProvider name="Box"><Properties Count="1">
<Property name="{name}" type="App::Property{kind}" status="1"><{kind} file="Colours" version="3"/></Property>
</Properties></ViewProvider></ViewProviderData></Document>"""
_BY_1_0 = bytes.fromhex(
    "02000000" "ff555555ff0000ffff888888ff0000006666663f00000000" "ff555555ff996633ff888888ff0000006666663f0000003f"
    "0000000000000000" "24000000" + b"7f9fd73b-50c9-41d8-b7b2-575a030c1eeb".hex())
"""Two materials as FreeCAD 1.0 wrote them, red and (0.2, 0.4, 0.6) half transparent, and the name of a texture."""
_BY_0_20 = bytes.fromhex("02000000" "000000ff" "7f996633")
COLOURS = [(1.0, 0.0, 0.0, 0.0), (0.2, 0.4, 0.6, 0.5)]


@pytest.mark.parametrize(("name", "kind", "content"), [("ShapeAppearance", "MaterialList", _BY_1_0),
                                                       ("DiffuseColor", "ColorList", _BY_0_20)])
def test_face_colours_of_either_version_are_read(tmp_path, name, kind, content):
    path = tmp_path / "part.FCStd"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("GuiDocument.xml", _PROVIDER.format(name=name, kind=kind))
        archive.writestr("Colours", content)
    read = document_colours.read(path, "Box")
    assert [pytest.approx(colour, abs=1 / 255) for colour in read] == COLOURS
    assert document_colours.read(path, "Sphere") == ()


@pytest.mark.parametrize("content", [b"", _BY_1_0[:20], b"\xff" * 30])
def test_damaged_colours_are_no_colours(tmp_path, content):
    path = tmp_path / "part.FCStd"
    for name, kind in (("ShapeAppearance", "MaterialList"), ("DiffuseColor", "ColorList")):
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("GuiDocument.xml", _PROVIDER.format(name=name, kind=kind))
            archive.writestr("Colours", content)
        assert document_colours.read(path, "Box") == ()


def test_step_files_have_the_edges_in_their_faces_parameters(tmp_path):
    """A user who has them left out gets them from FFDS all the same, and his own files as before."""
    group = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Part/General")
    plate = model_file.Model(Part.makeBox(1, 2, 3).toNurbs(), "Plate")
    group.SetInt("WriteSurfaceCurveMode", 0)
    try:
        for name in ("first.step", "second.step"):
            model_file.write(plate, tmp_path / name)
            assert "PCURVE(" in (tmp_path / name).read_text("utf-8")
        plate.shape.exportStep(str(tmp_path / "own.step"))
        assert "PCURVE(" not in (tmp_path / "own.step").read_text("utf-8")
    finally:
        group.RemInt("WriteSurfaceCurveMode")
        compat.write_step(plate.shape, tmp_path / "last.step")


def test_a_seam_stands_twice_in_its_wire():
    """Once each way: FreeCAD 1.0 lists it once, and the way it does changes as the shape goes through a file."""
    face = Part.makeCylinder(3, 5).Faces[0]
    wire, = face.Wires
    seam = [edge for edge in compat.stored_edges(wire, face) if edge.isSeam(face)]
    assert len(compat.stored_edges(wire, face)) == 4 and len(seam) == 2 and seam[0].isSame(seam[1])
    assert {edge.Orientation for edge in seam} == {"Forward", "Reversed"}
