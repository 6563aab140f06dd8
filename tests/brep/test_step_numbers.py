# SPDX-License-Identifier: LGPL-2.1-or-later
"""A STEP file reads back with the numbers of the shape that was written, or is refused.

FreeCAD's own reader is the truth; every shape is warped as a whole, so that all its faces are B-splines.
"""
from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from ffds_workbench.benchmark.simulated import topology_shapes
from ffds_workbench.brep import topology, workpiece
from ffds_workbench.brep.model_files import model_file, step_file
from ffds_workbench.brep.model_files.model_file import Model
from ffds_workbench.brep.model_files.step_free_shapes import with_free_shapes
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.compat import write_step
from ffds_workbench.errors import RefusedError

WORLD = ("so_WaveShare_Mounting_Plate_SO101.step", "occ_bug24595_281390.stp", "occ_bug32745_pmi1.stp",
         "occ_trj3_d1-pe-214.stp", "pyocc_face_recognition_sample_part.stp", "so_Handle_SO101.step",
         "odri_transmission_pulley_at3_t10_center.STEP")


def _warped(shape: Part.Shape) -> Part.Shape:
    part = workpiece.read(shape)
    return rebuild(part, topology_shapes.warp(part), 1e-5)


def _written(shape: Part.Shape, path: Path) -> Part.Shape:
    model_file.write(Model(shape, "part"), path)
    return Part.read(str(path))


def _same_numbers(shape: Part.Shape, back: Part.Shape) -> None:
    """Sub-shapes are put together alike and lie in the same places; where within 1e-4 mm, what STEP readers move."""
    was, is_now = topology.read(shape), topology.read(back)
    for kind in ("solids", "shells", "faces", "wires", "edges", "vertices"):
        assert was.counts[kind] == is_now.counts[kind]
    assert was.solid_faces == is_now.solid_faces
    assert [sorted(edges) for edges in was.face_edges] == [sorted(edges) for edges in is_now.face_edges]
    assert [[sorted(wire) for wire in wires] for wires in was.face_wires] == [[sorted(wire) for wire in wires]
                                                                              for wires in is_now.face_wires]
    assert [sorted(ends) for ends in was.edge_vertices] == [sorted(ends) for ends in is_now.edge_vertices]
    for one, other in zip(shape.Vertexes, back.Vertexes, strict=True):
        assert one.Point.distanceToPoint(other.Point) < 1e-4
    middles = [[topology.points_on_edge(edge, np.array([0.5]))[0] for edge in part.Edges] for part in (shape, back)]
    assert np.linalg.norm(np.subtract(*middles), axis=1).max() < 1e-4
    assert back.isValid() and back.Volume * shape.Volume >= 0.0


def _with_free_shapes() -> Part.Shape:
    """Solids with an edge and a point between them that belong to no face."""
    free = Part.makeCompound([Part.Vertex(30, 0, 0), Part.makeLine((30, 1, 0), (30, 9, 4))])
    return Part.makeCompound([Part.makeCylinder(5, 12), free, Part.makeCone(4, 2, 9, Vector(50, 0, 0))])


@pytest.mark.parametrize("shape", [
    pytest.param(lambda: Part.makeBox(40, 30, 20), id="surfaces and edges turned"),
    pytest.param(lambda: Part.makeBox(40, 30, 20).cut(Part.makeCylinder(4, 20, Vector(12, 15, 0))), id="inner loops"),
    pytest.param(lambda: Part.makeSphere(15), id="one vertex loop"),
    pytest.param(lambda: Part.makeTorus(20, 5), id="two seams"),
    pytest.param(lambda: Part.makeCone(12, 0, 25), id="apex"),
    pytest.param(_with_free_shapes, id="free edge and vertex")])
def test_numbers_are_kept(shape, tmp_path):
    warped = _warped(shape())
    _same_numbers(warped, _written(warped, tmp_path / "part.step"))


@pytest.mark.parametrize("name", WORLD)
def test_numbers_of_real_parts_are_kept(shared_data, name, tmp_path):
    warped = _warped(Part.read(str(shared_data / "world" / name)))
    _same_numbers(warped, _written(warped, tmp_path / "part.step"))


def _prism() -> Part.Shape:
    return Part.Face(Part.makePolygon([(0, 0, 0), (30, 0, 0), (20, 20, 0), (0, 0, 0)])).extrude(Vector(0, 0, 9))


def test_a_torus_as_a_file_has_it_keeps_its_numbers(tmp_path):
    """A reader lists its two seams the other way round than `Part.makeTorus`."""
    Part.makeTorus(20, 5).exportStep(str(tmp_path / "nominal.step"))
    warped = _warped(Part.read(str(tmp_path / "nominal.step")))
    _same_numbers(warped, _written(warped, tmp_path / "part.step"))


def test_a_list_that_the_writer_breaks_is_found(tmp_path):
    """OCCT breaks lines where they are full, before the context of a long list of bodies for one."""
    shape = _with_free_shapes()
    shape.exportStep(str(tmp_path / "part.step"))
    text = (tmp_path / "part.step").read_text()
    listed = re.search(r"SHAPE_REPRESENTATION\('',\([#\d,]+\),", text)[0]
    broken = text.replace(listed, listed.replace("('',", "('',\n    ") + "\n  ")
    assert with_free_shapes(text, shape) != text
    assert re.sub(r"\s", "", with_free_shapes(broken, shape)) == re.sub(r"\s", "", with_free_shapes(text, shape))


def test_readers_put_a_loop_in_order(tmp_path):
    """However a STEP file lists the edges of a loop, they follow each other when it is read."""
    Part.makeBox(40, 30, 20).exportStep(str(tmp_path / "box.step"))
    text = (tmp_path / "box.step").read_text()
    mixed, count = re.subn(r"EDGE_LOOP\('',\((#\d+),(#\d+),(#\d+),(#\d+)\)\)", r"EDGE_LOOP('',(\1,\3,\2,\4))", text)
    (tmp_path / "box.step").write_text(mixed)
    read = topology.read(Part.read(str(tmp_path / "box.step")))
    assert count == 6 == len(read.face_wires)
    for (edges,) in read.face_wires:
        for one, other in zip(edges, edges[1:] + edges[:1], strict=True):
            assert set(read.edge_vertices[one]) & set(read.edge_vertices[other])


def test_what_is_refused_is_written_but_once(tmp_path, monkeypatch):
    written = []
    monkeypatch.setattr(step_file, "write_step", lambda shape, path: (written.append(path), write_step(shape, path)))
    with pytest.raises(RefusedError):
        _written(_prism(), tmp_path / "prism.step")
    assert len(written) == 1


def test_what_no_step_file_can_number_is_refused(tmp_path):
    """Edges of the first face of a prism go round it as 1, 4, 2, 3; a loop in a STEP file goes round in order."""
    prism = _warped(_prism())
    with pytest.raises(RefusedError, match=r"other numbers to Face1.* and Edge2.*\.brep or \.FCStd, which keep them"):
        _written(prism, tmp_path / "prism.step")
    with pytest.raises(RefusedError, match=r"go round Face1 in another order"):
        model_file.check_numbers(Model(prism, "prism"), tmp_path / "prism.step")
    model_file.check_numbers(Model(Part.makeBox(1, 2, 3), "box"), tmp_path / "box.step")
    for suffix in (".brep", ".FCStd"):
        model_file.check_numbers(Model(prism, "prism"), tmp_path / f"prism{suffix}")
        back = model_file.write(Model(prism, "prism"), tmp_path / f"prism{suffix}")
        assert back.topology == topology.read(prism)


def test_a_file_says_where_its_edges_lie(tmp_path):
    box = _warped(Part.makeBox(40, 30, 20))
    assert model_file.write(Model(box, "box"), tmp_path / "box.step").edge_offset < 1e-5
