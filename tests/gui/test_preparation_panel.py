# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preparation panel by mouse: steps are shown before anything changes, and written as one undo step."""
from __future__ import annotations

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import pytest

from ffds_workbench.gui.commands.scan.prepare_scan import PrepareScan
from ffds_workbench.gui.qt import QtWidgets
from ffds_workbench.objects import scans
from ffds_workbench.objects.scans import scan_points

pytest.importorskip("open3d", reason="the steps of preparation are open3d's")


@pytest.fixture
def on_table(hands):
    """A block of 30 × 20 × 10 mm on a table, with single points about it: (scan, points of the block)."""
    random = np.random.default_rng(0)
    block = random.uniform((0, 0, 0), (30, 20, 10), (6000, 3))
    side = random.integers(0, 3, 6000)
    block[np.arange(6000), side] = np.where(side == 2, 10, random.integers(0, 2, 6000) * np.array([30, 20, 10])[side])
    block = block[block[:, 2] > 0.5]
    table = np.column_stack([random.uniform((-25, -25), (55, 45), (9000, 2)), random.normal(0, 0.02, 9000)])
    gross = random.uniform((-25, -25, 12), (55, 45, 30), (60, 3))
    document = FreeCAD.newDocument("Table")
    scan = scans.add_scan(document, np.concatenate([block, table, gross]), "Raw")
    document.recompute()
    document.clearUndos()
    Gui.ActiveDocument.ActiveView.viewIsometric()
    Gui.ActiveDocument.ActiveView.fitAll()
    hands.wait(300)
    return scan, block


def test_steps_are_seen_before_the_scan_changes(hands, on_table):
    scan, block = on_table
    before, nodes = scan_points(scan), hands.nodes()
    hands.command(PrepareScan)
    figures = hands.find("FfdsFigures", QtWidgets.QLabel)
    hands.until(lambda: f"{len(before):,}" in figures.text())
    for name in ("FfdsPlane", "FfdsClutter", "FfdsOutliers", "FfdsThin"):
        hands.check(name)
    hands.until(lambda: "<table>" in figures.text())
    hands.screenshot("prepare_scan")
    looked_at = hands.find("FfdsLookAt", QtWidgets.QComboBox)
    assert [looked_at.itemData(k) for k in range(looked_at.count())] == ["", "plane", "clutter", "outliers", "spacing"]
    whole = hands.drawn()
    looked_at.setCurrentIndex(1)
    hands.wait()
    assert hands.drawn() != whole and (scan_points(scan) == before).all()
    hands.check("FfdsThin")
    hands.until(lambda: looked_at.count() == 4)
    hands.ok()
    points = scan_points(scan)
    # Of the block, what lies within the table's noise goes; a point of the table can lie within its walls' noise.
    assert 0.98 * len(block) < len(points) < 1.01 * len(block) and points[:, 2].min() > 0.0
    assert scan.Document.UndoNames == ["Prepare scan"] and hands.nodes() == nodes
    scan.Document.undo()
    assert (scan_points(scan) == before).all()


def test_cancel_and_nothing_chosen_leave_the_scan(hands, on_table):
    scan, _ = on_table
    before, nodes = scan_points(scan), hands.nodes()
    hands.command(PrepareScan)
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Ok))
    assert "Choose" in hands.says("FfdsMessageLabel")
    hands.check("FfdsNormals")
    hands.check("FfdsOutliers")
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.until(lambda: not Gui.Control.activeDialog())
    assert (scan_points(scan) == before).all() and hands.nodes() == nodes and not scan.Document.UndoCount
