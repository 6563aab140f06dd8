# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scans are imported, simulated and brought onto the part with the menu's commands."""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import Part
import pytest

from ffds_workbench.gui.commands.deform.export_as_built import ExportAsBuilt
from ffds_workbench.gui.commands.learn.load_example import LoadExample
from ffds_workbench.gui.commands.scan.align_scan import AlignScan
from ffds_workbench.gui.commands.scan.import_scan import ImportScan
from ffds_workbench.gui.commands.scan.simulate_scan import SimulateScan
from ffds_workbench.gui.qt import QtWidgets
from ffds_workbench.objects.scans import scan_points


def test_a_scan_in_metres_is_asked_about(hands, plate_document, tmp_path, monkeypatch):
    np.savetxt(tmp_path / "metres.xyz", np.random.default_rng(0).uniform(0, 0.06, (500, 3)))
    monkeypatch.setattr(QtWidgets.QFileDialog, "getOpenFileNames",
                        lambda *_: ([str(tmp_path / "metres.xyz")], ""))
    hands.answer(lambda dialog: dialog.accept())
    hands.command(ImportScan)
    hands.until(lambda: len(plate_document.Objects) == 3, 10)
    assert plate_document.Objects[-1].Points.BoundBox.XMax == pytest.approx(60, rel=0.05)
    assert plate_document.UndoNames == ["Import scan"]


def test_a_scan_is_simulated_and_the_part_exported(hands, plate_document, tmp_path, monkeypatch):
    part = plate_document.Plate
    Gui.Selection.addSelection(part)
    hands.answer(lambda dialog: dialog.accept())
    hands.command(SimulateScan)
    hands.until(lambda: len(plate_document.Objects) == 3, 20)
    assert plate_document.UndoNames == ["Simulate a scan"]
    scan = plate_document.Objects[-1]
    points = scan_points(scan)
    assert points[:, 0].max() < 61 and points[:, 2].min() > -1 and points[:, 2].max() < 6
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(part)
    monkeypatch.setattr(QtWidgets.QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "out"), "STEP (*.step)"))
    hands.command(ExportAsBuilt)
    assert len(Part.read(str(tmp_path / "out.step")).Faces) == 6


def test_a_scan_is_aligned_in_one_undo_step(hands):
    hands.command(LoadExample)
    document = FreeCAD.ActiveDocument
    scan = document.Scan
    lay = scan_points(scan)
    scan.Placement = FreeCAD.Placement(FreeCAD.Vector(20, -10, 5), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 10))
    away = scan_points(scan)
    document.clearUndos()
    Gui.Selection.addSelection(document.Bracket)
    Gui.Selection.addSelection(scan)
    hands.command(AlignScan)
    hands.until(lambda: document.UndoNames == ["Align scan"], 60)
    # The part is up to 2 mm out of shape: its rigid pose is known to about half of that.
    assert abs(scan_points(scan) - lay).mean() < 1.0
    document.undo()
    assert abs(scan_points(scan) - away).max() < 1e-3


def test_a_plate_seen_from_above_is_aligned_and_what_is_not_told_is_said(hands, plate_document):
    """A plain plate looks the same after half a turn, and from above nothing tells its upper side from its lower."""
    scan = plate_document.Scan
    scan.Placement = FreeCAD.Placement(FreeCAD.Vector(40, -60, 30), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 70))
    plate_document.clearUndos()
    Gui.Selection.addSelection(plate_document.Plate)
    said = hands.answer(lambda dialog: (hands.screenshot("align_plate"), dialog.accept()), QtWidgets.QMessageBox)
    hands.command(AlignScan)
    hands.until(lambda: said, 90)
    assert "equally well in" in said[0] and plate_document.UndoNames == ["Align scan"]
    # The bump leaves the pose within the plane about half its height.
    points = scan_points(scan)
    assert np.abs(points.min(axis=0)[:2]).max() < 0.5 and np.abs(points.max(axis=0)[:2] - [60, 40]).max() < 0.5
