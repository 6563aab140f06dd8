# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the panel of the deformation does with clicks, keys, scans and results that a first user tries on it."""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import Part
import pytest

from ffds_workbench.compat import qt
from ffds_workbench.gui.commands import COMMANDS
from ffds_workbench.gui.commands.deform.deform_faces import DeformFaces
from ffds_workbench.gui.commands.deform.deform_workpiece import DeformWorkpiece
from ffds_workbench.gui.commands.learn.load_example import LoadExample
from ffds_workbench.gui.qt import QtCore, QtWidgets
from ffds_workbench.objects import scans

QtTest = qt("QtTest")

THICKNESS, NOISE = 3.0, 0.1
UPRIGHT = (25.0, 0.0, 20.0)
"""Seen on the example's upright face, which its scan shows."""


def previewed(hands) -> None:
    """Wait for the preview that is drawn when nothing moves any more."""
    hands.until(lambda: "after" in hands.says("FfdsFigures"))
    hands.wait(600)
    hands.until(lambda: not hands.says("FfdsDoing"))


def deform(hands, document, face: str = "Face6") -> object:
    """Deform a face of the plate by the panel; what is made."""
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(document.Plate, face)
    hands.command(DeformFaces)
    previewed(hands)
    hands.ok()
    return document.Objects[-1]


def test_a_click_goes_through_the_scan_to_the_face_that_it_shows(hands):
    hands.command(LoadExample)
    document = FreeCAD.ActiveDocument
    document.Scan.Visibility = False
    hands.wait(200)
    hands.pick(UPRIGHT)
    assert Gui.Selection.getSelectionEx()[0].SubElementNames == ("Face9",)  # this is where the face is seen
    Gui.Selection.clearSelection()
    document.Scan.Visibility = True
    hands.command(DeformFaces)
    hands.pick(UPRIGHT)
    assert hands.says("FfdsPart") == "<b>Bracket</b> Face9"
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.until(lambda: not Gui.Control.activeDialog())
    hands.pick(UPRIGHT)
    assert [item.Name for item in Gui.Selection.getSelection()] == ["Scan"]  # as before the panel


@pytest.fixture
def sheet(hands):
    """A sheet, and a scan of its upper side, which sags: the lower one would have to be pulled through the sheet."""
    document = FreeCAD.newDocument("Sheet")
    part = document.addObject("Part::Feature", "Sheet")
    part.Shape = Part.makeBox(80, 50, THICKNESS)
    x, y = np.random.default_rng(1).uniform((0, 0), (80, 50), (8000, 2)).T
    z = THICKNESS - 0.5 * np.sin(np.pi * x / 80) + np.random.default_rng(2).normal(0, NOISE, 8000)
    scans.add_scan(document, np.stack([x, y, z], axis=1), "Scan")
    hands.wait(200)
    return document


def test_the_side_that_the_scan_does_not_show_is_warned_of_in_the_preview(hands, sheet):
    Gui.Selection.addSelection(sheet.Sheet, "Face5")  # below
    hands.command(DeformFaces)
    hands.until(lambda: "The scan shows Face6" in hands.says("FfdsMessageLabel"))
    assert not hands.says("FfdsFigures")
    assert hands.says("FfdsOtherSide") == "Take Face6 instead" and hands.drawn() != b"[]"  # both sides are marked
    hands.screenshot("other_side")
    hands.click(hands.find("FfdsOtherSide"))
    previewed(hands)
    assert hands.says("FfdsPart") == "<b>Sheet</b> Face6" and not hands.says("FfdsOtherSide")
    hands.ok()
    assert sheet.AsBuilt.Faces[0][1] == ("Face6",)


def test_a_box_picks_the_side_that_the_scan_shows(hands, sheet):
    Gui.ActiveDocument.ActiveView.viewIsometric()
    Gui.ActiveDocument.ActiveView.fitAll()
    hands.command(DeformFaces)
    hands.click(hands.find("FfdsPickBox"))
    viewport = Gui.ActiveDocument.ActiveView.graphicsView().viewport()
    ends = QtCore.QPoint(5, 5), QtCore.QPoint(viewport.width() - 5, viewport.height() - 5)
    QtTest.QTest.mousePress(viewport, QtCore.Qt.LeftButton, QtCore.Qt.NoModifier, ends[0], 10)
    QtTest.QTest.mouseMove(viewport, ends[1])
    QtTest.QTest.mouseRelease(viewport, QtCore.Qt.LeftButton, QtCore.Qt.NoModifier, ends[1], 10)
    hands.wait(200)
    assert hands.says("FfdsPart") == "<b>Sheet</b> Face6"


def test_figures_and_colours_of_another_scan_go_at_once(hands, sheet):
    far = scans.add_scan(sheet, np.random.default_rng(0).uniform(500, 560, (2000, 3)), "Elsewhere")
    Gui.Selection.addSelection(sheet.Sheet, "Face6")
    Gui.Selection.addSelection(sheet.Scan)
    hands.command(DeformWorkpiece)
    previewed(hands)
    shown = hands.drawn()
    box = hands.find("FfdsScan", QtWidgets.QComboBox)
    box.setCurrentIndex(box.findData(far.Name))
    assert not hands.says("FfdsFigures") and hands.drawn() != shown  # before anything is computed
    hands.until(lambda: "not overlap" in hands.says("FfdsMessageLabel") or "does not" in hands.says("FfdsMessageLabel"))


def test_enter_ends_the_editing_of_a_number_and_esc_closes_the_panel_from_anywhere(hands, plate_document):
    Gui.Selection.addSelection(plate_document.Plate, "Face6")
    hands.command(DeformFaces)
    previewed(hands)
    hands.check("FfdsAutomatic")
    box = hands.find("FfdsControlPointsU")
    box.setFocus()
    box.selectAll()
    QtTest.QTest.keyClicks(box, "7")
    QtTest.QTest.keyClick(box, QtCore.Qt.Key_Return)
    hands.wait(500)
    assert Gui.Control.activeDialog() and box.value() == 7 and len(plate_document.Objects) == 2
    Gui.getMainWindow().activateWindow()
    window = Gui.ActiveDocument.ActiveView.graphicsView()
    window.viewport().setFocus()
    QtTest.QTest.keyClick(window.viewport(), QtCore.Qt.Key_Escape)
    hands.until(lambda: not Gui.Control.activeDialog(), 5)
    assert len(plate_document.Objects) == 2


def test_the_result_is_selected_its_commands_are_live_and_nothing_is_left_to_recompute(hands, plate_document):
    made = deform(hands, plate_document)
    hands.until(lambda: hands.says("FfdsVerdict"), 5)
    assert Gui.Selection.getSelection() == [made]
    live = {command.NAME for command in COMMANDS if command().IsActive()}
    assert {"FFDS_ShowDeviation", "FFDS_ShowLattice", "FFDS_ExportAsBuilt", "FFDS_FindSeams"} <= live
    assert not [item.Name for item in plate_document.Objects if "Touched" in item.State]


def test_a_second_result_hides_the_first_and_a_pick_on_one_means_its_nominal_part(hands, plate_document):
    first, second = deform(hands, plate_document), deform(hands, plate_document)
    assert (first.Visibility, second.Visibility, plate_document.Plate.Visibility) == (False, True, False)
    Gui.Selection.clearSelection()
    hands.command(DeformFaces)
    Gui.Selection.addSelection(second, "Face6")
    previewed(hands)
    assert hands.says("FfdsPart") == "<b>Plate</b> Face6"
    assert "is a result: its nominal part Plate is deformed anew" in hands.says("FfdsMessageLabel")
    hands.ok()
    assert plate_document.Objects[-1].Source is plate_document.Plate


def test_a_scan_that_is_deleted_while_the_panel_is_open_gets_a_sentence(hands, sheet):
    Gui.Selection.addSelection(sheet.Sheet, "Face6")
    hands.command(DeformFaces)
    previewed(hands)
    sheet.removeObject("Scan")
    hands.wait(200)
    hands.find("FfdsWhole").click()
    hands.wait(200)
    assert "holds no scan" in hands.says("FfdsMessageLabel") and not hands.says("FfdsFigures")
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.until(lambda: not Gui.Control.activeDialog(), 5)
