# SPDX-License-Identifier: LGPL-2.1-or-later
"""The check for Boolean operations in the window: the part is there before it ends, and hears of it when it does."""
from __future__ import annotations

import json
from collections import OrderedDict

import FreeCAD
import FreeCADGui as Gui
import pytest

from ffds_workbench.api import certified
from ffds_workbench.gui.commands.deform.deform_faces import DeformFaces
from ffds_workbench.objects.jobs import registration_job
from ffds_workbench.report import boolean_check

WAITS = """
import os, time
while not os.path.exists({gate!r}):
    time.sleep(0.02)
print("errors: 0")
"""


@pytest.fixture
def gate(hands, monkeypatch, tmp_path):
    """A check that goes on until this file is there, and that nobody gives up before."""
    path = tmp_path / "gate"
    monkeypatch.setattr(registration_job, "_results", OrderedDict())  # what an earlier test knows of this plate
    monkeypatch.setattr(certified, "BOOLEAN_CHECK_SECONDS", 600.0)
    monkeypatch.setattr(boolean_check, "_CHECKER", WAITS.format(gate=str(path)))
    yield path
    path.touch()


def _deform(hands, document) -> None:
    """Deform the top of the plate by the panel."""
    Gui.Selection.addSelection(document.Plate, "Face6")
    hands.command(DeformFaces)
    hands.until(lambda: "after" in hands.says("FfdsFigures"))
    hands.ok()


def test_the_part_is_there_before_its_check_has_ended(hands, plate_document, gate):
    _deform(hands, plate_document)
    made = plate_document.AsBuilt
    assert made.isValid() and made.BooleanCheck == "running"
    assert json.loads(made.Report)["topology"]["boolean_check"] == {"before": None, "after": None}
    names, up_to_date = plate_document.UndoNames, made.State
    gate.touch()
    hands.until(lambda: made.BooleanCheck == "no errors")
    assert json.loads(made.Report)["topology"]["boolean_check"] == {"before": 0, "after": 0}
    assert plate_document.UndoNames == names and made.State == up_to_date and "Touched" not in made.State
    assert "Plate as built: the check for Boolean operations has ended: no errors" in (
        Gui.getMainWindow().statusBar().currentMessage())


def test_a_check_ends_while_its_part_is_undone(hands, plate_document, gate):
    _deform(hands, plate_document)
    plate_document.undo()
    gate.touch()
    hands.wait(700)
    plate_document.redo()
    hands.until(lambda: plate_document.AsBuilt.BooleanCheck == "no errors")


def test_a_check_that_ran_when_its_document_was_saved_is_said_to_be_lost(hands, plate_document, gate, tmp_path):
    _deform(hands, plate_document)
    path = str(tmp_path / "plate.FCStd")
    plate_document.saveCopy(path)
    assert FreeCAD.openDocument(path).AsBuilt.BooleanCheck == "broken off"
