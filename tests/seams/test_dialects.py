# SPDX-License-Identifier: LGPL-2.1-or-later
"""FANUC, Yaskawa and Kawasaki programs: orientations worked out by hand, files read back, and the form that files have.

The form of a FANUC listing is that of ``fanuc_driver/tpe/ros_movesm.ls`` of ros-industrial/fanuc, and of welding
listings in Creearc/welding_project; that of a job is what users of Yaskawa controllers publish.
"""
from __future__ import annotations

import re

import numpy as np
import Part
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.seams.output.writing import write_seams
from ffds_workbench.seams.plan import plan_seams
from ffds_workbench.seams.programs.angles import from_kawasaki_angles, kawasaki_angles
from ffds_workbench.seams.programs.arcs import TOLERANCE, arcs_of
from ffds_workbench.seams.programs.fanuc import ls_text
from ffds_workbench.seams.programs.kawasaki import as_text
from ffds_workbench.seams.programs.krl import krl_texts
from ffds_workbench.seams.programs.moves import RobotSettings, SeamMoves, moves
from ffds_workbench.seams.programs.rapid import rapid_text
from ffds_workbench.seams.programs.reading import read_program
from ffds_workbench.seams.programs.urscript import urscript_text
from ffds_workbench.seams.programs.yaskawa import jbi_text

NAMES = ("weld.ls", "weld.jbi", "weld.as")


@pytest.fixture(scope="module")
def plan():
    """Both rims of a tube's end: closed circles."""
    tube = Part.makeCylinder(20, 40).cut(Part.makeCylinder(17, 40)).Solids[0]
    edges = [f"Edge{i}" for i, edge in enumerate(tube.Edges, 1) if edge.CenterOfMass.z > 39.9]
    return plan_seams(tube, edges)


def same(found: np.ndarray, poses: np.ndarray) -> None:
    """To 1e-3 mm and 1e-3°."""
    assert found.shape == poses.shape
    assert np.abs(found[:, :3, 3] - poses[:, :3, 3]).max() < 1e-3
    turned = np.einsum("nij,nik->njk", found[:, :3, :3], poses[:, :3, :3])
    sine = np.linalg.norm(turned - turned.swapaxes(1, 2), axis=(1, 2)) / np.sqrt(8.0)
    assert np.degrees(sine).max() < 1e-3


def each_once(poses: np.ndarray) -> np.ndarray:
    """Without a pose that repeats the one before it: a job says where a circle starts."""
    new = np.abs(np.diff(poses, axis=0)).max(axis=(1, 2)) > 1e-9
    return poses[np.append(True, new)]


@pytest.mark.parametrize("name", NAMES)
def test_programs_read_back(plan, name, tmp_path):
    robot = RobotSettings()
    write_seams(plan, [tmp_path / name], robot)
    everything = np.concatenate([moves(seam, robot).all_poses for seam in plan.seams])
    same(read_program(tmp_path / name), everything)


def test_orientations_by_hand():
    """Kawasaki's zero; the tool straight down; a quarter turn about Y, which takes z to x."""
    hand = [(np.eye(3), (0, 0, 0)), (np.diag([-1.0, 1.0, -1.0]), (0, 180, 0)),
            (np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0.0]]), (0, 90, 0)),
            (np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]]), (90, 0, 0))]
    for rotation, angles in hand:
        assert kawasaki_angles(rotation[None])[0] == pytest.approx(angles, abs=5e-6)
        assert from_kawasaki_angles(np.array([angles], dtype=float))[0] == pytest.approx(rotation, abs=1e-12)


def test_the_form_of_a_listing(plan):
    text = ls_text("weld", [moves(seam, RobotSettings()) for seam in plan.seams], RobotSettings(tool=3, base=2))
    lines = text.splitlines()
    assert lines[0] == "/PROG  WELD" and lines[1] == "/ATTR" and lines[-1] == "/END"
    assert lines.index("/MN") < lines.index("/POS")
    numbered = [line for line in lines[lines.index("/MN") + 1 : lines.index("/POS")]]
    assert [int(line.split(":")[0]) for line in numbered] == list(range(1, len(numbered) + 1))
    assert all(line.endswith(";") for line in numbered)
    assert f"LINE_COUNT = {len(numbered)};" in text
    assert any("UFRAME_NUM=2 ;" in line for line in numbered) and any("UTOOL_NUM=3 ;" in line for line in numbered)
    assert re.search(r"P\[1\]\{\n   GP1:\n\tUF : 2, UT : 3,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = \S+  mm,", text)


def test_the_form_of_a_job(plan):
    lines = jbi_text("weld", [moves(plan.seams[0], RobotSettings())], RobotSettings()).splitlines()
    assert lines[:3] == ["/JOB", "//NAME WELD", "//POS"]
    count = len(plan.seams[0].stations) + 2
    assert lines[3] == f"///NPOS {count},0,0,0,0,0" and sum(line.startswith("C0") for line in lines) == count
    order = ["///USER 1", "///TOOL 1", "///POSTYPE USER", "///RECTAN", "//INST", "///ATTR SC,RW,RJ", "////FRAME USER 1",
             "///GROUP1 RB1", "NOP", "END"]
    assert sorted(order, key=lines.index) == order and lines[-1] == "END"
    assert "MOVJ C00000 VJ=20.00" in lines and "MOVL C00002 V=10.0" in lines


def arc_moves(count: int = 37, noise: float = 0.0) -> SeamMoves:
    """A straight start, then a circle of 30 mm radius in steps of 5°, the torch turning with it."""
    angle = np.radians(5.0) * np.arange(count)
    poses = np.tile(np.eye(4), (count + 3, 1, 1))
    poses[3:, :3, 0] = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    poses[3:, :3, 2] = -np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    poses[3:, :3, 1] = np.cross(poses[3:, :3, 2], poses[3:, :3, 0])
    poses[3:, :3, 3] = 30.0 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    poses[3:, 2, 3] += noise * (-1.0) ** np.arange(count)
    poses[:3] = poses[3]
    poses[:3, 1, 3] -= 5.0 * np.arange(3, 0, -1)
    away = poses[[0, -1]].copy()
    away[:, 2, 3] += 50.0
    return SeamMoves("Edge1", "Edge1", away[0], poses, away[1], 0.5, arcs=arcs_of(poses))


def test_circles_are_circles_and_agree_with_the_points():
    """Of 180° one arc of 170° and the rest; all stations lie on the circle through its three points."""
    seam = arc_moves()
    assert seam.arcs == ((3, 20, 37),)
    for start, middle, end in seam.arcs:
        a, b, c = seam.poses[[start, middle, end], :3, 3]
        normal = np.cross(b - a, c - a)
        rows = np.array([b - a, c - a, normal])
        centre = np.linalg.solve(rows, [0.5 * (b @ b - a @ a), 0.5 * (c @ c - a @ a), normal @ a])
        off = np.linalg.norm(seam.poses[start : end + 1, :3, 3] - centre, axis=1) - np.linalg.norm(a - centre)
        assert np.abs(off).max() <= TOLERANCE
    assert not arc_moves(noise=0.05).arcs
    line = np.tile(np.eye(4), (20, 1, 1))
    line[:, 0, 3] = np.arange(20.0)
    assert not arcs_of(line)


def test_circles_in_every_dialect(tmp_path):
    seam, robot = arc_moves(), RobotSettings()
    count = len(seam.arcs)
    texts = {"ls": ls_text, "jbi": jbi_text, "as": as_text}
    passed = [seam.approach, seam.poses[0]]
    for to, by in seam.sections:
        passed += [seam.poses[to]] if by is None else [seam.poses[by], seam.poses[to]]
    for suffix, write in texts.items():
        (tmp_path / f"a.{suffix}").write_text(write("a", [seam], robot))
        found = read_program(tmp_path / f"a.{suffix}")
        same(each_once(found), np.array([*passed, seam.retract]))
    assert krl_texts("a", [seam], robot)[0].count("CIRC ") == count
    assert rapid_text("a", [seam], robot).count("MoveC ") == count
    assert urscript_text("a", [seam], robot).count("movec(") == count
    assert (tmp_path / "a.ls").read_text().count(":C P[") == count
    assert (tmp_path / "a.jbi").read_text().count("MOVC ") == 3 * count
    assert (tmp_path / "a.as").read_text().count("C2MOVE ") == count


def test_tools_and_bases(plan, tmp_path):
    frame = (500.0, -20.0, 30.5, 90.0, 0.0, 180.0)
    write_seams(plan, [tmp_path / name for name in NAMES], RobotSettings(tool=frame, base=frame))
    listing, job, program = ((tmp_path / name).read_text() for name in NAMES)
    assert "!X500.000 Y-20.000 Z30.500 ;" in listing and "!W180.000 P0.000 R90.000 ;" in listing
    assert "'180.000,0.000,90.000" in job
    # R = Rz(90°) · Rx(180°): z points down, so A = 180° and O takes the rest; T = 0 where that leaves it free.
    (angles,) = re.findall(r"TOOL TRANS\(500.0000,-20.0000,30.5000,(.*)\)", program)
    found = from_kawasaki_angles(np.array([list(map(float, angles.split(",")))]))[0]
    assert found == pytest.approx(np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]]), abs=1e-6)
    for name, robot in (("a.ls", RobotSettings(tool="gun")), ("a.jbi", RobotSettings(base="part")),
                        ("a.as", RobotSettings(tool=1))):
        with pytest.raises(InputError, match="give"):
            write_seams(plan, [tmp_path / name], robot)


@pytest.mark.parametrize(("name", "text", "says"), [
    ("a.txt", "", "language"), ("a.ls", "   1:L P[1] 5mm/sec FINE ;\n/POS\n/END", "moves to 1"),
    ("b.as", None, "cannot be read")])
def test_what_is_not_read(name, text, says, tmp_path):
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=says):
        read_program(tmp_path / name)
