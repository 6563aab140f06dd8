# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams in FreeCAD's window: found from a selected edge or by a tolerance, coloured, exported, undone."""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import Part
import pytest

from ffds_workbench.compat import qt
from ffds_workbench.gui.commands.weld.add_trajectory import AddTrajectory
from ffds_workbench.gui.commands.weld.export_program import ExportProgram
from ffds_workbench.gui.commands.weld.find_seams import FindSeams
from ffds_workbench.gui.qt import QtCore, QtWidgets
from ffds_workbench.gui.view3d.seams_drawing import FAIL, PASS, verdict_colours
from ffds_workbench.objects import actions
from ffds_workbench.objects.seams import stations_of, wishes_of

QtTest = qt("QtTest")


@pytest.fixture
def pipe(hands):
    """A document with a pipe of radius 20 on a plate, seen from above."""
    document = FreeCAD.newDocument("Pipe")
    plate = Part.makeBox(80, 80, 8, FreeCAD.Vector(-40, -40, -8))
    tube = Part.makeCylinder(20, 40).cut(Part.makeCylinder(17, 40)).Solids[0]
    part = document.addObject("Part::Feature", "Pipe")
    part.Shape = Part.makeCompound([plate, tube])
    document.recompute()
    document.clearUndos()
    view = Gui.ActiveDocument.ActiveView
    view.viewIsometric()
    view.fitAll()
    hands.wait(300)
    return part


def type_answer(text: str):
    """Type into the dialog's field and press Enter."""
    def press(dialog):
        field = dialog.findChild(QtWidgets.QLineEdit)
        field.selectAll()
        QtTest.QTest.keyClicks(field, text)
        QtTest.QTest.keyClick(field, QtCore.Qt.Key_Return)
    return press


def answer(text: str, read: list[str]):
    """Read the sentences of a dialog, and press the button with that text."""
    def press(dialog):
        listed = dialog.findChild(QtWidgets.QListWidget)
        read.extend(listed.item(row).text() for row in range(listed.count()))
        buttons = dialog.findChild(QtWidgets.QDialogButtonBox).buttons()
        QtTest.QTest.mouseClick(next(item for item in buttons if item.text().replace("&", "") == text),
                                QtCore.Qt.LeftButton)
    return press


def select(hands, item) -> None:
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(item.Document.Name, item.Name)
    hands.wait(200)


def test_a_selected_edge_becomes_a_coloured_seam_in_one_undo_step(hands, pipe, tmp_path):
    document = pipe.Document
    nodes = pipe.ViewObject.RootNode.getNumChildren()
    Gui.Selection.addSelection(document.Name, pipe.Name, "Edge15")
    hands.wait(200)
    hands.command(FindSeams)
    hands.until(lambda: len(document.Objects) == 2)
    seams = document.Objects[1]
    assert seams.isValid() and seams.Edges[0][0] is pipe and document.UndoNames == ["Find weld seams"]
    colours = verdict_colours(stations_of(seams), vars(wishes_of(seams).limits))
    assert set(colours.tolist()) == {PASS}
    seams.LimitLateral = 0.5
    hands.wait(300)
    hands.screenshot("seams")
    height = Gui.ActiveDocument.ActiveView.getCameraNode().height.getValue()
    Gui.ActiveDocument.ActiveView.fitAll()
    hands.wait(300)
    # The legend must not count as a thing to fit into the view; the bead is 0.7 mm thick.
    assert Gui.ActiveDocument.ActiveView.getCameraNode().height.getValue() == pytest.approx(height, rel=0.02)
    for name in ("Lateral", "Gap", "Verdict"):
        seams.ViewObject.ColourBy = name
    while document.UndoCount:
        document.undo()
    hands.wait(300)
    assert document.Objects == [pipe] and pipe.ViewObject.RootNode.getNumChildren() == nodes


def test_joints_are_found_by_a_tolerance_and_become_trajectories(hands, pipe, monkeypatch, tmp_path):
    document = pipe.Document
    select(hands, pipe)
    hands.answer(type_answer("0.1"))
    hands.command(FindSeams)
    hands.until(lambda: len(document.Objects) == 2)
    seams = document.Objects[1]
    assert seams.Tolerance.Value == pytest.approx(0.1) and len(seams.Verdicts) == 2
    select(hands, seams)
    hands.command(AddTrajectory)
    hands.until(lambda: len(document.Objects) == 4)
    assert {item.TypeId for item in document.Objects[2:]} == {"Robot::TrajectoryObject"}
    document.undo()
    assert len(document.Objects) == 2
    target = tmp_path / "weld.src"
    monkeypatch.setattr(QtWidgets.QFileDialog, "getSaveFileName", lambda *_: (str(target), ""))
    select(hands, seams)
    read: list[str] = []
    hands.answer(answer("Write all the same", read))
    hands.command(ExportProgram)
    hands.until(target.exists)
    assert "leads through the part" in read[0]
    assert target.with_suffix(".dat").exists() and FreeCAD.ActiveDocument is document
    document.saveAs(str(tmp_path / "pipe.FCStd"))
    FreeCAD.closeDocument(document.Name)
    again = FreeCAD.openDocument(str(tmp_path / "pipe.FCStd"))
    hands.wait(300)
    view = again.Objects[1].ViewObject
    view.ColourBy = "Gap"
    assert view.Proxy.getIcon().endswith("FFDS_FindSeams.svg")


@pytest.fixture
def block(hands):
    """A block whose upper side sank by 2 mm, its nominal part, and seams along a lower and an upper edge."""
    document = FreeCAD.newDocument("Block")
    parts = []
    for name, height in (("Nominal", 20), ("Built", 18)):
        parts.append(document.addObject("Part::Feature", name))
        parts[-1].Shape = Part.makeBox(60, 40, height)
    nominal, built = parts
    nominal.Visibility = False
    edges = [next(f"Edge{n}" for n, edge in enumerate(nominal.Shape.Edges, 1)
                  if edge.CenterOfMass.distanceToPoint(FreeCAD.Vector(30, 0, z)) < 1e-6) for z in (0, 20)]
    seams = actions.make_seams(built, edges, nominal=nominal)
    Gui.ActiveDocument.ActiveView.viewIsometric()
    Gui.ActiveDocument.ActiveView.fitAll()
    hands.wait(300)
    return seams, edges


@pytest.mark.parametrize(("text", "seams_in"), [("Write without them", 1), ("Write all", 2), ("Cancel", 0)])
def test_seams_that_fail_are_asked_about_before_the_program_is_written(hands, block, monkeypatch, tmp_path, text,
                                                                       seams_in):
    seams, edges = block
    target = tmp_path / "weld.src"
    monkeypatch.setattr(QtWidgets.QFileDialog, "getSaveFileName", lambda *_: (str(target), ""))
    select(hands, seams)
    read: list[str] = []

    def press(dialog):
        hands.screenshot("failing_seams")
        answer(text, read)(dialog)

    hands.answer(press)
    hands.command(ExportProgram)
    hands.until(lambda: read)
    hands.wait(300)
    assert read[0] == f"Beyond their limits, and therefore left out of the programs: {edges[1]} (lateral, normal)."
    assert target.exists() == (seams_in > 0)
    written = (tmp_path / "weld.dat").read_text() if seams_in else ""
    assert [name in written for name in ("XS1IN", "XS2IN")] == [seams_in >= number for number in (1, 2)]


def test_seams_are_not_dragged_by_a_double_click(hands, block):
    seams, _ = block
    Gui.ActiveDocument.setEdit(seams, 1)
    assert Gui.ActiveDocument.getInEdit() is None
    assert seams.ViewObject.Proxy.doubleClicked(seams.ViewObject) is True
    assert Gui.ActiveDocument.getInEdit() is None and Gui.Control.activeDialog()  # its own panel


def test_the_panel_of_seams_lights_them_and_chooses_what_is_programmed(hands, block, monkeypatch, tmp_path):
    seams, edges = block
    seams.ViewObject.Proxy.doubleClicked(seams.ViewObject)
    hands.wait(300)
    rows = hands.find("FfdsSeams", QtWidgets.QTreeWidget)
    hands.screenshot("seams_panel")
    shown = [(rows.topLevelItem(k).text(0), rows.topLevelItem(k).checkState(0) == QtCore.Qt.Checked) for k in (0, 1)]
    assert shown == [(edges[0], True), (edges[1], False)]  # the one that fails is off to begin with
    assert "lateral, normal" in rows.topLevelItem(1).text(4)
    hands.click(rows.viewport(), rows.visualItemRect(rows.topLevelItem(1)).center())
    assert "18.0" in hands.drawn().decode()  # its height, to which the upper side sank
    rows.insertTopLevelItem(0, rows.takeTopLevelItem(1))  # as a drag does
    rows.topLevelItem(0).setCheckState(0, QtCore.Qt.Checked)
    hands.ok()
    assert seams.Programmed == [edges[1], edges[0]] and seams.KeepFailing and "Touched" not in seams.State
    target = tmp_path / "weld.src"
    monkeypatch.setattr(QtWidgets.QFileDialog, "getSaveFileName", lambda *_: (str(target), ""))
    select(hands, seams)
    hands.answer(answer("Write all the same", []))
    hands.command(ExportProgram)
    hands.until(target.exists)
    text = target.read_text()
    assert 0 < text.index(f"; {edges[1]}") < text.index(f"; {edges[0]}")
    seams.Document.undo()
    assert not seams.Programmed


def test_a_cancelled_question_and_a_refusal_leave_nothing(hands, pipe):
    document = pipe.Document
    select(hands, pipe)
    hands.answer(lambda dialog: dialog.reject())
    hands.command(FindSeams)
    hands.wait(300)
    assert document.Objects == [pipe] and not document.UndoCount
    straight = next(f"Edge{n}" for n, edge in enumerate(pipe.Shape.Edges, 1)
                    if isinstance(edge.Curve, Part.Line) and abs(edge.Length - 40) < 1e-6)
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(document.Name, pipe.Name, straight)
    hands.wait(200)
    said = hands.answer(lambda dialog: dialog.accept())
    hands.command(FindSeams)
    hands.until(lambda: said)
    assert "one adjacent face" in said[0]
    assert document.Objects == [pipe] and not document.UndoCount and not document.HasPendingTransaction


def test_beyond_a_limit_is_red():
    stations = {"s": np.arange(3.0), "gap": np.array([0.1, 0.9, np.nan])}
    limits = dict.fromkeys(("lateral", "normal", "longitudinal", "gap", "opening", "rotation"), 0.5)
    assert verdict_colours(stations, limits)[:2].tolist() == [PASS, FAIL]
