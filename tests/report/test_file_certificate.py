# SPDX-License-Identifier: LGPL-2.1-or-later
"""The certificate of a written file, against files and shapes whose flaws are known because they were put there."""
from __future__ import annotations

from dataclasses import replace

import Part
import pytest

from ffds_workbench.brep import topology
from ffds_workbench.brep.model_files import model_file
from ffds_workbench.brep.model_files.model_file import Model
from ffds_workbench.brep.model_files.read_back import compare
from ffds_workbench.errors import RefusedError
from ffds_workbench.report import meshing
from ffds_workbench.report.certificate import condition
from ffds_workbench.report.file_certificate import certify_file
from ffds_workbench.report.meshing import Mesh, mesh


@pytest.mark.parametrize("suffix", [".step", ".brep", ".FCStd"])
def test_a_file_is_certified_as_it_reads_back(tmp_path, suffix):
    box = Part.makeBox(10, 20, 30)
    back = model_file.write(Model(box, "box"), tmp_path / f"box{suffix}")
    written = certify_file(box, condition(box), back).as_dict()
    assert written["format"] == suffix.lower().lstrip(".")
    assert written["counts"] | {"compounds": 0} == topology.read(box).counts
    assert written["numbers_kept"] and written["valid"] and written["closed"]
    assert written["faces_without_mesh"] == [] and written["open_mesh_edges"] == 0 and written["notes"] == []
    # STEP cannot say that an edge of a box lists its end first, nor that a loop runs against its face.
    assert bool(written["turned_edges"]) == bool(written["turned_faces"]) == (suffix == ".step")
    assert max(written["edge_offset"], written["max_edge_gap"]) < 1e-6


def test_an_open_file_and_a_face_without_triangles_are_refused(monkeypatch):
    box = Part.makeBox(10, 20, 30)
    before = condition(box)
    open_shell = Part.makeCompound([Part.makeShell(box.Faces[:5])])
    back = compare(".step", box, before.topology, box.copy())
    with pytest.raises(RefusedError, match="no longer closed"):
        certify_file(box, before, replace(back, shape=open_shell))
    meshes = iter([Mesh((2,), 4), Mesh((), 0)])
    monkeypatch.setattr("ffds_workbench.report.file_certificate.mesh", lambda shape: next(meshes))
    with pytest.raises(RefusedError, match="Face3 gives no triangles. Write .brep or .FCStd"):
        certify_file(box, before, back)


def test_looser_than_the_nominal_is_noted():
    box = Part.makeBox(10, 20, 30)
    gaping = box.copy()
    gaping.fixTolerance(0.25)
    certificate = certify_file(box, condition(box), compare(".brep", box, topology.read(box), gaping))
    assert any("tolerance grew" in note for note in certificate.notes)


def test_meshes():
    assert mesh(Part.makeCylinder(3, 10)) == Mesh((), 0)
    assert mesh(Part.makePlane(4, 2)).open_edges == 4


def test_a_face_that_the_mesher_gives_up_on_now_and_then(shared_data, monkeypatch):
    """At 0.03 mm OCCT 7.6 gives this face no triangles, at 0.015 and 0.06 mm it does."""
    face = Part.read(str(shared_data / "world" / "occ_abc_0_13.step")).Faces[65].copy()
    box = face.BoundBox
    monkeypatch.setattr(meshing, "_DEVIATION", 0.03 / (box.XLength + box.YLength + box.ZLength))
    assert mesh(face).empty == ()


def test_what_lies_elsewhere_or_is_missing_is_seen():
    shape = Part.makeBox(10, 10, 10)
    written = topology.read(shape)
    moved = shape.copy()
    moved.translate((0, 0, 0.5))
    assert compare(".step", shape, written, moved).differences(written).startswith("give other numbers to Edge")
    assert compare(".step", shape, written, Part.makeCylinder(5, 10)).differences(written).startswith("hold ")
