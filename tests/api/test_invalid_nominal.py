# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nominal models that are not valid: deformed where the result is no worse, sub-shape by sub-shape."""
from __future__ import annotations

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from ffds_workbench import api
from ffds_workbench.benchmark.simulated import topology_shapes
from ffds_workbench.brep import workpiece
from ffds_workbench.brep.model_files import model_file
from ffds_workbench.brep.model_files.model_file import Model
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.brep.validity import WHOLE, invalid_parts, newly_invalid
from ffds_workbench.errors import RefusedError
from ffds_workbench.report.certificate import condition
from ffds_workbench.report.file_certificate import certify_file


@pytest.fixture(scope="module")
def bow_tie() -> Part.Shape:
    """A prism whose two end faces cross themselves."""
    wire = Part.makePolygon([(0, 0, 0), (30, 0, 0), (0, 30, 0), (30, 30, 0), (0, 0, 0)])
    return Part.Face(wire).extrude(Vector(0, 0, 15))


def test_what_is_at_fault_has_a_name(bow_tie):
    assert not bow_tie.isValid()
    assert {"Face5", "Face6"} <= set(invalid_parts(bow_tie)) and WHOLE not in invalid_parts(bow_tie)
    assert invalid_parts(Part.makeBox(1, 2, 3)) == ()
    assert newly_invalid(bow_tie, bow_tie.copy()) == () and newly_invalid(Part.makeBox(1, 2, 3), bow_tie)


def test_no_worse_is_written_and_noted(bow_tie, tmp_path):
    model = model_file.from_object(bow_tie)
    part = workpiece.read(model.shape)
    warped = rebuild(part, topology_shapes.warp(part), 1e-5)
    back = model_file.write(Model(warped, "bow tie"), tmp_path / "bow_tie.brep")
    notes = certify_file(bow_tie, condition(bow_tie), back).notes
    assert any("not valid in Face5, Face6" in note for note in notes)


def test_worse_is_refused(bow_tie, tmp_path, monkeypatch):
    box = Part.makeBox(30, 30, 15)
    monkeypatch.setattr("ffds_workbench.brep.model_files.model_file.Part.read", lambda path: bow_tie)
    monkeypatch.setattr("ffds_workbench.brep.model_files.read_back.ReadBack.differences", lambda self, written: "")
    monkeypatch.setattr("ffds_workbench.brep.model_files.step_file.Part.read", lambda path: bow_tie)
    with pytest.raises(RefusedError, match=r"not read back as a valid shape \(Face5"):
        model_file.write(Model(box, "box"), tmp_path / "box.step")


def test_a_face_of_an_invalid_part_is_registered(bow_tie):
    """The scan shows Face1, the side y = 0, 0.02 mm out."""
    x, z = np.meshgrid(np.linspace(1, 29, 60), np.linspace(1, 14, 30))
    points = np.stack([x.ravel(), np.full(x.size, -0.02), z.ravel()], axis=1)
    result = api.register(bow_tie, points, faces=["Face1"])
    assert result.shape.Faces[0].distToShape(Part.Vertex(15, -0.02, 7))[0] < 1e-3  # there is no noise
    assert set(invalid_parts(result.shape)) <= set(invalid_parts(bow_tie))
