# SPDX-License-Identifier: LGPL-2.1-or-later
"""The alignment by three points: picked with the mouse, one undo step, and nothing left behind when cancelled."""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import pytest

from ffds_workbench.gui.commands.scan.align_by_points import AlignByPoints
from ffds_workbench.gui.qt import QtWidgets
from ffds_workbench.objects.scans import scan_points

CORNERS = ((12.0, 12.0, 5.0), (44.0, 12.0, 5.0), (12.0, 28.0, 5.0))
SHIFT = np.array([75.0, 0.0, 0.0])


@pytest.fixture
def shifted(hands, plate_document):
    """The plate, and its scan beside it; seen from above."""
    part, scan = plate_document.Objects
    scan.Placement = FreeCAD.Placement(FreeCAD.Vector(*SHIFT.tolist()), FreeCAD.Rotation())
    plate_document.recompute()
    plate_document.clearUndos()
    view = Gui.ActiveDocument.ActiveView
    view.viewTop()
    view.fitAll()
    scan.ViewObject.PointSize = 6
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(plate_document.Name, part.Name)
    Gui.Selection.addSelection(plate_document.Name, scan.Name)
    hands.wait(500)
    return part, scan


def pick_all(hands) -> None:
    for corner in CORNERS:
        hands.pick(tuple(np.array(corner) + SHIFT))
    for corner in CORNERS:
        hands.pick(corner)


def test_three_picks_each_bring_the_scan_onto_the_part(hands, shifted):
    part, scan = shifted
    nodes = hands.nodes()
    hands.command(AlignByPoints)
    pick_all(hands)
    hands.screenshot("align_by_points")
    assert "press OK" in hands.find("FfdsHint", QtWidgets.QLabel).text()
    hands.ok()
    # The picks lie up to some millimetres aside; the fine alignment goes on to the noise along z, and within the
    # plate's plane to what the visible rim of a 1 mm bump lets it see.
    points = scan_points(scan)
    assert abs(points[:, 2].mean() - 5.2) < 0.3 and points[:, 0].min() > -1.5 and points[:, 0].max() < 61.5
    document = part.Document
    assert document.UndoNames == ["Align scan by points"] and hands.nodes() == nodes
    document.undo()
    assert scan_points(scan)[:, 0].min() > 70


def test_cancel_and_too_few_points_leave_nothing(hands, shifted):
    _, scan = shifted
    nodes, before = hands.nodes(), scan_points(scan)
    hands.command(AlignByPoints)
    hands.pick(tuple(np.array(CORNERS[0]) + SHIFT))
    assert "1 of 3" in hands.find("FfdsPicked", QtWidgets.QLabel).text()
    hands.click(hands.find("FfdsBack"))
    assert "1 of 3" not in hands.find("FfdsPicked", QtWidgets.QLabel).text()
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Ok))
    assert "three points" in hands.find("FfdsMessageLabel", QtWidgets.QLabel).text()
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.until(lambda: not Gui.Control.activeDialog())
    assert hands.nodes() == nodes and not scan.Document.UndoCount and (scan_points(scan) == before).all()
