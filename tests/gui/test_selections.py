# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts in parts, bodies and links are picked with the mouse and deformed where they stand; what cannot be used is grey
or gets a sentence.

The scan of the plate is an analytic bump of 1 mm with noise of 0.05 mm: the fitted top is known to no less.
"""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import pytest

from ffds_workbench.gui.commands.scan.align_scan import AlignScan
from ffds_workbench.gui.commands.deform.deform_faces import DeformFaces
from ffds_workbench.gui.commands.deform.deform_workpiece import DeformWorkpiece
from ffds_workbench.gui.commands.inspect.show_deviation import ShowDeviation
from ffds_workbench.gui.qt import QtWidgets
from ffds_workbench.gui.selection import face_at
from ffds_workbench.objects import scans

TOLERANCE = 0.05
PLACE = FreeCAD.Placement(FreeCAD.Vector(200, 50, 10), FreeCAD.Rotation(FreeCAD.Vector(0, 0, 1), 30))


def box(document, kind: str = "Part::Box", name: str = "Box"):
    item = document.addObject(kind, name)
    item.Length, item.Width, item.Height = 60, 40, 5
    return item


def nested(document):
    """A box in a part in a moved part."""
    outer, inner, item = (document.addObject("App::Part", "Outer"), document.addObject("App::Part", "Inner"),
                          box(document))
    inner.addObject(item)
    outer.addObject(inner)
    outer.Placement, inner.Placement.Base.z = PLACE, 7
    return item, PLACE.multiply(inner.Placement)


def body(document):
    """A box in a moved body."""
    holder = document.addObject("PartDesign::Body", "Body")
    holder.addObject(box(document, "PartDesign::AdditiveBox"))
    holder.Placement = PLACE
    return holder, PLACE


def link(document):
    """A link to a box that stands elsewhere."""
    item = document.addObject("App::Link", "Link")
    item.LinkedObject, item.Placement = box(document), PLACE
    return item, PLACE


def look_from_above(hands) -> None:
    view = Gui.ActiveDocument.ActiveView
    view.viewTop()
    view.fitAll()
    hands.at_rest()


@pytest.mark.parametrize("make", [nested, body, link])
def test_it_is_deformed_where_it_stands(hands, plate, make):
    document = FreeCAD.newDocument("Standing")
    item, place = make(document)
    matrix = np.array(place.toMatrix().A).reshape(4, 4)
    scan = scans.add_scan(document, np.loadtxt(plate[1]) @ matrix[:3, :3].T + matrix[:3, 3], "scan")
    document.recompute()
    scan.Visibility = False
    look_from_above(hands)
    hands.pick(tuple(place.multVec(FreeCAD.Vector(20, 12, 5))))
    hands.command(DeformFaces)
    hands.until(lambda: "after" in hands.says("FfdsFigures"), 20)
    hands.ok()
    made = document.getObject("AsBuilt")
    assert made.Source is item and made.isValid() and made.MeanAfter.Value < TOLERANCE
    holder = made.getParentGeoFeatureGroup()
    standing = made.Placement if holder is None else holder.getGlobalPlacement().multiply(made.Placement)
    assert (standing.Base - place.Base).Length < 1e-9 and standing.Rotation.isSame(place.Rotation, 1e-9)


def test_a_part_inside_a_link_is_refused(hands, plate_document):
    holder = plate_document.addObject("App::Part", "Holder")
    holder.addObject(plate_document.Plate)
    shown = plate_document.addObject("App::Link", "Again")
    shown.LinkedObject, shown.Placement = holder, PLACE
    plate_document.recompute()
    look_from_above(hands)
    hands.pick(tuple(PLACE.multVec(FreeCAD.Vector(20, 12, 5))))
    hands.command(DeformFaces)
    assert "through the link Again" in hands.find("FfdsMessageLabel").text()
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.until(lambda: not Gui.Control.activeDialog(), 5)


def an_edge(document):
    Gui.Selection.addSelection(document.Plate, "Edge3")


def two_parts(document):
    document.addObject("Part::Box", "Other")
    document.recompute()
    Gui.Selection.addSelection(document.Plate, "Face6")
    Gui.Selection.addSelection(document.Other, "Face6")


def a_mesh(document):
    Gui.Selection.addSelection(document.addObject("Mesh::Feature", "Mesh"))


def nothing(document):
    Gui.Selection.clearSelection()


def an_empty_cloud(document):
    document.removeObject("Scan")
    Gui.Selection.addSelection(document.Plate, "Face6")
    Gui.Selection.addSelection(document.addObject("Points::Feature", "Empty"))


def a_scan_far_away(document):
    document.Scan.Placement.Base.x = 10000
    Gui.Selection.addSelection(document.Plate, "Face6")
    Gui.Selection.addSelection(document.Scan)


def a_sketch(document):
    Gui.Selection.addSelection(document.addObject("Sketcher::SketchObject", "Sketch"))


@pytest.mark.parametrize("select", [two_parts, a_mesh, a_sketch])
def test_it_is_grey(hands, plate_document, select):
    select(plate_document)
    hands.wait(200)
    assert not any(command().IsActive() for command in (DeformFaces, DeformWorkpiece, AlignScan, ShowDeviation))


@pytest.mark.parametrize("select", [an_edge, nothing, an_empty_cloud, a_scan_far_away])
def test_it_gets_a_sentence_in_the_panel_and_in_a_dialog(hands, plate_document, select):
    select(plate_document)
    hands.wait(200)
    before = [item.Name for item in plate_document.Objects]
    hands.command(DeformFaces)
    hands.until(lambda: hands.says("FfdsMessageLabel"), 10)
    assert hands.says("FfdsMessageLabel").endswith(".")
    said = hands.answer(lambda dialog: dialog.accept())
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Ok))
    hands.until(lambda: said, 30)
    assert said[0].endswith(".") and "\n" not in said[0]
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.until(lambda: not Gui.Control.activeDialog(), 5)
    assert [item.Name for item in plate_document.Objects] == before and not plate_document.HasPendingTransaction


def test_a_deviation_map_of_an_empty_cloud_gets_a_sentence(hands, plate_document):
    an_empty_cloud(plate_document)
    hands.wait(200)
    said = hands.answer(lambda dialog: dialog.accept())
    hands.command(ShowDeviation)
    hands.until(lambda: said, 20)
    assert said[0].endswith(".") and not Gui.Control.activeDialog()


def test_the_face_below_a_scan_is_found_however_small_other_parts_are(hands):
    document = FreeCAD.newDocument("Sizes")
    washer = box(document, name="Washer")
    washer.Length, washer.Width, washer.Height, washer.Placement.Base = 6, 6, 1, FreeCAD.Vector(200, 0, 0)
    plate = box(document, name="Plate")
    document.recompute()
    # 2 mm above the plate of 72 mm: within a tenth of its size, which is more than a tenth of the washer's 8.5 mm.
    assert face_at(document, (30, 20, 7)) == (plate, "Face6")
    assert face_at(document, (203, 3, 3)) is None
