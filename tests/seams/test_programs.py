# SPDX-License-Identifier: LGPL-2.1-or-later
"""Robot programs: fixed poses worked out by hand from the makers' definitions, and every file read back.

The readers here use the definitions as products of elementary matrices, not the project's conversions.
"""
from __future__ import annotations

import csv
import io
import math
import re

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.seams.output.writing import write_seams
from ffds_workbench.seams.plan import plan_seams
from ffds_workbench.seams.programs.angles import (abb_quaternions, from_kuka_angles, kuka_angles,
                                                       ur_rotation_vectors)
from ffds_workbench.seams.programs.moves import RobotSettings, moves, read_frame_choice

R = 0.5**0.5
HAND = [
    # Axes x, y, z of the tool; KUKA's A, B, C; ABB's q1…q4; UR's rotation vector over π.
    # Nothing turned.
    (((1, 0, 0), (0, 1, 0), (0, 0, 1)), (0, 0, 0), (1, 0, 0, 0), (0, 0, 0)),
    # Torch straight down, travelling along +Y: half a turn about the diagonal of X and Y.
    (((0, 1, 0), (1, 0, 0), (0, 0, -1)), (90, 0, 180), (0, R, R, 0), (R, R, 0)),
    # Fillet between a floor and a wall that faces −Y, travelling along +X: z = (0, 1, −1)/√2, so −135° about X.
    (((1, 0, 0), (0, -R, -R), (0, R, -R)), (0, 0, -135),
     (math.cos(math.radians(67.5)), -math.sin(math.radians(67.5)), 0, 0), (-0.75, 0, 0)),
    # A quarter turn about Z.
    (((0, 1, 0), (-1, 0, 0), (0, 0, 1)), (90, 0, 0), (R, 0, 0, R), (0, 0, 0.5)),
    # KUKA's singular pose, B = 90°: x points down. A is free; with C = 0 it is 0.
    (((0, 0, -1), (0, 1, 0), (1, 0, 0)), (0, 90, 0), (R, 0, R, 0), (0, 0.5, 0)),
    # A third of a turn about the space diagonal: x → y → z → x. Its x has no X or Z part, so A = 90, B = 0, and C = 90.
    (((0, 1, 0), (0, 0, 1), (1, 0, 0)), (90, 0, 90), (0.5, 0.5, 0.5, 0.5), (2 / 3 / 3**0.5,) * 3),
]


@pytest.mark.parametrize(("axes", "abc", "quaternion", "vector"), HAND)
def test_poses_worked_out_by_hand(axes, abc, quaternion, vector):
    rotation = np.array(axes, dtype=float).T[None]
    # As many digits as the programs are written with: near B = ±90° an arcsine has no more.
    assert kuka_angles(rotation)[0] == pytest.approx(abc, abs=5e-6)
    assert from_kuka_angles(np.array([abc], dtype=float))[0] == pytest.approx(rotation[0], abs=1e-12)
    assert abb_quaternions(rotation)[0] == pytest.approx(quaternion, abs=1e-9)
    assert ur_rotation_vectors(rotation)[0] == pytest.approx(np.pi * np.array(vector), abs=1e-9)


def elementary(axis: int, degrees: float) -> np.ndarray:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def from_abc(a, b, c) -> np.ndarray:
    return elementary(2, a) @ elementary(1, b) @ elementary(0, c)


def from_quaternion(w, x, y, z) -> np.ndarray:
    assert math.hypot(w, x, y, z) == pytest.approx(1.0, abs=1e-6)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def from_vector(x, y, z) -> np.ndarray:
    angle = math.hypot(x, y, z)
    if angle == 0:
        return np.eye(3)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) / angle
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


NUMBER = r"(-?[\d.]+)"


def read_krl(source: str, data: str) -> list:
    frames = {}
    pose = ",".join(f"{key} {NUMBER}" for key in "XYZABC")
    for name, *values in re.findall(rf"DECL FRAME (\w+)=\{{{pose}\}}", data):
        numbers = list(map(float, values))
        frames[name] = (numbers[:3], from_abc(*numbers[3:]))
    return [frames[name] for name in re.findall(r"^(?:PTP|LIN) (XS\w+)", source, re.M)]


def read_rapid(text: str) -> list:
    targets = {}
    pattern = rf"CONST robtarget (\w+):=\[\[{NUMBER},{NUMBER},{NUMBER}\],\[{NUMBER},{NUMBER},{NUMBER},{NUMBER}\],"
    for name, *values in re.findall(pattern, text):
        numbers = list(map(float, values))
        targets[name] = (numbers[:3], from_quaternion(*numbers[3:]))
    return [targets[name] for name in re.findall(r"^\s+Move[JL] (\w+),", text, re.M)]


def read_urscript(text: str) -> list:
    poses = []
    for values in re.findall(rf"move[jl]\((?:pose_trans\(model_frame, )?p\[{','.join([NUMBER] * 6)}\]", text):
        numbers = list(map(float, values))
        poses.append(([1000 * value for value in numbers[:3]], from_vector(*numbers[3:])))
    return poses


def read_csv(text: str) -> list:
    rows = list(csv.DictReader(io.StringIO(text)))
    return [([float(row[k]) for k in "xyz"], from_quaternion(*(float(row[k]) for k in ("qw", "qx", "qy", "qz"))))
            for row in rows]


def assert_same(found: list, poses: np.ndarray, tools) -> None:
    assert len(found) == len(poses)
    assert np.array([point for point, _ in found]) == pytest.approx(poses[:, :3, 3], abs=1e-3)
    assert tools.degrees_between(np.array([turn for _, turn in found]), poses[:, :3, :3]).max() < 1e-3


def test_every_dialect_reads_back_to_the_same_poses(as_built, pipe_on_plate, tools, tmp_path):
    plan = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate)
    names = ("path.csv", "path.src", "path.mod", "path.script", "path.FCStd")
    robot = RobotSettings(keep_failing=True)
    write_seams(plan, [tmp_path / name for name in names], robot)
    both = [moves(seam, robot) for seam in plan.seams]
    everything = np.concatenate([one.all_poses for one in both])
    text = {path.name: path.read_text() for path in tmp_path.iterdir() if path.suffix != ".FCStd"}
    assert_same(read_krl(text["path.src"], text["path.dat"]), everything, tools)
    assert_same(read_rapid(text["path.mod"]), everything, tools)
    assert_same(read_urscript(text["path.script"]), everything, tools)
    assert_same(read_csv(text["path.csv"]), np.concatenate([one.poses for one in both]), tools)
    document = FreeCAD.openDocument(str(tmp_path / "path.FCStd"), hidden=True)
    try:
        assert [item.TypeId for item in document.Objects] == ["Robot::TrajectoryObject"] * 2
        waypoints = [point for item in document.Objects for point in item.Trajectory.Waypoints]
        found = [(tuple(point.Pos.Base), np.array(point.Pos.Matrix.A).reshape(4, 4)[:3, :3]) for point in waypoints]
        assert_same(found, everything, tools)
        assert waypoints[0].Velocity == 100.0 and waypoints[2].Velocity == 10.0
        assert [point.Type for point in waypoints[:3]] == ["PTP", "LIN", "LIN"]
    finally:
        FreeCAD.closeDocument(document.Name)


def test_approach_and_retract_stand_off_along_the_torch(as_built, pipe_on_plate):
    seam = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate).seams[0]
    one = moves(seam, RobotSettings(approach=30.0))
    for away, at in ((one.approach, one.poses[0]), (one.retract, one.poses[-1])):
        assert at[:3, 3] - away[:3, 3] == pytest.approx(30.0 * at[:3, 2])
        assert away[:3, :3] == pytest.approx(at[:3, :3])


def test_tool_base_and_velocity_in_every_dialect(as_built, pipe_on_plate, tmp_path, tools):
    plan = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate)
    frame = read_frame_choice("500,-20,30.5,90,0,180")
    robot = RobotSettings(tool=frame, base=frame, velocity=8.0, keep_failing=True)
    write_seams(plan, [tmp_path / name for name in ("p.src", "p.mod", "p.script")], robot)
    source, module, script = ((tmp_path / name).read_text() for name in ("p.src", "p.mod", "p.script"))
    for name in ("$TOOL", "$BASE"):
        assert f"{name}={{X 500.0000,Y -20.0000,Z 30.5000,A 90.00000,B 0.00000,C 180.00000}}" in source
    assert "$VEL.CP=0.008" in source
    quaternion = "[[500.0000,-20.0000,30.5000],[0.000000000,0.707106781,0.707106781,0.000000000]]"
    assert f"PERS tooldata tFfdsTorch:=[TRUE,{quaternion}," in module
    assert f'PERS wobjdata wFfdsModel:=[FALSE,TRUE,"",{quaternion},' in module
    assert "speeddata vFfdsWeld:=[8," in module and "tFfdsTorch\\WObj:=wFfdsModel" in module
    pose = "p[0.50000000,-0.02000000,0.03050000,2.22144147,2.22144147,0.00000000]"
    assert f"set_tcp({pose})" in script and f"model_frame = {pose}" in script and "v=0.008" in script
    assert len(read_urscript(script)) == sum(len(seam.stations) + 2 for seam in plan.seams)


def test_numbers_and_names_of_tools(as_built, pipe_on_plate, tmp_path):
    plan = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate)
    write_seams(plan, [tmp_path / "k.src"], RobotSettings(tool=3, base=7, keep_failing=True))
    assert "$TOOL=TOOL_DATA[3]" in (tmp_path / "k.src").read_text()
    assert "$BASE=BASE_DATA[7]" in (tmp_path / "k.src").read_text()
    write_seams(plan, [tmp_path / "a.mod"], RobotSettings(tool="tGun", base="wPart", keep_failing=True))
    assert "tGun\\WObj:=wPart;" in (tmp_path / "a.mod").read_text()
    for name, robot in (("x.src", RobotSettings(tool="tGun", keep_failing=True)),
                        ("x.mod", RobotSettings(base=2, keep_failing=True)),
                        ("x.script", RobotSettings(tool=1, keep_failing=True))):
        with pytest.raises(InputError, match="give"):
            write_seams(plan, [tmp_path / name], robot)
        assert not list(tmp_path.glob("*x*"))
    with pytest.raises(InputError, match="no tool or base"):
        read_frame_choice("1,2,3")


def test_programs_hold_the_seams_within_their_limits_unless_all_are_asked_for(tools, tmp_path):
    """A block whose upper side sank by 2 mm: its upper edge is off by that, the lower one not at all."""
    nominal, built = Part.makeBox(60, 40, 20), Part.makeBox(60, 40, 18)
    edges = [tools.edge_at(nominal, (30, 0, z)) for z in (0, 20)]
    plan = plan_seams(built, edges, nominal=nominal)
    assert [bool(seam.exceeded(plan.limits)) for seam in plan.seams] == [edge == edges[1] for edge in sorted(
        edges, key=lambda name: int(name[4:]))]
    notes = write_seams(plan, [tmp_path / "a.src", tmp_path / "a.csv"])
    assert notes[0] == f"Beyond their limits, and therefore left out of the programs: {edges[1]} (lateral, normal)."
    points = np.array([point for point, _ in read_krl(*((tmp_path / f"a.{kind}").read_text() for kind in (
        "src", "dat")))])
    assert points[1:-1, 2] == pytest.approx(0.0, abs=1e-3)
    assert {row["seam"] for row in csv.DictReader((tmp_path / "a.csv").open())} == {"1", "2"}
    notes = write_seams(plan, [tmp_path / "all.src"], RobotSettings(keep_failing=True))
    assert notes[0] == f"Beyond their limits, but included in the programs: {edges[1]} (lateral, normal)."
    assert len(read_krl(*((tmp_path / f"all.{kind}").read_text() for kind in ("src", "dat")))) > len(points)
    none = plan_seams(built, edges[1:], nominal=nominal)
    with pytest.raises(RefusedError, match="no program was written"):
        write_seams(none, [tmp_path / "none.src"])
    assert not list(tmp_path.glob("none*"))
    write_seams(none, [tmp_path / "none.csv"])


def test_program_names_suit_the_controller(as_built, pipe_on_plate, tmp_path):
    plan = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate)
    note = write_seams(plan, [tmp_path / "3-my weld.src"], RobotSettings(keep_failing=True))[-1]
    assert "s3_my_weld" in note
    assert "DEF s3_my_weld()" in (tmp_path / "3-my weld.src").read_text()
    assert "DEFDAT s3_my_weld" in (tmp_path / "3-my weld.dat").read_text()


def test_unknown_formats_and_failures_leave_nothing(as_built, pipe_on_plate, tmp_path):
    plan = plan_seams(as_built, auto=0.1, nominal=pipe_on_plate)
    with pytest.raises(InputError, match="unknown format"):
        write_seams(plan, [tmp_path / "ok.csv", tmp_path / "path.gcode"])
    with pytest.raises(InputError, match="same name"):
        write_seams(plan, [tmp_path / "a.src"], report_path=tmp_path / "a.dat")
    with pytest.raises(InputError, match="does not exist"):
        write_seams(plan, [tmp_path / "nowhere" / "a.csv"])
    assert not list(tmp_path.iterdir())


def test_a_way_through_the_part_is_said(tools, tmp_path):
    """A channel 20 mm wide: from its bottom corner the bisector leads into the other wall after 28 mm."""
    channel = Part.makeBox(60, 30, 60).cut(Part.makeBox(60, 20, 55, FreeCAD.Vector(0, 5, 5)))
    plan = plan_seams(channel, [tools.edge_at(channel, (30, 5, 5))])
    notes = write_seams(plan, [tmp_path / "a.csv"], RobotSettings(approach=32.0))
    assert [note.split(" Edge")[0] for note in notes] == ["The approach to", "The retract from"]
    assert write_seams(plan, [tmp_path / "a.csv"], RobotSettings(approach=25.0)) == []
