# SPDX-License-Identifier: LGPL-2.1-or-later
"""Foreign model files cannot take the process along: each of these ended it, or never came back, when read here."""
from __future__ import annotations

import importlib
import sys
import tempfile
import zipfile
from pathlib import Path

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench import RESOURCES
from ffds_workbench.benchmark.fuzz import mutations
from ffds_workbench.brep import workpiece
from ffds_workbench.brep.model_files import model_file, reader, reading, step_colours
from ffds_workbench.errors import InputError

BRACKET = RESOURCES / "examples" / "bracket.step"


def refused(path: Path, label: str | None = None) -> str:
    """The one sentence that is said of a file."""
    with pytest.raises(InputError) as caught:
        model_file.read(path, label)
    text = str(caught.value)
    assert "\n" not in text and str(path) in text
    return text


def wrong_reference(path: Path) -> Path:
    """The bracket with a vector whose direction is something else: Open CASCADE's reader calls ``exit(1)``."""
    text = BRACKET.read_text()
    assert "VECTOR('',#1389," in text
    path.write_text(text.replace("VECTOR('',#1389,", "VECTOR('',#389,"))
    return path


def test_a_step_file_that_ends_the_process(tmp_path, ffds):
    path = wrong_reference(tmp_path / "m.step")
    assert "damaged" in refused(path)
    run = ffds("deviation", path, RESOURCES / "examples" / "bracket_scan.ply")
    assert run.returncode == 2 and run.stderr.count("\n") == 1 and "cannot be read" in run.stderr


def test_a_brep_file_that_is_read_for_ever(tmp_path, monkeypatch):
    """Where an edge's curve should be numbered stands no number: what comes next is never the end of the edge."""
    text = Part.makeBox(1, 2, 3).exportBrepToString()
    edge = text.index("Ed\n")
    curve = text.index("\n1 ", edge)
    (tmp_path / "m.brep").write_text(text[:curve] + "\n1 x" + text[curve + 3 :])
    monkeypatch.setattr(reading, "_SECONDS", 1.0)
    assert "more than 1 s" in refused(tmp_path / "m.brep")


def test_a_file_that_takes_too_much_memory(tmp_path, monkeypatch):
    Part.makeCompound([Part.makeBox(1, 2, 3 + i) for i in range(200)]).exportBrep(str(tmp_path / "m.brep"))
    monkeypatch.setattr(reading, "_BYTES", 1 << 20)
    monkeypatch.setattr(reading, "_BYTES_PER_BYTE", 0)
    assert "damaged" in refused(tmp_path / "m.brep")


def test_a_reading_that_stands_still(monkeypatch):
    """It gets no processor time any more; on a busy machine it would get some."""
    monkeypatch.setattr(reading, "_CHILD", "import signal\nsignal.pause()")
    monkeypatch.setattr(reading, "_STILL", 0.2)
    monkeypatch.setattr(reading, "_LOOK", 0.1)
    assert "damaged" in refused(BRACKET)


def test_nothing_is_left_behind(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    folder = tmp_path / "models"
    folder.mkdir()
    refused(wrong_reference(folder / "bad.step"))
    model_file.read(BRACKET)
    reading.begin(BRACKET)
    assert len(list(tmp_path.iterdir())) == 2
    reading._BEGUN.clear()
    reading.begin(folder / "missing.step")
    reading.begin(tmp_path)
    assert not reading._BEGUN and list(tmp_path.iterdir()) == [folder]


def test_what_is_read_there_is_what_the_file_holds(shared_data):
    for path in [BRACKET, *sorted((shared_data / "parts").iterdir()), shared_data / "world" / "pyocc_as1-oc-214.stp"]:
        if path.suffix not in (".step", ".stp", ".brep"):
            continue
        here, there = Part.read(str(path)), model_file.read(path).shape
        for kind in ("Solids", "Shells", "Faces", "Wires", "Edges", "Vertexes"):
            assert len(getattr(here, kind)) == len(getattr(there, kind))
        points = [np.array([tuple(vertex.Point) for vertex in shape.Vertexes]) for shape in (here, there)]
        # Placements and directions of unit length are normalised anew: some bits of the largest coordinate.
        np.testing.assert_allclose(*points, atol=1e-14 * here.BoundBox.DiagonalLength)
        assert [face.Orientation for face in here.Faces] == [face.Orientation for face in there.Faces]
        assert [edge.Tolerance for edge in here.Edges] == [edge.Tolerance for edge in there.Edges]


def test_the_damaged_models_beside_the_project(shared_data):
    for path in sorted((shared_data / "bad").glob("step_ends_the_process_*")):
        assert "damaged" in refused(path)


def test_step_text_takes_as_long_as_it_is():
    """A stray quote made strings out of what is between them: the text was searched for longer than anyone waited."""
    text = BRACKET.read_text()
    damaged = text.replace("'", "", 1) * 20
    step_colours.read(damaged, ["Plane"] * 19)
    bodies = "".join(f"#{i} = CLOSED_SHELL('',(#{i + 1},#{i + 1}));" for i in range(1, 60))
    styles = "".join(f"#{i} = SURFACE_SIDE_STYLE('',(#{i + 1},#{i + 1},#99));" for i in range(100, 140))
    loops = "#90 = SHAPE_REPRESENTATION('',(#91)); #91 = MANIFOLD_SOLID_BREP('a',#1); #60 = CLOSED_SHELL('',(#60));"
    item = "#92 = STYLED_ITEM('',(#93),#1); #93 = PRESENTATION_STYLE_ASSIGNMENT((#100)); #99 = COLOUR_RGB('',1e999,x);"
    assert step_colours.read(bodies + styles + loops + item, []).colours == ()


@pytest.fixture
def document(tmp_path) -> Path:
    """A box, and a file that belongs to the document."""
    (tmp_path / "note.txt").write_text("a note")
    made = FreeCAD.newDocument("Source", hidden=True, temp=True)
    made.addObject("Part::Box", "Box").addProperty("App::PropertyFileIncluded", "Note")
    made.Box.Note = str(tmp_path / "note.txt")
    made.recompute()
    made.saveAs(str(tmp_path / "m.FCStd"))
    FreeCAD.closeDocument(made.Name)
    return tmp_path / "m.FCStd"


def rewritten(path: Path, old: bytes, new: bytes, renamed: tuple[str, str] = ("", "")) -> Path:
    """A copy of a document with another Document.xml, and a file in it renamed."""
    copy = path.with_name("changed.FCStd")
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(copy, "w", zipfile.ZIP_DEFLATED) as target:
        for name in source.namelist():
            content = source.read(name)
            assert name != "Document.xml" or old in content
            target.writestr(name.replace(*renamed), content.replace(old, new) if name == "Document.xml" else content)
    return copy


def test_a_document_with_a_file_of_its_own(document):
    assert len(model_file.read(document).shape.Faces) == 6


def test_a_file_that_would_be_unpacked_elsewhere(document):
    for other in ("../stray.txt", "/tmp/stray.txt", "..", "a\\stray.txt", "&#46;&#46;/stray.txt"):
        assert "damaged" in refused(rewritten(document, b'file="note.txt"', f'file="{other}"'.encode(),
                                              ("note.txt", other)))
    assert not list(document.parent.glob("**/stray*"))


@pytest.fixture
def trap(tmp_path, monkeypatch):
    """A module that leaves a file behind when it is run, installed as a workbench in every FreeCAD that is started."""
    home = tmp_path / "home" / "Mod" / "Trap"
    home.mkdir(parents=True)
    (home / "Init.py").write_text("")
    (home / "ffds_trap.py").write_text(
        f"open({str(tmp_path / 'sprung')!r}, 'w').close()\nclass Proxy:\n    pass\n")
    monkeypatch.setenv("FREECAD_USER_HOME", str(tmp_path / "home"))
    monkeypatch.syspath_prepend(str(home))
    sys.modules.pop("ffds_trap", None)
    return tmp_path / "sprung"


def _with_a_proxy(folder):
    """A document with a box that a class of the trap looks after."""
    made = FreeCAD.newDocument("Proxied", hidden=True, temp=True)
    item = made.addObject("Part::FeaturePython", "Box")
    item.Shape = Part.makeBox(1, 2, 3)
    item.Proxy = importlib.import_module("ffds_trap").Proxy()
    made.saveAs(str(folder / "m.FCStd"))
    FreeCAD.closeDocument(made.Name)
    return folder / "m.FCStd"


def test_what_proxies_name_is_not_run(tmp_path, trap):
    path = _with_a_proxy(tmp_path)
    with zipfile.ZipFile(path) as archive:
        assert b"ffds_trap" in archive.read("Document.xml")
    trap.unlink()
    assert len(model_file.read(path).shape.Faces) == 6
    assert not trap.exists()


def test_what_types_name_is_not_run(document, trap):
    changed = rewritten(document, b'type="Part::Box"', b'type="ffds_trap::Box"')
    assert "damaged" in refused(changed)
    assert not trap.exists()


def test_links_to_other_files_are_not_followed(tmp_path, trap):
    """A link to a document with a trap in it, beside this one, and objects of its own."""
    other = _with_a_proxy(tmp_path)
    made = FreeCAD.newDocument("Linking", hidden=True, temp=True)
    made.saveAs(str(tmp_path / "linking.FCStd"))
    opened = FreeCAD.openDocument(str(other), hidden=True)
    made.addObject("App::Link", "Link").LinkedObject = opened.Box
    made.addObject("Part::Box", "Own")
    made.addObject("App::Link", "Empty")  # leads nowhere, and to no other file
    made.recompute()
    made.save()
    FreeCAD.closeDocument(made.Name)
    FreeCAD.closeDocument(opened.Name)
    trap.unlink()
    for label in (None, "Link"):
        assert "links to another file in 'Link'" in refused(tmp_path / "linking.FCStd", label)
    assert "no object 'Empty' with faces" in refused(tmp_path / "linking.FCStd", "Empty")
    assert model_file.read(tmp_path / "linking.FCStd", "Own").label == "Own"
    assert not trap.exists()


def test_entities_in_a_document(document):
    laughs = "".join(f'<!ENTITY l{i} "{f"&l{i - 1};" * 10}">' for i in range(1, 12))
    text = f'<!DOCTYPE Document [<!ENTITY l0 "ha">{laughs}]><Document l="&l11;" '.encode()
    assert "damaged" in refused(rewritten(document, b"<Document ", text))


def test_a_document_that_unpacks_to_far_more_than_it_is(document):
    bomb = document.with_name("bomb.FCStd")
    with zipfile.ZipFile(document) as source, zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as target:
        target.writestr("Document.xml", source.read("Document.xml") + b" " * (1 << 28))
        for name in source.namelist()[1:]:
            target.writestr(name, source.read(name))
    assert bomb.stat().st_size < 400_000
    try:
        assert len(model_file.read(bomb).shape.Faces) == 6
    except InputError as error:
        assert "\n" not in str(error)


def test_containers_of_documents(document):
    """Whatever happens to the zip file, Python's part of reading it says no or goes on."""
    hypothesis = pytest.importorskip("hypothesis")
    content, damaged = document.read_bytes(), document.with_name("damaged.FCStd")

    @hypothesis.settings(derandomize=True, deadline=None, database=None, max_examples=200)
    @hypothesis.given(hypothesis.strategies.integers(0, 2**32 - 1))
    def check(state):
        damaged.write_bytes(mutations.mutated(content, [content], np.random.default_rng(state)))
        try:
            reader._checked_archive(damaged)
        except reader._DAMAGED:
            return

    check()
    for length in (10, len(content) // 2, len(content) - 100):
        damaged.write_bytes(content[:length])
        assert "damaged" in refused(damaged)


def test_a_face_without_area(tmp_path):
    """Of an arc that turns about an axis which it does not meet at a right angle, OCCT's reader leaves one circle."""
    start, top = FreeCAD.Vector(11, 0, 0), FreeCAD.Vector(0, 0, 19)
    sides = [Part.Arc(start, FreeCAD.Vector(14, 0, 14.5), top), Part.LineSegment(top, FreeCAD.Vector()),
             Part.LineSegment(FreeCAD.Vector(), start)]
    half = Part.Face(Part.Wire([side.toShape() for side in sides]))
    dome = half.revolve(FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 360)
    dome.exportStep(str(tmp_path / "dome.step"))
    part = workpiece.read(model_file.read(tmp_path / "dome.step").shape)
    with pytest.raises(InputError, match="Face.* has no area"):
        [face.box for face in part.faces]
