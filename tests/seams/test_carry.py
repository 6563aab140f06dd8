# SPDX-License-Identifier: LGPL-2.1-or-later
"""A taught path carried along by a known warp: poses on a seam, over faces, in CSV and KRL."""
from __future__ import annotations

import csv
import io
import re

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.seams.output.writing import write_seams
from ffds_workbench.seams.plan import plan_seams
from ffds_workbench.seams.programs.angles import from_kuka_angles
from ffds_workbench.seams.taught.carry import carry

POSITION, DIRECTION = 1e-4, 0.02
"""mm and degrees, as for the seams themselves: poses on a seam are carried by the frame of its edge."""


def columns(text: str, *names: str) -> np.ndarray:
    return np.array([[float(row[name]) for name in names] for row in csv.DictReader(io.StringIO(text))])


def test_seam_as_csv_and_as_krl(pipe_on_plate, as_built, tools, tmp_path):
    nominal = plan_seams(pipe_on_plate, auto=0.1)
    write_seams(nominal, [tmp_path / "taught.csv", tmp_path / "taught.src"])
    for name in ("csv", "src"):
        result = carry(pipe_on_plate, as_built, tmp_path / f"taught.{name}", tmp_path / f"new.{name}")
        assert result.left == 0 and 1.0 < result.largest_shift < 4.0
    truth = [tools.truth_of(tools.bumpy, seam.stations) for seam in nominal.seams]
    points = np.concatenate([one.points for one in truth])
    frames = np.concatenate([one.frames for one in truth])
    text = (tmp_path / "new.csv").read_text()
    assert columns(text, "x", "y", "z") == pytest.approx(points, abs=POSITION)
    x, y, z, w = columns(text, "qx", "qy", "qz", "qw").T
    carried = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    assert tools.degrees_between(carried, frames[:, :, 2]).max() < DIRECTION
    assert tools.degrees_between(columns(text, "tx", "ty", "tz"), frames[:, :, 0]).max() < DIRECTION
    length = plan_seams(as_built, auto=0.1).seams[0].stations.length
    assert columns(text, "s")[len(truth[0].points) - 1, 0] == pytest.approx(length, rel=1e-3)
    data = (tmp_path / "new.dat").read_text()
    found = re.findall(r"XS(\d+)P\d+=\{X (\S+),Y (\S+),Z (\S+),A (\S+),B (\S+),C ([^}]+)\}", data)
    values = np.array([list(map(float, row[1:])) for row in found])
    assert values[:, :3] == pytest.approx(points, abs=1e-3)
    assert tools.degrees_between(from_kuka_angles(values[:, 3:]), frames).max() < DIRECTION
    assert "DEFDAT new" in data and "DEF new()" in (tmp_path / "new.src").read_text()


def test_poses_over_a_face_keep_their_distance_and_follow_it(tools, tmp_path):
    """Poses 12 mm over a plate, looking down along −z, with the plate's normal turned by the warp."""
    plate = Part.makeBox(100, 80, 6)
    built = tools.warped(plate, tools.bumpy)
    at = np.array([[x, y, 6.0] for x in (20.0, 50.0, 80.0) for y in (20.0, 40.0, 60.0)])
    rows = "\n".join(f"{x};{y};{z + 12.0};0;0;180;weld on".replace(".", ",") for x, y, z in at)
    (tmp_path / "p.csv").write_text("X;Y;Z;A;B;C;note\n" + rows + "\n")
    carry(plate, built, tmp_path / "p.csv", tmp_path / "q.csv")
    h = 1e-4
    jacobian = np.stack([(tools.bumpy(at + h * axis) - tools.bumpy(at - h * axis)) / (2 * h) for axis in np.eye(3)],
                        axis=2)
    normal = np.cross(jacobian[:, :, 0], jacobian[:, :, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    lines = (tmp_path / "q.csv").read_text().splitlines()
    assert lines[0] == "X;Y;Z;A;B;C;note" and lines[1].endswith(";weld on")
    values = np.array([[float(cell.replace(",", ".")) for cell in line.split(";")[:6]] for line in lines[1:]])
    assert values[:, :3] == pytest.approx(tools.bumpy(at) + 12.0 * normal, abs=POSITION)
    assert tools.degrees_between(from_kuka_angles(values[:, 3:])[:, :, 2], -normal).max() < 0.001


def test_identity_leaves_a_path_where_it_is(pipe_on_plate, tmp_path):
    write_seams(plan_seams(pipe_on_plate, auto=0.1), [tmp_path / "a.csv"])
    carry(pipe_on_plate, pipe_on_plate, tmp_path / "a.csv", tmp_path / "b.csv")
    names = ("x", "y", "z", "qx", "qy", "qz", "qw")
    before, after = (columns((tmp_path / name).read_text(), *names) for name in ("a.csv", "b.csv"))
    assert after == pytest.approx(before, abs=1e-6)


PROGRAM = """&ACCESS RVP
DEF Teach( )
;FOLD PTP HOME
$BASE={X 1,Y 2,Z 3,A 0,B 0,C 0}
$TOOL = {X 0,Y 0,Z 120,A 0,B 0,C 0}
PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}
LIN {X 20.5, Y 0, Z 0, A 10, B 0, C 180, E1 5.0} C_DIS ; taught {X 1,Y 2,Z 3}
LIN_REL {X 5,Y 0,Z 0}
CIRC {X 0,Y 20,Z 0},{X -20,Y 0,Z 0,A 0,B 0,C 180}
LIN {X 5000,Y 0,Z 0,A 0,B 0,C 0}
END
"""


def test_krl_keeps_all_but_the_poses(pipe_on_plate, tools, tmp_path):
    (tmp_path / "Teach.src").write_text(PROGRAM)
    shift = FreeCAD.Vector(1.5, -0.5, 0.25)
    moved = pipe_on_plate.copy()
    moved.translate(shift)
    result = carry(pipe_on_plate, moved, tmp_path / "Teach.src", tmp_path / "Next.src")
    assert (result.poses, result.left) == (4, 1)
    text = (tmp_path / "Next.src").read_text()
    expected = PROGRAM.replace("DEF Teach( )", "DEF Next( )")
    for old, new in (("{X 20.5, Y 0, Z 0, A 10, B 0, C 180, E1 5.0}",
                      "{X 22.0000, Y -0.5000, Z 0.2500, A 10.00000, B 0.00000, C 180.00000, E1 5.0}"),
                     ("{X 0,Y 20,Z 0}", "{X 1.5000,Y 19.5000,Z 0.2500}"),
                     ("{X -20,Y 0,Z 0,A 0,B 0,C 180}",
                      "{X -18.5000,Y -0.5000,Z 0.2500,A 0.00000,B 0.00000,C 180.00000}"),
                     ("{X 5000,Y 0,Z 0,A 0,B 0,C 0}", "{X 5000.0000,Y 0.0000,Z 0.0000,A 0.00000,B 0.00000,C 0.00000}")):
        expected = expected.replace(old, new)
    assert text.replace("-180.00000", "180.00000") == expected


@pytest.mark.parametrize(("name", "text", "error", "says"), [
    ("p.csv", "", InputError, "empty"), ("p.csv", "x,y,z\n", InputError, "no poses"),
    ("p.csv", "x,y\n1,2\n", InputError, "columns are not known"),
    ("p.csv", "x,y,z\n1,2,three\n", InputError, "without numbers"),
    ("p.csv", "x,y,z\n1,2,nan\n", InputError, "finite"),
    ("p.csv", "x,y,z,qx,qy,qz,qw\n20,0,0,0,0,0,0\n", InputError, "zero"),
    ("p.csv", "x,y,z\n9000,0,0\n", RefusedError, "near the nominal model"),
    ("p.src", "DEF p()\nEND\n", InputError, "no poses"),
    ("p.src", "DEF p()\nLIN {X 20,Z 0}\nEND\n", InputError, "Line 2"),
    ("p.txt", "1 2 3", InputError, "unknown format")])
def test_what_cannot_be_carried(pipe_on_plate, tmp_path, name, text, error, says):
    (tmp_path / name).write_text(text)
    out = tmp_path / f"new{name[1:]}"
    with pytest.raises(error, match=says):
        carry(pipe_on_plate, pipe_on_plate, tmp_path / name, out)
    assert not out.exists() and (tmp_path / name).read_text() == text


def test_path_is_not_its_own_output(pipe_on_plate, tmp_path):
    (tmp_path / "p.csv").write_text("20,0,0\n")
    with pytest.raises(InputError, match="also an input"):
        carry(pipe_on_plate, pipe_on_plate, tmp_path / "p.csv", tmp_path / "p.csv")
    carry(pipe_on_plate, pipe_on_plate, tmp_path / "p.csv", tmp_path / "q.csv")
    assert (tmp_path / "q.csv").read_text() == "20.000000,0.000000,0.000000\n"
