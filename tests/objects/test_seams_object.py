# SPDX-License-Identifier: LGPL-2.1-or-later
"""The seams object without a GUI: it follows its part, survives a file, writes programs, and refuses without a trace.

The weldment is a pipe of radius 20 on a plate; its as-built state is moved as a whole, so all figures are known.
"""
from __future__ import annotations

import math

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.objects import actions, scans
from ffds_workbench.objects.seams import is_seams, stations_of

CIRCLE = 2.0 * math.pi * 20.0
CHORD = 0.05
"""Polylines keep within this of the seam (mm): their length falls short of it by less than 0.5 %."""


@pytest.fixture
def document():
    created = FreeCAD.newDocument("seams_test")
    created.UndoMode = 1
    yield created
    FreeCAD.closeDocument(created.Name)


def pipe_on_plate(lift: float = 0.0, shift: float = 0.0) -> Part.Shape:
    plate = Part.makeBox(80, 80, 8, FreeCAD.Vector(-40, -40, -8))
    tube = Part.makeCylinder(20, 40).cut(Part.makeCylinder(17, 40)).Solids[0]
    tube.translate(FreeCAD.Vector(shift, 0, lift))
    return Part.makeCompound([plate, tube])


def add(document, name: str, shape: Part.Shape):
    item = document.addObject("Part::Feature", name)
    item.Shape = shape
    return item


def foot(shape: Part.Shape) -> str:
    """The outer circle at the pipe's foot."""
    names = [f"Edge{number}" for number, edge in enumerate(shape.Edges, 1)
             if abs(edge.Length - CIRCLE) < 1e-6 and edge.CenterOfMass.z < 20]
    return names[0]


def test_seams_cannot_be_moved_off_their_part(document):
    item = actions.make_seams(add(document, "Pipe", pipe_on_plate()), tolerance=0.05)
    item.Placement = FreeCAD.Placement(FreeCAD.Vector(30, 0, 0), FreeCAD.Rotation())
    assert item.Placement.isIdentity() and "ReadOnly" in item.getEditorMode("Placement")
    assert item.Shape.BoundBox.XMax == pytest.approx(20, abs=CHORD)


def test_joints_within_a_tolerance_become_lines_with_stations(document):
    part = add(document, "Pipe", pipe_on_plate())
    item = actions.make_seams(part, tolerance=0.05)
    assert item.isValid() and is_seams(item) and len(item.Verdicts) == len(item.Shape.Wires) == 2
    assert item.Shape.Wires[0].Length == pytest.approx(CIRCLE, rel=0.005)
    stations = stations_of(item)
    first = stations["seam"] == 1
    assert np.hypot(stations["x"], stations["y"])[first] == pytest.approx(20.0, abs=1e-6)
    assert np.abs(stations["gap"]).max() < 1e-6


def test_the_figures_are_those_of_a_known_move_and_limits_decide(document):
    nominal, part = add(document, "Nominal", pipe_on_plate()), add(document, "Built", pipe_on_plate(0.4, 0.0))
    item = actions.make_seams(part, edges=[foot(part.Shape)], nominal=nominal)
    gap = stations_of(item)["gap"]
    assert gap == pytest.approx(0.4, abs=1e-6)
    assert item.Verdicts[0].endswith("pass")
    item.LimitGap = 0.3
    document.recompute()
    assert item.Verdicts[0].endswith("fail: gap")


def test_it_follows_its_part_and_keeps_its_last_seams_when_that_fails(document):
    part = add(document, "Pipe", pipe_on_plate())
    item = actions.make_seams(part, edges=[foot(part.Shape)])
    part.Shape = pipe_on_plate(0.0, 3.0)
    document.recompute()
    assert item.isValid() and stations_of(item)["x"].max() == pytest.approx(23.0, abs=CHORD)
    item.Edges = [(part, ("Edge99",))]
    document.recompute()
    assert not item.isValid() and "There is no Edge99" in item.getStatusString()
    assert len(item.Shape.Wires) == 1
    item.Edges = [(part, (foot(part.Shape),))]
    item.Step = 0.0
    document.recompute()
    assert not item.isValid() and "step" in item.getStatusString()
    item.Step = 2.0
    document.recompute()
    assert item.isValid() and len(stations_of(item)["s"]) > CIRCLE / 2.0


def test_an_as_built_part_brings_its_nominal_one_and_what_the_scan_saw(document):
    plate = add(document, "Plate", Part.makeBox(60, 40, 5))
    x, y = np.random.default_rng(1).uniform((0, 0), (60, 40), (5000, 2)).T
    bump = np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2))
    built = actions.make_as_built(plate, scans.add_scan(document, np.stack([x, y, 5 + bump], axis=1), "scan"),
                                  faces=["Face6"])
    edge = next(f"Edge{n}" for n, edge in enumerate(plate.Shape.Edges, 1)
                if (edge.CenterOfMass - FreeCAD.Vector(30, 0, 5)).Length < 1e-6)
    item = actions.make_seams(built, edges=[edge])
    stations = stations_of(item)
    assert item.Nominal is plate and "lateral" in stations
    assert set(stations["flag"]) <= {"observed", "bridged", "carried", "nominal"}
    # The bump is 0.25 mm high at the middle of the edge; the registration's noise-free fit is good to 0.05 mm.
    assert stations["z"].max() == pytest.approx(5 + np.exp(-20**2 / (2 * 12**2)), abs=0.05)


def test_it_follows_the_group_that_holds_its_part(document):
    part, group = add(document, "Pipe", pipe_on_plate()), document.addObject("App::Part", "Group")
    group.addObject(part)
    group.Placement.Base.x = 100
    document.recompute()
    item = actions.make_seams(part, edges=[foot(part.Shape)])
    assert stations_of(item)["x"].max() == pytest.approx(120.0, abs=CHORD)
    group.Placement.Base.x = 200
    document.recompute()
    assert stations_of(item)["x"].max() == pytest.approx(220.0, abs=CHORD)


def test_start_direction_and_torch_are_properties(document):
    part = add(document, "Pipe", pipe_on_plate())
    item = actions.make_seams(part, edges=[foot(part.Shape)])
    item.StartHere, item.Start, item.WorkAngle, item.Reverse = True, FreeCAD.Vector(0, 30, 0), 10, True
    document.recompute()
    stations = stations_of(item)
    assert (stations["x"][0], stations["y"][0]) == pytest.approx((0.0, 20.0), abs=1e-3)
    assert abs(stations["work_angle"][0] - 45.0) == pytest.approx(10.0, abs=0.1)


def test_a_file_brings_it_back_whole(document, tmp_path):
    part = add(document, "Pipe", pipe_on_plate())
    item = actions.make_seams(part, tolerance=0.05)
    document.saveCopy(str(tmp_path / "seams.FCStd"))
    again = FreeCAD.openDocument(str(tmp_path / "seams.FCStd"), True)
    try:
        copy = again.getObject(item.Name)
        assert is_seams(copy) and copy.Table == item.Table and len(copy.Shape.Wires) == 2
        again.getObject(part.Name).touch()
        again.recompute()
        assert copy.isValid() and copy.Table == item.Table
    finally:
        FreeCAD.closeDocument(again.Name)


def test_programs_by_suffix_and_trajectories(document, tmp_path):
    part = add(document, "Pipe", pipe_on_plate())
    item = actions.make_seams(part, edges=[foot(part.Shape)])
    item.Velocity = "8 mm/s"
    for suffix in ("src", "mod", "script", "csv", "FCStd", "json", "png"):
        actions.export_program(item, str(tmp_path / f"weld.{suffix}"))
        assert (tmp_path / f"weld.{suffix}").stat().st_size > 0
    assert (tmp_path / "weld.dat").exists()
    with pytest.raises(InputError, match="unknown format"):
        actions.export_program(item, str(tmp_path / "weld.txt"))
    trajectory, = actions.add_trajectories(item)
    stations = stations_of(item)
    waypoints = trajectory.Trajectory.Waypoints
    assert len(waypoints) == len(stations["s"]) + 2
    assert tuple(waypoints[2].Pos.Base) == pytest.approx([stations[axis][1] for axis in "xyz"], abs=1e-5)
    assert waypoints[2].Velocity == pytest.approx(8.0)
    item.Tool = "no tool!"
    with pytest.raises(InputError, match="no tool or base"):
        actions.add_trajectories(item)
    with pytest.raises(InputError, match="holds no seams"):
        actions.add_trajectories(part)


def test_one_undo_takes_it_back(document):
    part = add(document, "Pipe", pipe_on_plate())
    document.openTransaction("seams")
    actions.make_seams(part, tolerance=0.05)
    document.commitTransaction()
    document.undo()
    assert [item.Name for item in document.Objects] == [part.Name]
    document.redo()
    assert document.Objects[1].isValid() and len(document.Objects[1].Shape.Wires) == 2


@pytest.mark.parametrize("arguments", [{"edges": ["Edge99"]}, {"edges": ["Face1"]}, {"tolerance": -1.0}, {}])
def test_what_cannot_be_used_is_refused_with_a_sentence_and_leaves_nothing(document, arguments):
    part = add(document, "Pipe", pipe_on_plate())
    with pytest.raises((InputError, RefusedError)) as refusal:
        actions.make_seams(part, **arguments)
    assert str(refusal.value).endswith(".") and "\n" not in str(refusal.value)
    assert [item.Name for item in document.Objects] == [part.Name]


def test_edges_of_another_part_are_refused(document):
    part, other = add(document, "Pipe", pipe_on_plate()), add(document, "Other", pipe_on_plate())
    item = actions.make_seams(part, tolerance=0.05)
    item.Edges = [(other, ("Edge1",))]
    document.recompute()
    assert not item.isValid() and "edges of one part" in item.getStatusString()
