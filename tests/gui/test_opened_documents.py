# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents that were made without a window, or saved by an earlier version, opened in one."""
from __future__ import annotations

import shutil
from pathlib import Path

import FreeCAD
import FreeCADGui as Gui
import numpy as np
import Part
import pytest

from ffds_workbench.brep.model_files import model_file
from ffds_workbench.gui.qt import QtWidgets
from ffds_workbench.gui.seams_view import SeamsView
from ffds_workbench.gui.view_providers import AsBuiltView
from ffds_workbench.objects.as_built import AsBuilt
from ffds_workbench.objects.seams import Seams

RED = (1.0, 0.0, 0.0, 0.0)
SAVED = Path(__file__).parent / "documents" / "plate_0.1.0.FCStd"
"""A plate of 60 × 40 × 5 mm, a scan with a bump of 1 mm, its as-built part and a seam on it, saved by version 0.1.0
when all modules of the window lay in one folder."""


def test_a_document_from_before_stiffness_takes_its_default(hands, tmp_path):
    """The whole plate with a scan of 3,000 points, saved when as-built parts had neither stiffness nor a gate."""
    document = FreeCAD.openDocument(str(shutil.copy(SAVED.with_name("whole_0.1.0.FCStd"), tmp_path)))
    hands.wait(300)
    made = document.AsBuilt
    before = np.array([tuple(vertex.Point) for vertex in made.Shape.Vertexes])
    assert made.Stiffness == 1.0 and isinstance(made.ViewObject.Proxy, AsBuiltView)
    made.touch()
    document.recompute()
    assert made.isValid() and made.MeanAfter.Value < 0.05 < made.MeanBefore.Value
    after = np.array([tuple(vertex.Point) for vertex in made.Shape.Vertexes])
    # A corner lies outside of the points that hold it, whose noise is 0.02 mm and a bump of 1 mm within 20 mm.
    np.testing.assert_allclose(after, before, atol=0.3)


@pytest.mark.parametrize("colours", [(), (RED,) * 6])
def test_a_written_document_opens_visible(hands, tmp_path, colours):
    path = tmp_path / "plate.FCStd"
    model_file.write(model_file.Model(Part.makeBox(60, 40, 5), "Plate", model_file.Decoration(colours=colours)), path)
    document = FreeCAD.openDocument(str(path))
    hands.wait(200)
    shown = document.Objects[0].ViewObject
    assert shown.Visibility and shown.SwitchNode.whichChild.getValue() >= 0
    assert not colours or list(shown.DiffuseColor) == [RED] * 6


def test_a_document_of_an_earlier_version_opens_with_its_views_and_goes_on(hands, tmp_path):
    path = Path(shutil.copy(SAVED, tmp_path))
    document = FreeCAD.openDocument(str(path))
    hands.wait(300)
    made, seams = document.AsBuilt, document.Seams
    kinds = [type(item.Proxy) for item in (made, seams, made.ViewObject, seams.ViewObject)]
    assert kinds == [AsBuilt, Seams, AsBuiltView, SeamsView]
    assert made.ViewObject.ShowLattice and seams.ViewObject.ColourBy == "Normal"
    before = np.array([tuple(vertex.Point) for vertex in made.Shape.Vertexes])
    made.touch()
    document.recompute()
    assert made.isValid() and seams.isValid()
    after = np.array([tuple(vertex.Point) for vertex in made.Shape.Vertexes])
    np.testing.assert_allclose(after, before, atol=0.05)  # the noise of its scan is 0.02 mm: the method may get better
    made.ViewObject.Proxy.doubleClicked(made.ViewObject)
    hands.wait(300)
    assert Gui.Control.activeDialog() and hands.says("FfdsPart").startswith("<b>Plate</b> Face6")
    hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    hands.wait(300)
    document.save()
