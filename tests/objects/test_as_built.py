# SPDX-License-Identifier: LGPL-2.1-or-later
"""The as-built object without a GUI: it follows its inputs, survives a file, and refuses without a trace.

The scans are sampled from analytic surfaces; what a result deviates from them is bounded by their noise of 0.02 mm.
"""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.api import certified
from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.objects import actions, scans
from ffds_workbench.objects.as_built import lattices_of, report_of
from ffds_workbench.scan.cloud import PointCloud

NOISE = 0.02


@pytest.fixture(autouse=True)
def short_check(monkeypatch):
    """The check for Boolean operations, which only goes into the report, may take seconds; it is tested elsewhere."""
    monkeypatch.setattr(certified, "BOOLEAN_CHECK_SECONDS", 0.05)


@pytest.fixture
def document():
    created = FreeCAD.newDocument("as_built_test")
    created.UndoMode = 1
    yield created
    FreeCAD.closeDocument(created.Name)


def bump(x: np.ndarray, y: np.ndarray, height: float) -> np.ndarray:
    return height * np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2))


def plate_scan(height: float, count: int = 5000) -> np.ndarray:
    random = np.random.default_rng(1)
    x, y = random.uniform((0, 0), (60, 40), (count, 2)).T
    return np.stack([x, y, 5 + bump(x, y, height) + random.normal(0, NOISE, count)], axis=1)


def add_plate(document, height: float = 1.0):
    plate = document.addObject("Part::Box", "Plate")
    plate.Length, plate.Width, plate.Height = 60, 40, 5
    document.recompute()
    return plate, scans.add_scan(document, plate_scan(height), "scan")


def height_at_middle(shape: Part.Shape) -> float:
    return shape.distToShape(Part.Vertex(30, 20, 20))[0]


def test_the_face_takes_the_shape_of_the_scan_and_the_document_says_so(document):
    plate, scan = add_plate(document)
    item = actions.make_as_built(plate, scan, faces=["Face6"])
    assert item.isValid() and item.Shape.isValid() and len(item.Shape.Faces) == 6
    assert height_at_middle(item.Shape) == pytest.approx(20 - 6, abs=NOISE)
    assert item.MeanBefore.Value > 0.2 and item.MeanAfter.Value < NOISE
    assert not plate.Visibility and item.Source is plate
    lattice = lattices_of(item)[0]
    assert np.abs(lattice.nominal[..., 2] - 5).max() < 1e-5
    assert 0.5 < (lattice.deformed - lattice.nominal)[..., 2].max() < 1.5
    assert report_of(item)["topology"]["order_kept"]


def test_it_follows_the_scan_and_keeps_its_last_shape_when_that_fails(document):
    plate, scan = add_plate(document)
    item = actions.make_as_built(plate, scan, faces=["Face6"], lattice=(8, 8))
    scans.set_points(scan, plate_scan(2.0))
    document.recompute()
    assert height_at_middle(item.Shape) == pytest.approx(20 - 7, abs=2 * NOISE)
    scans.set_points(scan, plate_scan(2.0) + [0, 0, 10000])
    document.recompute()
    assert not item.isValid() and "do not overlap" in item.getStatusString()
    assert height_at_middle(item.Shape) == pytest.approx(20 - 7, abs=2 * NOISE)
    scans.set_points(scan, plate_scan(1.0))
    document.recompute()
    assert item.isValid() and height_at_middle(item.Shape) == pytest.approx(20 - 6, abs=NOISE)


def test_a_file_brings_it_back_whole(document, tmp_path):
    plate, scan = add_plate(document)
    item = actions.make_as_built(plate, scan, faces=["Face6"], freeze=["Face1"], lattice=(7, 9))
    volume = item.Shape.Volume
    document.saveCopy(str(tmp_path / "plate.FCStd"))
    again = FreeCAD.openDocument(str(tmp_path / "plate.FCStd"), True)
    try:
        copy = again.getObject(item.Name)
        assert copy.Shape.Volume == pytest.approx(volume, rel=1e-12)
        assert (copy.ControlPointsU, copy.ControlPointsV) == (7, 9) and copy.Freeze[0][1] == ("Face1",)
        again.getObject(scan.Name).touch()
        again.recompute()
        assert copy.isValid() and copy.Shape.Volume == pytest.approx(volume, rel=1e-9)
    finally:
        FreeCAD.closeDocument(again.Name)


def test_a_part_in_a_moved_group_gets_its_as_built_one_beside_it(document):
    plate, scan = add_plate(document)
    group = document.addObject("App::Part", "Group")
    group.addObject(plate)
    group.Placement = FreeCAD.Placement(FreeCAD.Vector(100, -50, 20), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))
    plate.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 5, 0), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 90))
    document.recompute()
    standing = np.array(plate.getGlobalPlacement().toMatrix().A).reshape(4, 4)
    scans.set_points(scan, plate_scan(1.0) @ standing[:3, :3].T + standing[:3, 3])
    item = actions.make_as_built(plate, scan, faces=["Face6"])
    assert item.getParentGeoFeatureGroup() is group and item.Placement == plate.Placement
    own = item.Shape.copy()
    own.Placement = FreeCAD.Placement()
    assert height_at_middle(own) == pytest.approx(20 - 6, abs=NOISE)


def test_a_face_is_found_again_when_the_part_gets_other_numbers(document):
    plate, scan = add_plate(document)
    corner = document.addObject("Part::Box", "Corner")
    corner.Length = corner.Width = corner.Height = 3
    corner.Placement.Base = FreeCAD.Vector(-10, 0, 0)
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = plate, corner
    document.recompute()
    top = next(f"Face{k}" for k, face in enumerate(cut.Shape.Faces, 1) if face.CenterOfMass.z > 4.9)
    item = actions.make_as_built(cut, scan, faces=[top], lattice=(8, 8))
    document.openTransaction("other numbers")
    corner.Placement.Base = FreeCAD.Vector(-1, 38, -1)
    document.recompute()
    document.commitTransaction()
    assert len(cut.Shape.Faces) == 9 and item.isValid()
    found = cut.Shape.getElement(item.Faces[0][1][0])
    assert found.CenterOfMass.z == pytest.approx(5) and len(item.Faces[0][1]) == 1
    assert item.Faces[0][1][0] != top, "the numbers did change"
    assert height_at_middle(item.Shape) == pytest.approx(20 - 6, abs=NOISE)
    corner.Placement.Base, corner.Length, corner.Width = FreeCAD.Vector(-1, -1, 3), 80, 80
    document.recompute()
    assert not item.isValid() and "choose the faces anew" in item.getStatusString()


def test_a_link_is_a_part_of_its_own(document):
    plate, scan = add_plate(document)
    link = document.addObject("App::Link", "Link")
    link.LinkedObject = plate
    link.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 0, 200), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 30))
    document.recompute()
    standing = np.array(link.Placement.toMatrix().A).reshape(4, 4)
    scans.set_points(scan, plate_scan(1.0) @ standing[:3, :3].T + standing[:3, 3])
    item = actions.make_as_built(link, scan, faces=["Face6"])
    assert (item.Placement.Base - link.Placement.Base).Length < 1e-9 and plate.Visibility
    own = item.Shape.copy()
    own.Placement = FreeCAD.Placement()
    assert height_at_middle(own) == pytest.approx(20 - 6, abs=NOISE)


def test_a_body_stands_for_its_tip(document):
    pytest.importorskip("PartDesign", reason="FreeCAD's own Python modules are on the path inside FreeCAD only")
    body = document.addObject("PartDesign::Body", "Body")
    box = document.addObject("PartDesign::AdditiveBox", "Box")
    body.addObject(box)
    box.Length, box.Width, box.Height = 60, 40, 5
    document.recompute()
    scan = scans.add_scan(document, plate_scan(1.0), "scan")
    item = actions.make_as_built(box, scan, faces=["Face6"])
    assert item.Source is body and item not in body.Group and len(item.Shape.Faces) == 6


def _no_scan(document):
    plate, _ = add_plate(document)
    return plate, plate


def _empty_scan(document):
    plate, _ = add_plate(document)
    return plate, document.addObject("Points::Feature", "Empty")


def _far_scan(document):
    plate, scan = add_plate(document)
    scan.Placement.Base.x = 10000
    return plate, scan


def _mesh(document):
    _, scan = add_plate(document)
    return document.addObject("Mesh::Feature", "Mesh"), scan


def _sketch(document):
    _, scan = add_plate(document)
    return document.addObject("Sketcher::SketchObject", "Sketch"), scan


@pytest.mark.parametrize("make", [_no_scan, _empty_scan, _far_scan, _mesh, _sketch])
def test_what_cannot_be_used_is_refused_with_a_sentence_and_leaves_nothing(document, make):
    source, scan = make(document)
    before = [item.Name for item in document.Objects]
    with pytest.raises((InputError, RefusedError)) as refusal:
        actions.make_as_built(source, scan)
    assert str(refusal.value).endswith(".") and "\n" not in str(refusal.value)
    assert [item.Name for item in document.Objects] == before and source.Visibility


def test_in_place_is_for_plain_shapes(document):
    plate, scan = add_plate(document)
    with pytest.raises(InputError, match="simple copy"):
        actions.replace_in_place(plate, scan, faces=["Face6"])
    copy = document.addObject("Part::Feature", "Copy")
    copy.Shape = plate.Shape
    document.openTransaction("in place")
    actions.replace_in_place(copy, scan, faces=["Face6"])
    document.commitTransaction()
    assert height_at_middle(copy.Shape) == pytest.approx(20 - 6, abs=NOISE)
    document.undo()
    assert height_at_middle(copy.Shape) == pytest.approx(20 - 5, abs=1e-7)


def test_one_undo_takes_it_back_and_redo_brings_it(document):
    plate, scan = add_plate(document)
    document.openTransaction("as built")
    actions.make_as_built(plate, scan, faces=["Face6"])
    document.commitTransaction()
    document.undo()
    assert [item.Name for item in document.Objects] == [plate.Name, scan.Name] and plate.Visibility
    document.redo()
    assert len(document.Objects) == 3 and not plate.Visibility
    assert height_at_middle(document.Objects[2].Shape) == pytest.approx(20 - 6, abs=NOISE)


def test_far_scans_keep_their_precision(document):
    points = np.random.default_rng(2).uniform(0, 10, (1000, 3)) + [123456.0, -98765.0, 5000.0]
    item = scans.add_scan(document, points, "far")
    assert np.abs(scans.scan_points(item) - points).max() < 1e-6  # float32 holds 10 mm to 1e-6 mm


def test_a_replaced_scan_takes_the_part_along_and_is_known_beforehand(document, tmp_path):
    plate, scan = add_plate(document)
    item = actions.make_as_built(plate, scan, faces=["Face6"], lattice=(8, 8))
    group = document.addObject("App::Part", "Group")
    group.addObject(scan)
    for shift in (0.0, 5000.0):
        group.Placement.Base.x = -shift
        np.savetxt(tmp_path / "second.xyz", plate_scan(2.0) + [shift, 0, 0])
        expected = scans.as_stored(scan, PointCloud(np.loadtxt(tmp_path / "second.xyz"))).points
        actions.replace_scan(scan, str(tmp_path / "second.xyz"))
        assert scan.Label == "second" and np.array_equal(scans.scan_points(scan), expected)
        assert height_at_middle(item.Shape) == pytest.approx(20 - 7, abs=2 * NOISE)


def test_the_example_and_the_export(document, tmp_path):
    part, scan = actions.load_example(document)
    assert len(scans.scan_points(scan)) > 50000
    actions.export_as_built(part, str(tmp_path / "bracket.step"))
    assert len(Part.read(str(tmp_path / "bracket.step")).Faces) == len(part.Shape.Faces)
    with pytest.raises(InputError):
        actions.export_as_built(part, str(tmp_path / "bracket.obj"))


def test_a_simulated_scan_lies_on_the_part_where_it_stands(document):
    plate, _ = add_plate(document)
    plate.Placement.Base.x = 500
    item = actions.simulate_scan(plate, spacing=1.0, noise=0.0)
    points = scans.scan_points(item)
    assert points[:, 0].min() > 499.99 and points[:, 0].max() < 560.01


def test_alignment_moves_the_scan_onto_the_part(document):
    part, scan = actions.load_example(document)
    found = scans.scan_points(scan)
    turn = FreeCAD.Placement(FreeCAD.Vector(3, -2, 1), FreeCAD.Rotation(FreeCAD.Vector(1, 1, 0), 4))
    scan.Placement = turn
    actions.align_scan(part, scan, "fine")
    # The scan shows a part that is up to 2 mm out of shape: the rigid pose is known to about as much.
    assert np.linalg.norm(scans.scan_points(scan) - found, axis=1).mean() < 1.0
