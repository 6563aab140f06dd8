# SPDX-License-Identifier: LGPL-2.1-or-later
"""The check for Boolean operations against bodies that were made to touch or to cross each other or themselves."""
from __future__ import annotations

import math
from types import SimpleNamespace

import Part
import pytest
from FreeCAD import Vector

from ffds_workbench.report import boolean_check
from ffds_workbench.report.boolean_check import BooleanChecks, boolean_checks, total

LIMIT = 30


def box(x: float, y: float = 0.0, z: float = 0.0) -> Part.Shape:
    return Part.makeBox(10, 10, 10, Vector(x, y, z))


def crossing() -> Part.Shape:
    """A prism over the bow tie (0, 0), (10, 10), (10, 0), (0, 10): two of its side walls cross."""
    corners = [Vector(*corner, 0) for corner in ((0, 0), (10, 10), (10, 0), (0, 10), (0, 0))]
    walls = Part.makePolygon(corners).extrude(Vector(0, 0, 5))
    return Part.Shell(walls.Faces)


@pytest.mark.parametrize("second", [box(10), box(10, 3, 3), box(5, 5, 5), Part.makeSphere(4, Vector(10, 5, 5))],
                         ids=["face on face", "face on part of a face", "overlapping", "sphere in a wall"])
def test_bodies_that_touch_are_sound(second):
    assert boolean_checks((Part.makeCompound([box(0), second]),), LIMIT) == ((0, 0),)


def test_a_body_that_crosses_itself_is_found_wherever_it_lies():
    inner = Part.makeCompound([crossing(), box(0, 0, 30)])
    (alone,), nested = boolean_checks((crossing(), Part.makeCompound([box(20), inner])), LIMIT)
    assert alone > 0
    assert nested == (0, alone, 0)
    assert total(nested) == alone


def test_a_check_without_time_does_not_finish():
    found, = boolean_checks((Part.makeCompound([box(0), box(20)]),), 0.0)
    assert found == (None, None)
    assert total(found) is None


def test_a_check_that_ended_in_time_counts_however_late_it_is_asked_for(monkeypatch):
    checks = BooleanChecks(LIMIT)
    checks.begin(box(0))
    checks._processes[0].wait()
    monkeypatch.setattr(boolean_check, "time", SimpleNamespace(monotonic=lambda: math.inf))
    assert checks.errors() == ((0,),)


def test_a_check_that_is_kept_is_not_done_again():
    """A nominal part is checked with the first scan of it; its copy is another shape, and checked by itself."""
    nominal = crossing()
    first, second = BooleanChecks(LIMIT), BooleanChecks(LIMIT)
    first.begin(nominal, keep=True)
    found = first.errors()
    assert total(found[0]) > 0
    second.begin(nominal)
    second.begin(box(0))
    assert len(second._processes) == 1 and second.errors() == (*found, (0,))
