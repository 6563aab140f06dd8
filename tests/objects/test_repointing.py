# SPDX-License-Identifier: LGPL-2.1-or-later
"""References to a nominal part are carried over to the as-built one, where they can be computed on it.

The plate's upper face is lifted by 1 mm in the middle: what sits on it or is cut from it shows that.
"""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.api import certified
from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.objects import actions, scans
from ffds_workbench.objects.repointing import references

SUPPORT = "Support" if FreeCAD.Version()[0] == "0" else "AttachmentSupport"


def attach(item, support, mode: str) -> None:
    item.addExtension("Part::AttachExtensionPython")
    setattr(item, SUPPORT, [support])
    item.MapMode = mode


@pytest.fixture
def lifted(monkeypatch):
    """A document with a plate, objects that refer to it, and its as-built part."""
    monkeypatch.setattr(certified, "BOOLEAN_CHECK_SECONDS", 0.05)
    document = FreeCAD.newDocument("repointing")
    document.UndoMode = 1
    plate = document.addObject("Part::Box", "Plate")
    plate.Length, plate.Width, plate.Height = 60, 40, 5
    drill = document.addObject("Part::Cylinder", "Drill")
    drill.Radius, drill.Height = 2, 30
    drill.Placement.Base = FreeCAD.Vector(30, 20, -5)
    cut = document.addObject("Part::Cut", "Cut")
    cut.Base, cut.Tool = plate, drill
    plane = document.addObject("Part::Plane", "Plane")
    attach(plane, (plate, "Vertex2"), "Translate")
    flat = document.addObject("Part::Plane", "Flat")
    attach(flat, (plate, "Face6"), "FlatFace")
    group = document.addObject("App::Part", "Group")
    link = document.addObject("App::Link", "Link")
    link.LinkedObject = plate
    document.recompute()
    random = np.random.default_rng(1)
    x, y = random.uniform((0, 0), (60, 40), (4000, 2)).T
    z = 5 + np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2))
    scan = scans.add_scan(document, np.stack([x, y, z], axis=1), "scan")
    yield document, group, actions.make_as_built(plate, scan, faces=["Face6"], lattice=(8, 8))
    FreeCAD.closeDocument(document.Name)


def test_a_cut_and_an_attachment_follow_and_one_undo_takes_it_back(lifted):
    document, _, item = lifted
    plate, cut, plane, link = (document.getObject(name) for name in ("Plate", "Cut", "Plane", "Link"))
    document.openTransaction("Re-point references")
    changed = actions.repoint(item)
    document.commitTransaction()
    assert {user.Name for user in changed} == {"Cut", "Plane"}
    assert cut.Base is item and getattr(plane, SUPPORT) == [(item, ("Vertex2",))] and link.LinkedObject is plate
    assert cut.isValid() and cut.Shape.distToShape(Part.Vertex(27, 20, 20))[0] == pytest.approx(14.03, abs=0.02)
    flat = document.getObject("Flat")
    assert flat.isValid() and getattr(flat, SUPPORT) == [(plate, ("Face6",))], "it needs a face that is flat"
    assert [reference.item for reference in references(item)] == [flat] and item.Source is plate
    with pytest.raises(RefusedError, match=r"^Flat cannot be computed on .*, and nothing was re-pointed: \w.+\.$"):
        actions.repoint(item)
    document.undo()
    assert cut.Base is plate and getattr(plane, SUPPORT) == [(plate, ("Vertex2",))]


def test_what_the_part_is_made_from_does_not_turn_in_a_circle(lifted):
    document, _, item = lifted
    document.removeObject("Cut")
    document.removeObject("Plane")
    document.removeObject("Flat")
    assert not references(item)
    with pytest.raises(InputError, match="Nothing refers"):
        actions.repoint(item)


def test_other_objects_are_refused(lifted):
    document, _, _ = lifted
    with pytest.raises(InputError, match="no as-built part"):
        actions.repoint(document.Plate)
