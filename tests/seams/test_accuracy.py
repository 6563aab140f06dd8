# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams of parts deformed by a known warp against the warp's own image of the nominal seam.

The rebuild keeps surfaces within 4e-6 mm and is not what is tested here, so the limits are far below what a scan allows
(0.05 mm, 0.3°, 0.5°): 1e-4 mm, and 0.02° for directions, which are the derivatives of a fit to 4e-6 mm over a few mm.
"""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.seams.plan import plan_seams
from ffds_workbench.seams.settings import SeamSettings

POSITION, DIRECTION = 1e-4, 0.02


def assert_true(tools, seam, warp) -> None:
    found, nominal = seam.stations, seam.nominal
    truth = tools.truth_of(warp, nominal)
    assert np.linalg.norm(found.positions - truth.points, axis=1).max() < POSITION
    assert tools.degrees_between(found.tangents, truth.tangents).max() < DIRECTION
    assert tools.degrees_between(found.n1, truth.n1).max() < DIRECTION
    assert tools.degrees_between(found.n2, truth.n2).max() < DIRECTION
    assert tools.degrees_between(found.bisector, truth.frames).max() < DIRECTION


def test_hollow_edge_of_a_bracket(bracket, tools):
    name = tools.edge_at(bracket, (35, 4, 4))
    plan = plan_seams(tools.warped(bracket, tools.bumpy), [name], nominal=bracket)
    (seam,) = plan.seams
    assert seam.name == name and not seam.stations.seam.closed
    assert_true(tools, seam, tools.bumpy)
    assert np.isnan(seam.stations.gap).all()
    # Nominal: two walls at 90°, the torch in between, pointing to −y, −z.
    assert np.degrees(seam.nominal.opening) == pytest.approx(90.0, abs=1e-6)
    assert seam.nominal.bisector[:, :, 2] == pytest.approx(np.tile([0, -0.5**0.5, -0.5**0.5], (len(seam.nominal), 1)))


def test_outer_edge_of_a_bracket_opens_to_270_degrees(bracket, tools):
    (seam,) = plan_seams(bracket, [tools.edge_at(bracket, (35, 0, 0))]).seams
    assert np.degrees(seam.stations.opening) == pytest.approx(270.0, abs=1e-6)
    assert np.degrees(seam.stations.work_angle) == pytest.approx(135.0, abs=1e-6)


def test_pipe_on_plate(pipe_on_plate, as_built, tools):
    plan = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate)
    assert [seam.stations.seam.kind for seam in plan.seams] == ["pipe", "pipe"]
    for seam in plan.seams:
        assert seam.stations.seam.closed
        assert_true(tools, seam, tools.bumpy)
        assert np.abs(seam.stations.gap).max() < POSITION


def test_gap_of_a_lifted_and_tilted_pipe(pipe_on_plate, tools):
    """The plate stays at z = 0, so the gap is the height of the pipe's lower edge, negative where it sinks in."""
    turn = FreeCAD.Placement(FreeCAD.Vector(0, 0, 0.25), FreeCAD.Rotation(FreeCAD.Vector(1, 0.4, 0), 1.0)).Matrix
    matrix = np.array(turn.A).reshape(4, 4)

    def lift(points):
        return points @ matrix[:3, :3].T + matrix[:3, 3]

    lifted = tools.warped(pipe_on_plate, lift, list(range(6, 10)))
    plan = plan_seams(lifted, auto=0.1, nominal=pipe_on_plate)
    outer = plan.seams[0]
    truth = lift(outer.nominal.positions)[:, 2]
    assert truth.min() < -0.05 and truth.max() > 0.4
    # Less exact than the positions: the foot is that of OCCT's distance, to its own 1e-7.
    assert outer.stations.gap == pytest.approx(truth, abs=1e-4)
    assert plan.seams[0].exceeded(plan.limits) == ["gap"]


def test_offsets_of_a_pipe_moved_as_a_whole(pipe_on_plate, tools):
    shift = np.array([0.3, -0.2, 0.1])
    moved = tools.warped(pipe_on_plate, lambda points: points + shift)
    seam = plan_seams(moved, auto=0.1, nominal=pipe_on_plate).seams[0]
    x, y, z = (seam.nominal.bisector[:, :, axis] for axis in range(3))
    assert seam.offsets.longitudinal == pytest.approx(x @ shift, abs=1e-5)
    assert seam.offsets.lateral == pytest.approx(y @ shift, abs=1e-5)
    assert seam.offsets.normal == pytest.approx(-z @ shift, abs=1e-5)
    assert np.degrees(seam.offsets.rotation).max() < DIRECTION
    assert np.degrees(np.abs(seam.offsets.opening_change)).max() < DIRECTION


def test_rotation_and_opening_of_a_tilted_wall(tools):
    """The wall turns by 2° about the seam: the opening grows by 2°, and the bisector turns by half of it."""
    plate, wall = Part.makeBox(60, 40, 5), Part.makeBox(60, 5, 30, FreeCAD.Vector(0, 10, 5))
    shape = Part.makeCompound([plate, wall])
    angle = np.radians(2.0)
    c, s = np.cos(angle), np.sin(angle)

    def tilt(points):
        y, z = points[:, 1] - 10.0, points[:, 2] - 5.0
        return np.stack([points[:, 0], 10.0 + c * y + s * z, 5.0 - s * y + c * z], axis=1)

    name = tools.edge_at(shape, (30, 10, 5))
    seam = plan_seams(tools.warped(shape, tilt, list(range(6, 12))), [name], nominal=shape).seams[0]
    assert seam.stations.seam.kind == "T"
    assert np.degrees(seam.offsets.opening_change) == pytest.approx(2.0, abs=DIRECTION)
    assert np.degrees(seam.offsets.rotation) == pytest.approx(1.0, abs=DIRECTION)


def test_stations_keep_step_and_chord(as_built, pipe_on_plate):
    settings = SeamSettings(step=4.0, chord=0.02)
    seam = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate, settings=settings).seams[0].stations
    chords = np.linalg.norm(np.diff(seam.positions, axis=0), axis=1)
    assert chords.max() < 4.0
    edge = as_built.Edges[seam.seam.stretches[0].edge]
    start, end = edge.ParameterRange
    middle = 0.5 * (seam.places.fraction[1:] + seam.places.fraction[:-1])
    between = np.array([tuple(edge.valueAt(start + t * (end - start))) for t in middle])
    sagitta = np.linalg.norm(between - 0.5 * (seam.positions[1:] + seam.positions[:-1]), axis=1)
    # The middle in parameter is not quite the middle in length: 5 % on top.
    assert sagitta.max() < 0.02 * 1.05
    assert seam.length == pytest.approx(edge.Length, rel=1e-6)
    assert (np.diff(seam.places.arc_length) > 0).all()


def test_work_and_travel_angle(bracket, tools):
    settings = SeamSettings(work_angle=np.radians(10.0), travel_angle=np.radians(15.0))
    (seam,) = plan_seams(bracket, [tools.edge_at(bracket, (35, 4, 4))], settings=settings).seams
    stations = seam.stations
    torch, travel = stations.torch[0, :, 2], stations.tangents[0]
    # A push points the torch forwards by the travel angle, whatever the work angle.
    assert np.degrees(np.arcsin(torch @ travel)) == pytest.approx(15.0)
    across = torch - (torch @ travel) * travel
    to_face = np.degrees(np.arcsin(-across @ stations.n1[0] / np.linalg.norm(across)))
    assert np.degrees(stations.work_angle[0]) == pytest.approx(to_face)
    assert abs(to_face - 45.0) == pytest.approx(10.0)
