# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints of parts are found by themselves: which, of what kind, where they end, and each once."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.errors import RefusedError
from ffds_workbench.seams.plan import plan_seams


def box(size, at) -> Part.Shape:
    return Part.makeBox(*size, FreeCAD.Vector(*at))


def seams(*parts, tolerance: float = 0.05) -> list:
    return [seam.stations for seam in plan_seams(Part.makeCompound(list(parts)), auto=tolerance).seams]


def along(found, point) -> object:
    """The seam that passes through a point."""
    near = [seam for seam in found if np.linalg.norm(seam.positions - point, axis=1).min() < 5.0 / 2 + 0.1]
    assert len(near) == 1
    return near[0]


def test_t_joint_has_two_long_fillets_and_two_ends():
    found = seams(box((100, 60, 6), (0, 0, 0)), box((80, 6, 40), (10, 27, 6)))
    assert sorted(round(seam.length) for seam in found) == [6, 6, 80, 80]
    assert {seam.seam.kind for seam in found} == {"T"}
    for y, side in ((27, 1.0), (33, -1.0)):
        seam = along(found, (50, y, 6))
        assert np.degrees(seam.opening) == pytest.approx(90.0, abs=1e-6)
        # The torch comes at 45° from the free side.
        assert seam.torch[:, :, 2] == pytest.approx(np.tile([0.0, side * 0.5**0.5, -0.5**0.5], (len(seam), 1)))


def test_lap_joint():
    found = seams(box((100, 60, 4), (0, 0, 0)), box((80, 60, 4), (10, 30, 4)))
    front = along(found, (50, 30, 4))
    assert front.seam.kind == "lap" and front.length == pytest.approx(80.0)
    # The sides lie on the lower plate over 30 of their 60 mm; beyond its border there is no seam.
    sides = [seam for seam in found if round(seam.length) == 30]
    assert len(sides) == 2
    for seam in sides:
        assert seam.positions[:, 1].max() == pytest.approx(60.0, abs=0.02)
    # The lower plate's rear border lies on the upper plate from below.
    rear = along(found, (50, 60, 4))
    assert rear.torch[0, :, 2] == pytest.approx([0.0, -0.5**0.5, 0.5**0.5])


def test_butt_joint_is_found_once_on_each_side():
    found = seams(box((50, 60, 5), (0, 0, 0)), box((50, 60, 5), (50, 0, 0)))
    assert sorted(round(seam.length) for seam in found) == [5, 5, 60, 60]
    assert {seam.seam.kind for seam in found} == {"butt"}
    top = along(found, (50, 30, 5))
    assert np.degrees(top.opening) == pytest.approx(180.0, abs=1e-6)
    assert top.torch[0, :, 2] == pytest.approx([0.0, 0.0, -1.0])


def test_corner_joint():
    found = seams(box((60, 5, 40), (0, 0, 0)), box((60, 35, 5), (0, 5, 35)))
    outside, inside = along(found, (30, 5, 40)), along(found, (30, 5, 35))
    assert outside.seam.kind == "butt"
    assert inside.seam.kind == "T"
    tilted = box((60, 35, 5), (0, 5, 40))
    tilted.rotate(FreeCAD.Vector(0, 5, 40), FreeCAD.Vector(1, 0, 0), 45)
    open_corner = along(seams(box((60, 5, 40), (0, 0, 0)), tilted), (30, 5, 40))
    assert open_corner.seam.kind == "corner"


def test_pipe_on_plate_inside_and_outside(pipe_on_plate):
    found = [seam.stations for seam in plan_seams(pipe_on_plate, auto=0.05).seams]
    assert [round(seam.length, 3) for seam in found] == [round(2 * np.pi * 20, 3), round(2 * np.pi * 17, 3)]
    outer = found[0]
    outwards = outer.positions / np.linalg.norm(outer.positions, axis=1, keepdims=True)
    assert outer.torch[:, :, 2] == pytest.approx((-outwards + [0, 0, -1]) / 2**0.5, abs=1e-9)
    # n1 is the lower-numbered face's: the plate's top.
    assert outer.n1 == pytest.approx(np.tile([0.0, 0.0, 1.0], (len(outer), 1)))


def test_tolerance_decides():
    parts = box((100, 60, 6), (0, 0, 0)), box((80, 6, 40), (10, 27, 6.4))
    with pytest.raises(RefusedError, match="no part lies on another|No part lies on another"):
        seams(*parts, tolerance=0.3)
    found = seams(*parts, tolerance=0.5)
    assert along(found, (50, 27, 6.4)).gap == pytest.approx(0.4, abs=1e-9)


def test_wall_that_is_buried_on_one_side_has_a_seam_on_the_other():
    """A wall in a corner: where two plates and the wall fill the space there is no air, so no seam."""
    found = seams(box((100, 60, 6), (0, 0, 0)), box((100, 6, 40), (0, 0, 6)), box((100, 6, 20), (0, 6, 6)))
    assert not [seam for seam in found if np.abs(seam.positions[:, 1:] - [6, 6]).max() < 1e-6]
    assert along(found, (50, 12, 6)).seam.kind == "T"


def test_named_edge_of_a_joint_has_the_faces_of_both_parts(pipe_on_plate, tools):
    name = tools.edge_at(pipe_on_plate, (0, 20, 0))
    by_name = plan_seams(pipe_on_plate, [name]).seams[0].stations
    found = plan_seams(pipe_on_plate, [name], auto=0.05).seams[0].stations
    assert by_name.torch == pytest.approx(found.torch)
    assert np.abs(by_name.gap).max() < 1e-9
