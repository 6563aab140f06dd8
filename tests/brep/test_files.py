# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model files: what survives reading and writing, and what is refused."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.brep.model_files import model_file
from ffds_workbench.brep.model_files.step_colours import Decoration
from ffds_workbench.errors import InputError

COLOUR_STEP = 1 / 255


def _placement() -> FreeCAD.Placement:
    return FreeCAD.Placement(FreeCAD.Vector(5, 6, 7), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))


def _shape() -> Part.Shape:
    box = Part.makeBox(10, 20, 30)
    box.Placement = _placement()
    return Part.makeCompound([box, Part.makeCone(2, 0, 3, FreeCAD.Vector(60, 0, 0)), Part.makeCylinder(1, 2)])


def _colours(count: int) -> tuple[tuple[float, float, float, float], ...]:
    return tuple((i / count, 0.5, 1 - i / count, 0.0) for i in range(count))


def _same_faces(first: Part.Shape, second: Part.Shape) -> None:
    assert len(first.Faces) == len(second.Faces)
    for one, other in zip(first.Faces, second.Faces, strict=True):
        assert (one.CenterOfMass - other.CenterOfMass).Length < 1e-5  # STEP and IGES hold six to fifteen digits
        assert one.Area == pytest.approx(other.Area, rel=1e-6)


@pytest.mark.parametrize("suffix", [".step", ".stp", ".brep", ".FCStd"])
def test_faces_come_back_in_order_where_they_were(tmp_path, suffix):
    shape = _shape()
    model_file.write(model_file.Model(shape, "Part"), tmp_path / f"m{suffix}")
    copy = model_file.read(tmp_path / f"m{suffix}").shape
    _same_faces(copy, shape)
    assert copy.isValid() and len(copy.Solids) == 3


def test_iges_is_read(tmp_path):
    Part.makeBox(10, 20, 30).exportIges(str(tmp_path / "m.iges"))
    assert len(model_file.read(tmp_path / "m.iges").shape.Faces) == 6


@pytest.mark.parametrize("suffix", [".step", ".FCStd"])
def test_name_and_colours_survive(tmp_path, suffix):
    shape = _shape()
    colours = _colours(len(shape.Faces))
    model_file.write(model_file.Model(shape, "Träger 'A'; #5", Decoration(colours=colours)), tmp_path / f"m{suffix}")
    copy = model_file.read(tmp_path / f"m{suffix}")
    assert copy.label == "Träger 'A'; #5"
    np.testing.assert_allclose(copy.decoration.colours, colours, atol=0.51 * COLOUR_STEP)


def test_names_of_solids_and_faces_survive_in_step(tmp_path):
    shape = _shape()
    names = Decoration(solids=("box", "Kugel ü", "pin"), faces=tuple(f"f{i}" for i in range(len(shape.Faces))))
    model_file.write(model_file.Model(shape, "Part", names), tmp_path / "m.step")
    copy = model_file.read(tmp_path / "m.step").decoration
    assert copy.solids == names.solids and copy.faces == names.faces


def test_one_colour_for_all(tmp_path):
    red = Decoration(colours=((1.0, 0.0, 0.0, 0.0),))
    model_file.write(model_file.Model(Part.makeBox(1, 2, 3), "Box", red), tmp_path / "m.step")
    assert set(model_file.read(tmp_path / "m.step").decoration.colours) == {(1.0, 0.0, 0.0, 0.0)}


def test_colours_without_a_match_are_left_out(tmp_path):
    shape = Part.makeCompound([Part.makeBox(1, 2, 3), Part.makePlane(1, 1, FreeCAD.Vector(9, 0, 0))])
    model_file.write(model_file.Model(shape, "Mixed", Decoration(colours=_colours(3))), tmp_path / "m.step")
    assert model_file.read(tmp_path / "m.step").decoration.colours == ()


@pytest.fixture
def document(tmp_path):
    """Two objects, the second inside a placed App::Part."""
    made = FreeCAD.newDocument("Source", hidden=True, temp=True)
    made.addObject("Part::Box", "Box").Label = "Block"
    group = made.addObject("App::Part", "Assembly")
    group.Placement = _placement()
    pin = made.addObject("Part::Cylinder", "Pin")
    pin.Placement.Base = FreeCAD.Vector(1, 0, 0)
    group.addObject(pin)
    made.recompute()
    made.saveAs(str(tmp_path / "two.FCStd"))
    yield made, tmp_path / "two.FCStd"
    FreeCAD.closeDocument(made.Name)


def test_an_object_is_picked_by_label_or_name(document):
    _, path = document
    assert len(model_file.read(path, "Block").shape.Faces) == 6
    assert len(model_file.read(path, "Box").shape.Faces) == 6
    assert len(model_file.read(path, "Pin").shape.Faces) == 3
    with pytest.raises(InputError, match="several objects.*'Block'"):
        model_file.read(path)
    with pytest.raises(InputError, match="no object 'Wheel'"):
        model_file.read(path, "Wheel")


def test_an_object_is_taken_where_it_stands(document):
    made, path = document
    centre = _placement().multVec(FreeCAD.Vector(1, 0, 5))
    for model in (model_file.read(path, "Pin"), model_file.from_object(made.Pin)):
        assert (model.shape.CenterOfMass - centre).Length < 1e-9
    assert model_file.from_object(made.Pin).label == "Pin"


def test_no_open_document_is_left_or_touched(document):
    _, path = document
    before = set(FreeCAD.listDocuments())
    content = path.read_bytes()
    model_file.read(path, "Pin")
    model_file.write(model_file.Model(_shape(), "Part"), path.with_name("other.FCStd"))
    assert set(FreeCAD.listDocuments()) == before and path.read_bytes() == content


def test_an_edited_face_of_a_placed_object_keeps_the_placement(tmp_path):
    box = Part.makeBox(10, 20, 30)
    box.Placement = _placement()
    model_file.write(model_file.Model(box, "Box"), tmp_path / "m.FCStd")
    made = FreeCAD.openDocument(str(tmp_path / "m.FCStd"), hidden=True)
    try:
        np.testing.assert_allclose(made.Objects[0].Placement.toMatrix().A, _placement().toMatrix().A, atol=1e-12)
    finally:
        FreeCAD.closeDocument(made.Name)


def test_shapes_that_cannot_be_used_are_refused():
    with pytest.raises(InputError, match="no shape"):
        model_file.from_object(Part.Shape())
    with pytest.raises(InputError, match="no faces"):
        model_file.from_object(Part.makeLine((0, 0, 0), (1, 0, 0)))


def test_shared_parts_keep_their_faces_through_step(shared_data, tmp_path):
    for name in ("screw.step", "sliced_cylinder.step", "revolved_sphere.step"):
        model = model_file.read(shared_data / "parts" / name)
        model_file.write(model, tmp_path / name)
        _same_faces(model_file.read(tmp_path / name).shape, model.shape)
