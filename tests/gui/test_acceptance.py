# SPDX-License-Identifier: LGPL-2.1-or-later
"""One session from the nominal part to the as-built one with nothing but mouse and keyboard.

The scans of the plate are analytic bumps of 1 mm and 2 mm with noise of 0.05 mm: the fitted top is known to no less.
"""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import pytest

from ffds_workbench.compat import qt
from ffds_workbench.gui.qt import QtCore, QtWidgets
from ffds_workbench.scan.sensor.files import write_ply

QtTest = qt("QtTest")

TOLERANCE = 0.05


def top(shape) -> float:
    """Height of the plate's upper side at its middle."""
    import Part

    return 20 - shape.distToShape(Part.Vertex(30, 20, 20))[0]


@pytest.fixture
def files(plate, tmp_path):
    """The plate as STEP, and two scans of it as PLY."""
    points = np.loadtxt(plate[1])
    for name, factor in (("first", 1.0), ("second", 2.0)):
        write_ply(tmp_path / f"{name}.ply", points * [1, 1, factor] + [0, 0, 5 - 5 * factor])
    return plate[0], tmp_path / "first.ply", tmp_path / "second.ply", tmp_path / "session.FCStd"


def open_part_and_scan(hands, part, scan):
    """Ctrl+O for the part, the menu for the scan; seen from above, the part picked on its upper face."""
    hands.name_file(part)
    hands.press(QtCore.Qt.Key_O)
    hands.until(lambda: FreeCAD.ActiveDocument is not None and len(FreeCAD.ActiveDocument.Objects) == 1, 20)
    hands.name_file(scan)
    hands.choose("FFDS", "Scan", "Import scan…")
    document = FreeCAD.ActiveDocument
    hands.until(lambda: len(document.Objects) == 2, 20)
    hands.wait(300)
    hands.press(QtCore.Qt.Key_0, QtCore.Qt.NoModifier)
    hands.at_rest()
    return document


def in_tree(hands, label: str, double: bool = False) -> None:
    """Click an entry of the tree, or double-click it; FreeCAD may be a little late with it."""
    def found() -> list:
        return [(tree, item) for tree in Gui.getMainWindow().findChildren(QtWidgets.QTreeWidget) if tree.isVisible()
                for item in tree.findItems(label, QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive)]

    hands.until(found, 5)
    tree, item = found()[0]
    tree.scrollToItem(item)
    place = tree.visualItemRect(item).center()
    hands.click(tree.viewport(), place)
    if double:
        QtTest.QTest.mouseDClick(tree.viewport(), QtCore.Qt.LeftButton, QtCore.Qt.NoModifier, place, 10)
    hands.wait(300)


def test_a_whole_session(hands, files):
    part, first, second, saved = files
    document = open_part_and_scan(hands, part, first)
    plate, scan = document.Objects
    in_tree(hands, "first")
    hands.press(QtCore.Qt.Key_Space, QtCore.Qt.NoModifier)  # hides the scan: its points would catch the mouse
    hands.until(lambda: not scan.Visibility, 5)
    hands.wait(500)
    hands.pick((20, 12, 5.0))
    assert Gui.Selection.getSelectionEx()[0].SubElementNames == ("Face6",)
    hands.choose("FFDS", "Deform", "Deform faces to scan…")
    hands.until(lambda: "after" in hands.says("FfdsFigures"), 20)
    hands.wait(800)
    exact, drawn = hands.says("FfdsFigures"), hands.drawn()
    hands.check("FfdsAutomatic")
    slider = hands.find("FfdsControlPointsUSlider")
    QtTest.QTest.keyClick(slider, QtCore.Qt.Key_Home)  # too few control points for the bump
    hands.until(lambda: hands.says("FfdsFigures") != exact and hands.drawn() != drawn, 5)
    for _ in range(9):
        QtTest.QTest.keyClick(slider, QtCore.Qt.Key_Right)
        hands.wait(20)
    soft = hands.drawn()
    QtTest.QTest.keyClick(hands.find("FfdsStiffness"), QtCore.Qt.Key_Right)
    assert hands.drawn() != soft
    hands.screenshot("acceptance_panel")
    hands.ok()
    item = document.Objects[2]
    assert item.isValid() and top(item.Shape) == pytest.approx(6, abs=TOLERANCE)
    assert item.MeanAfter.Value < TOLERANCE < item.MeanBefore.Value and item.Stiffness > 1
    hands.press(QtCore.Qt.Key_Z)
    assert document.Objects == [plate, scan] and plate.Visibility
    hands.press(QtCore.Qt.Key_Z, QtCore.Qt.ControlModifier | QtCore.Qt.ShiftModifier)
    item = document.Objects[2]
    assert top(item.Shape) == pytest.approx(6, abs=TOLERANCE) and not plate.Visibility
    hands.name_file(saved)
    hands.press(QtCore.Qt.Key_S)
    hands.until(saved.exists, 10)
    FreeCAD.closeDocument(document.Name)
    hands.name_file(saved)
    hands.press(QtCore.Qt.Key_O)
    hands.until(lambda: FreeCAD.ActiveDocument is not None, 20)
    document = FreeCAD.ActiveDocument
    plate, scan, item = document.Objects
    assert top(item.Shape) == pytest.approx(6, abs=TOLERANCE) and item.ViewObject.Visibility
    replace_the_scan(hands, document, second)
    assert top(item.Shape) == pytest.approx(7, abs=2 * TOLERANCE) and document.UndoNames == ["Replace scan"]
    hands.press(QtCore.Qt.Key_R)
    assert item.isValid() and top(item.Shape) == pytest.approx(7, abs=2 * TOLERANCE)
    hands.press(QtCore.Qt.Key_Z)
    assert len(document.Objects) == 3 and top(item.Shape) == pytest.approx(6, abs=TOLERANCE)
    cancel_in_mid_work(hands, document, item)


def test_the_card_by_mouse_alone(hands, tmp_path):
    """A face is picked through the cloud that lies on it, deformed, judged, looked at and undone."""
    hands.choose("FFDS", "Learn", "Load the example")
    document = FreeCAD.ActiveDocument
    hands.at_rest()
    hands.pick((25.0, 0.0, 20.0))  # on the upright face, whose scan takes the click
    assert [item.Name for item in Gui.Selection.getSelection()] == ["Scan"]
    hands.choose("FFDS", "Deform", "Deform faces to scan…")
    assert hands.says("FfdsPart") == "<b>Bracket</b> Face9"
    hands.until(lambda: "after" in hands.says("FfdsFigures"), 20)
    hands.ok()
    hands.until(lambda: hands.says("FfdsVerdict"), 5)
    assert "fits the scan within its noise" in hands.says("FfdsVerdict") and "Touched" not in document.AsBuilt.State
    hands.screenshot("result")
    table = hands.find("FfdsFaces", QtWidgets.QTableWidget)
    hands.click(table.viewport(), table.visualItemRect(table.item(0, 0)).center())
    assert [entry.SubElementNames for entry in Gui.Selection.getSelectionEx()] == [("Face9",)]
    report = tmp_path / "report.html"
    hands.name_file(report)
    hands.click(hands.find("FFDS_ExportReport_Way"))
    hands.until(report.exists, 20)
    assert "fits the scan within its noise" in report.read_text("utf-8")
    hands.choose("FFDS", "Inspect", "Show deviation")
    hands.until(lambda: hands.says("FfdsCursor"), 20)
    hands.pick((25.0, 0.0, 20.0))
    assert "mm" in hands.says("FfdsCursor") and not Gui.Selection.getSelection()
    assert "lone points left out" in hands.says("FfdsFigures")
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Close))
    hands.press(QtCore.Qt.Key_Z)
    assert [item.Name for item in document.Objects] == ["Bracket", "Scan"] and document.Bracket.Visibility


def replace_the_scan(hands, document, path) -> None:
    in_tree(hands, "first")
    hands.name_file(path)

    def replace(box) -> None:
        hands.click(next(button for button in box.buttons() if button.text().replace("&", "") == "Replace"))

    hands.answer(replace, QtWidgets.QMessageBox)
    hands.choose("FFDS", "Scan", "Import scan…")
    hands.until(lambda: document.Objects[1].Label == "second", 30)
    hands.wait(300)


def cancel_in_mid_work(hands, document, item) -> None:
    """Double-click the part in the tree, set it to the whole part, press OK, and then Cancel."""
    before, nodes = item.Shape.hashCode(), hands.nodes()
    in_tree(hands, item.Label, double=True)
    hands.until(Gui.Control.activeDialog, 10)
    hands.check("FfdsWhole")
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Ok))
    assert hands.find("FfdsProgressBar") and Gui.Control.activeDialog()
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.until(lambda: not Gui.Control.activeDialog(), 5)
    hands.idle()
    assert item.Shape.hashCode() == before and len(document.Objects) == 3 and hands.nodes() == nodes
    assert not document.UndoCount and not document.HasPendingTransaction and item.Faces
