# SPDX-License-Identifier: LGPL-2.1-or-later
"""The world benchmark: its cases by closed forms, its judge on made faults, and that whatever happens to a file is a
row. Tolerances are those of rounding where nothing else is said."""
from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from ffds_workbench.benchmark import world
from ffds_workbench.benchmark.world import ScanSettings, exact_samples, judge, numbers
from ffds_workbench.benchmark.world.case import WorldTruth, bent_and_twisted, make

EXACT = 1e-9


def case(shape, folder, deformation="none", **settings):
    """The scan's points and normals, and the truth."""
    make(shape, deformation, ScanSettings(points=3000, normals=True, **settings), folder)
    rows = np.frombuffer((folder / "scan.ply").read_bytes().partition(b"end_header\n")[2]).reshape(-1, 6)
    return rows[:, :3], rows[:, 3:], WorldTruth(**np.load(folder / "truth.npz"))


def test_points_lie_on_the_surface_with_its_normals_and_the_noise_is_along_them(tmp_path):
    points, normals, truth = case(Part.makeSphere(15), tmp_path, sigma=0.0)
    assert len(points) == 3000
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 15, atol=EXACT)
    np.testing.assert_allclose(normals, points / 15, atol=1e-6)  # the warp's gradient is a difference
    noisy, normals, _ = case(Part.makeSphere(15), tmp_path, sigma=0.05, scale=2.0)
    assert np.std(np.linalg.norm(noisy, axis=1)) == pytest.approx(0.1, rel=0.06)  # four standard errors of 3,000


def test_a_view_sees_neither_what_looks_away_nor_what_lies_behind(tmp_path):
    """The first view comes from (6, 5, 7): a wall in front of a box leaves of it what stands out above the wall."""
    box, wall = Part.makeBox(10, 10, 10), Part.makeBox(1, 40, 40, Vector(20, -15, -15))
    points, normals, truth = case(Part.makeCompound([box, wall]), tmp_path, views=1)
    assert (normals @ [0.6, 0.5, 0.7] > 0).all()
    of_box = points[points[:, 0] < 15]
    shadow = of_box + ((20 - of_box[:, 0]) / 0.6)[:, None] * [0.6, 0.5, 0.7]  # where its ray meets the wall's plane
    beside = ((shadow[:, 1:] < -15) | (shadow[:, 1:] > 25)).any(axis=1)
    assert len(of_box) and (beside | (np.abs(shadow[:, 1:] - 25).min(axis=1) < 0.5)).all()  # the noise at the border


def test_bending_keeps_lengths_and_sags_by_as_much_as_asked(tmp_path):
    """A strip along z: its middle line comes to lie on a circle of the same length."""
    warp = bent_and_twisted(2.0, np.array([-5.0, -1.0, 0.0]), np.array([5.0, 1.0, 100.0]))
    line = np.column_stack([np.zeros(2001), np.zeros(2001), np.linspace(0, 100, 2001)])
    moved = warp(line)
    steps = np.linalg.norm(np.diff(moved, axis=0), axis=1)
    assert steps.sum() == pytest.approx(100, abs=0.01)  # where it sags it does not twist, but for the ends
    assert np.ptp(moved[:, 1]) == pytest.approx(2.0, rel=0.03)  # L²/8R, but for the twist of 2/√26 rad


def test_distances_are_those_of_closed_forms():
    """A cylinder of R = 10 against points that lie 0.3 mm outside it and 0.2 mm above its end."""
    shape = Part.makeCylinder(10, 30)
    t, z = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(1, 29, 5))
    side = np.column_stack([10.3 * np.cos(t.ravel()), 10.3 * np.sin(t.ravel()), z.ravel()])
    uv = np.column_stack([t.ravel(), z.ravel()])
    off = judge.distances(shape, WorldTruth(side, side, np.zeros(200, int), uv, np.ones(200, bool), None, None))
    np.testing.assert_allclose(off, 0.3, atol=EXACT)
    away = np.roll(uv, 20, axis=0)  # steps that begin on the other side
    off = judge.distances(shape, WorldTruth(side, side, np.zeros(200, int), away, np.ones(200, bool), None, None))
    np.testing.assert_allclose(off, 0.3, atol=EXACT)


def test_distances_are_found_near_the_poles_of_a_sphere():
    """A periodic B-spline of R = 10, where one Newton step from a pole would turn round the axis without end."""
    sphere = Part.makeSphere(10).toNurbs()
    u = np.linspace(0.1, 6.1, 40)
    points = np.tile([0.05, 0.0, 10.3], (40, 1))
    uv = np.column_stack([u, np.full(40, sphere.Faces[0].ParameterRange[3])])
    off = judge.distances(sphere, WorldTruth(points, points, np.zeros(40, int), uv, np.ones(40, bool), None, None))
    np.testing.assert_allclose(off, np.hypot(0.05, 10.3) - 10, atol=EXACT)


def test_a_seam_is_judged_across_the_surface():
    """A pipe that is 0.2 mm too large and turned about itself by 2 mm: its circles are 0.2 mm off, and so is its seam,
    whose line is another 2 mm away."""
    nominal, built = Part.makeCylinder(30, 100), Part.makeCylinder(30.2, 100)
    built.rotate(Vector(), Vector(0, 0, 1), np.degrees(2 / 30))
    lines = np.array([[tuple(edge.valueAt(t)) for t in np.linspace(*edge.ParameterRange, 50)]
                      for edge in nominal.Edges])
    truth = WorldTruth(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0, int), np.zeros((0, 2)), np.zeros(0, bool), lines,
                       lines)
    found = judge._figures(built, truth, np.zeros(0))
    assert found["edges"]["max"] == pytest.approx(0.2, abs=2e-3)  # the sagitta of a 400-gon
    assert found["edge_lines"]["max"] == pytest.approx(np.hypot(0.2, 2 * np.sin(1 / 30) * 30), abs=0.02)


def test_slivers_are_divided_into_few_triangles():
    """A triangle 100 times as long as a piece may be, and half a piece wide, kept a machine busy for hours."""
    sliver = np.array([[[0, 0, 0, 0, 0], [100, 0.5, 0, 100, 0], [100, 0, 0, 100, 1.0]]])
    corners = exact_samples._divided(sliver, 1.0)
    sides = np.linalg.norm(corners[:, :, :3] - np.roll(corners[:, :, :3], -1, axis=1), axis=2)
    assert sides.max() <= 1.0 and len(corners) <= 4 * 200  # two to a strip, and once across where they are widest
    area = exact_samples.Triangles(corners, np.zeros(len(corners), int)).area_vectors[:, 2]
    assert area.min() > 0 or area.max() < 0
    np.testing.assert_allclose(np.abs(area).sum(), 50.0, rtol=1e-12)


def test_small_tori_are_meshed_at_once():
    """A rod end of 6 mm: asked for a thousandth of a millimetre, OCCT made hundreds of thousands of triangles of it."""
    torus = Part.makeTorus(2.7, 0.125)
    size = torus.BoundBox.DiagonalLength
    corners = exact_samples._mesh(torus.Faces[0], exact_samples._sag(size))
    triangles = exact_samples.Triangles(corners, np.zeros(len(corners), int))
    assert len(corners) < 50_000
    np.testing.assert_allclose(0.5 * np.linalg.norm(triangles.area_vectors, axis=1).sum(),
                               4 * np.pi**2 * 2.7 * 0.125, rtol=0.1)  # of a section of at least seven sides


def test_other_numbers_are_found():
    box = Part.makeBox(10, 20, 30)
    assert numbers.changes(box, box.copy()) == []
    turned = Part.Solid(Part.Shell(box.Faces[::-1]))
    assert any("edges of Face" in line for line in numbers.changes(box, turned))
    assert numbers.changes(box, box.makeFillet(1, box.Edges[:1]))[0] == "Faces: 6 became 7"


def test_an_edge_on_the_place_of_another_is_found():
    """A mirrored bar has the same incidences; its edges lie where others should."""
    bar = Part.makeBox(10, 20, 30)
    lines = np.array([[tuple(edge.valueAt(t)) for t in np.linspace(*edge.ParameterRange, 50)] for edge in bar.Edges])
    assert numbers.strays(bar, lines, 0.1) == []
    assert numbers.strays(bar, lines[::-1], 0.1)


def test_a_face_that_does_not_mesh_leaves_an_open_mesh():
    box = Part.makeBox(10, 20, 30)
    assert judge._mesh(box) == {"unmeshed": [], "open": 0}
    assert judge._mesh(Part.Shell(box.Faces[:5]))["open"] == 4


def test_whatever_happens_to_a_file_is_a_row_and_rows_are_kept(tmp_path):
    parts, out = tmp_path / "parts", tmp_path / "out"
    parts.mkdir()
    out.mkdir()
    (parts / "no.step").write_text("ISO-10303-21;\n")
    Part.makeBox(40, 30, 20).exportStep(str(parts / "box.step"))
    told: list[str] = []
    quick = {"parts": [parts], "deformations": ["none"], "settings": ScanSettings(points=4000)}
    text = world.run(out, told.append, **quick)
    rows = json.loads((out / "world.json").read_text())["rows"]
    assert [(row["file"], row["outcome"]) for row in rows] == [("no.step", "no case"), ("box.step", "written")]
    assert "no.step" in text and rows[1]["lost"] == [] and rows[1]["exit"] == 0
    assert max(rows[1][what]["mean"] for what in ("visible", "edges")) < 0.03  # of σ = 0.08, 4,000 points
    kept = out / "cases" / "box.step" / "none" / "row.json"
    before = kept.stat().st_mtime_ns
    world.run(out, told.append, **quick)
    assert kept.stat().st_mtime_ns == before
    world.run(out, told.append, **quick | {"settings": ScanSettings(points=3000), "limit": 0.001})
    rows = json.loads((out / "world.json").read_text())["rows"]
    assert {row["exit"] for row in rows} == {None} and kept.stat().st_mtime_ns > before


def test_a_run_that_is_broken_off_keeps_no_row_of_what_it_ended(tmp_path):
    parts, out = tmp_path / "parts", tmp_path / "out"
    parts.mkdir()
    out.mkdir()
    (parts / "no.step").write_text("ISO-10303-21;\n")
    Part.makeBox(40, 30, 20).exportStep(str(parts / "box.step"))

    def interrupt(message: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        world.run(out, interrupt, [parts], deformations=["none"], workers=2)
    assert [row.parent.parent.name for row in out.glob("cases/*/*/row.json")] == ["no.step"]


def test_what_cannot_be_measured_is_one_line(ffds, tmp_path):
    for arguments, said in (([], "--parts"), (["--parts", "nowhere"], "nowhere"), (["--views", "9"], "1 to 8 views"),
                            (["--primitives", "--deformations", "dent"], "'dent' is unknown")):
        process = ffds("benchmark", "world", "--out", tmp_path / "out", *arguments)
        assert process.returncode == 2 and process.stderr.count("\n") == 1 and said in process.stderr


def test_the_judge_beside_the_project_finds_the_same(shared, tmp_path):
    """evaluate.py measures with meshes and a spline library of its own."""
    parts, out = tmp_path / "parts", tmp_path / "out"
    parts.mkdir()
    out.mkdir()
    Part.makeBox(40, 30, 20).cut(Part.makeCylinder(6, 20, Vector(20, 15, 0))).exportStep(str(parts / "box.step"))
    world.run(out, lambda text: None, [parts], deformations=["bent-1.5"], settings=ScanSettings(points=10_000))
    row, = json.loads((out / "world.json").read_text())["rows"]
    folder = out / "cases" / "box.step" / "bent-1.5"
    subprocess.run([sys.executable, shared / "tools" / "evaluate.py", parts / "box.step", folder / "as_built.step",
                    folder / "truth.npz", "--json", tmp_path / "judged.json"], check=True, capture_output=True)
    theirs = json.loads((tmp_path / "judged.json").read_text())
    for ours, other in ((row, theirs["error"]), (row["nominal"], theirs["nominal"])):
        for what, theirs_is in (("visible", "visible"), ("hidden", "hidden"), ("edge_lines", "edges")):
            if ours[what]:
                assert ours[what]["mean"] == pytest.approx(other[theirs_is]["mean"], rel=0.05, abs=2e-4), what
    assert not row["lost"] and theirs["topology_ok"]
