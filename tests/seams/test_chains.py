# SPDX-License-Identifier: LGPL-2.1-or-later
"""Chains, closed seams, direction and start; and what is refused."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.seams.frames import quaternions
from ffds_workbench.seams.plan import plan_seams
from ffds_workbench.seams.settings import SeamSettings


def test_full_circle_starts_where_asked_and_closes(as_built, pipe_on_plate, tools):
    start = np.array([-12.0, 16.0, 0.0])
    for reverse in (False, True):
        settings = SeamSettings(start=tuple(start), reverse=reverse)
        found = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate, settings=settings).seams[0].stations
        edge = as_built.Edges[found.seam.stretches[0].edge]
        nearest = edge.distToShape(Part.Vertex(*start))[1][0][0]
        assert found.positions[0] == pytest.approx(tuple(nearest), abs=1e-3)
        assert found.positions[-1] == pytest.approx(found.positions[0], abs=1e-5)
        assert tools.degrees_between(found.torch[:1], found.torch[-1:])[0] < 0.01
        # One turn in all, evenly: 360° over the stations, the warp bends the axis by some degrees.
        turns = tools.degrees_between(found.torch[1:], found.torch[:-1])
        assert turns.max() < 2.0 * 360.0 / len(turns)
        assert np.linalg.norm(np.diff(quaternions(found.torch), axis=0), axis=1).max() < 0.3
        angle = np.unwrap(np.arctan2(found.positions[:, 1], found.positions[:, 0]))
        assert np.degrees(angle[-1] - angle[0]) == pytest.approx(-360.0 if reverse else 360.0, abs=0.1)


def slotted_plate() -> Part.Shape:
    """A plate with rounded corners: its upper border is a chain of four lines and four arcs."""
    plate = Part.makeBox(60, 40, 5)
    upright = [edge for edge in plate.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.9]
    return plate.makeFillet(8, upright).Solids[0]


def test_chain_along_tangency(tools):
    plate = slotted_plate()
    name = tools.edge_at(plate, (30, 0, 5))
    (seam,) = plan_seams(plate, [name], chain=True).seams
    assert len(seam.stations.seam.stretches) == 8 and seam.stations.seam.closed
    assert seam.stations.length == pytest.approx(2 * (44 + 24) + 2 * np.pi * 8, rel=1e-9)
    assert tools.degrees_between(seam.stations.torch[1:], seam.stations.torch[:-1]).max() < 15.0
    assert seam.stations.positions[-1] == pytest.approx(seam.stations.positions[0], abs=1e-9)
    # Named one by one they are the same seam.
    names = [stretch.name for stretch in seam.stations.seam.stretches]
    (again,) = plan_seams(plate, names[::-1]).seams
    assert again.stations.positions == pytest.approx(seam.stations.positions, abs=1e-9)


def test_start_of_an_open_seam_is_the_nearer_end(bracket, tools):
    name = tools.edge_at(bracket, (35, 4, 4))
    for x in (0.0, 70.0):
        (seam,) = plan_seams(bracket, [name], settings=SeamSettings(start=(x, 4.0, 4.0))).seams
        assert seam.stations.positions[0] == pytest.approx([x, 4.0, 4.0])
    assert seam.stations.torch[0, :, 0] == pytest.approx([-1.0, 0.0, 0.0])


def test_edges_that_meet_at_a_corner_are_two_seams(tools):
    box = Part.makeBox(30, 20, 10)
    plan = plan_seams(box, [tools.edge_at(box, (15, 0, 10)), tools.edge_at(box, (0, 10, 10))])
    assert len(plan.seams) == 2


def test_branching_is_refused(tools):
    box = Part.makeBox(30, 20, 10)
    names = [tools.edge_at(box, point) for point in ((15, 0, 10), (0, 10, 10), (0, 0, 5))]
    with pytest.raises(RefusedError, match="does not branch"):
        plan_seams(box, names)


def test_pole_and_seam_line_are_refused():
    sphere = Part.makeSphere(10)
    pole = next(i for i, edge in enumerate(sphere.Edges, 1) if edge.Degenerated)
    line = next(i for i, edge in enumerate(sphere.Edges, 1) if not edge.Degenerated)
    with pytest.raises(RefusedError, match="is a point"):
        plan_seams(sphere, [f"Edge{pole}"])
    with pytest.raises(RefusedError, match="one adjacent face only"):
        plan_seams(sphere, [f"Edge{line}"])


def test_open_border_and_lonely_edge_are_refused():
    face = Part.makePlane(10, 10)
    with pytest.raises(RefusedError, match="one adjacent face only"):
        plan_seams(face, ["Edge1"])
    with pytest.raises(RefusedError, match="no adjacent faces"):
        plan_seams(Part.makeCompound([face, Part.makeLine((20, 0, 0), (30, 0, 0))]), ["Edge5"])


def test_short_unknown_and_unnamed_are_refused(tools):
    box = Part.makeBox(30, 20, 1)
    with pytest.raises(RefusedError, match=r"only 1 mm long"):
        plan_seams(box, [tools.edge_at(box, (0, 0, 0.5))])
    with pytest.raises(InputError, match="Edge1 to Edge12"):
        plan_seams(box, ["Edge13"])
    with pytest.raises(InputError, match="No seam was named"):
        plan_seams(box)
    with pytest.raises(RefusedError, match="single part"):
        plan_seams(box, auto=0.5)


def test_faces_back_to_back_are_refused():
    triangle = Part.Face(Part.makePolygon([(0, 0, 0), (50, 0, 0), (50, 0, 2), (0, 0, 0)]))
    wedge = triangle.extrude(FreeCAD.Vector(0, 30, 0))
    edge = next(i for i, e in enumerate(wedge.Edges, 1) if all(abs(v.X) < 1e-9 for v in e.Vertexes))
    with pytest.raises(RefusedError, match="back to back"):
        plan_seams(wedge, [f"Edge{edge}"])


def test_another_parts_nominal_is_refused(bracket, pipe_on_plate):
    with pytest.raises(InputError, match="name the nominal model"):
        plan_seams(pipe_on_plate, ["Edge1"], nominal=bracket)
