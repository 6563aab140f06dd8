# SPDX-License-Identifier: LGPL-2.1-or-later
"""Documents that were made without a window, opened in one."""
from __future__ import annotations

import FreeCAD
import Part
import pytest

from ffds_workbench.brep.model_files import model_file

RED = (1.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("colours", [(), (RED,) * 6])
def test_a_written_document_opens_visible(hands, tmp_path, colours):
    path = tmp_path / "plate.FCStd"
    model_file.write(model_file.Model(Part.makeBox(60, 40, 5), "Plate", model_file.Decoration(colours=colours)), path)
    document = FreeCAD.openDocument(str(path))
    hands.wait(200)
    shown = document.Objects[0].ViewObject
    assert shown.Visibility and shown.SwitchNode.whichChild.getValue() >= 0
    assert not colours or list(shown.DiffuseColor) == [RED] * 6
