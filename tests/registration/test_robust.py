# SPDX-License-Identifier: LGPL-2.1-or-later
"""Robust registration against formulas: the sheet, a closed cylinder, two skins, and real scans where they are."""
import json

import numpy as np
import pytest

from ffds_workbench.benchmark.simulated import sheet
from ffds_workbench.benchmark.speed import curved_face, curved_scan
from ffds_workbench.errors import RefusedError
from ffds_workbench.registration.face.robust import register_robust
from ffds_workbench.registration.projection import project

FACE = sheet.nominal()


@pytest.mark.parametrize(("kind", "mean", "p95", "largest"), [
    ("A", 0.008, 0.02, 0.15), ("D", 0.012, 0.035, 0.6), ("E", 0.09, 0.23, 2.0)])
def test_sheet(kind, mean, p95, largest):
    """Lines set for this sheet (A, D); E cannot be better than its correlated noise averaged over what is resolved."""
    found = [sheet.deviation(register_robust(FACE, sheet.scan(kind, seed)).displacement) for seed in range(4)]
    assert np.mean(found) < mean
    assert np.mean([np.percentile(d, 95) for d in found]) < p95
    assert np.max(found) < largest


def test_clean_data_lose_nothing():
    """As precise as plain least squares on all points, which knows that there is nothing but the sheet: within 10 %."""
    from scipy.interpolate import LSQBivariateSpline

    robust, plain = [], []
    knots = [np.linspace(0, side, 8)[1:-1] for side in sheet.SIZE]
    grid = np.stack(np.meshgrid(*(np.linspace(0, side, 151) for side in sheet.SIZE), indexing="ij"))
    for seed in range(4):
        scan = sheet.scan("A", seed)
        robust.append(sheet.deviation(register_robust(FACE, scan).displacement).mean())
        fit = LSQBivariateSpline(*scan.T, *knots, bbox=[0, sheet.SIZE[0], 0, sheet.SIZE[1]])
        plain.append(np.abs(fit(*grid.reshape(2, -1), grid=False) - sheet.height(*grid).ravel()).mean())
    assert np.mean(robust) < 1.1 * np.mean(plain)


@pytest.mark.parametrize(("thickness", "density"), [(0.6, 8.0), (1.0, 3.0), (5.0, 8.0)])
def test_walls_at_the_trims_do_not_pull(thickness, density):
    """The thickness of the sheet is seen all around, in points per mm²: no worse than without, within the noise."""
    random = np.random.default_rng(5)
    parts = [sheet.scan("A", 1)]
    for axis, side in ((0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0)):
        count = round(density * thickness * sheet.SIZE[1 - axis])
        place = np.empty((2, count))
        place[axis], place[1 - axis] = side * sheet.SIZE[axis], random.uniform(0, sheet.SIZE[1 - axis], count)
        wall = np.stack([*place, sheet.height(*place) - random.uniform(0, thickness, count)], axis=1)
        parts.append(wall + random.normal(0, sheet.NOISE, wall.shape))
    alone, walled = (sheet.deviation(register_robust(FACE, scan).displacement)
                     for scan in (parts[0], np.concatenate(parts)))
    assert walled.mean() < 1.2 * alone.mean() and walled.max() < alone.max() + 0.03


def test_result_of_a_sheet():
    result = register_robust(FACE, sheet.scan("D", 0))
    assert result.noise == pytest.approx(sheet.NOISE, rel=0.05)
    assert 0.75 < result.coverage < 0.95  # 0.8 seen, and about a cell round each hidden disc
    assert 25_000 < result.points < 0.8 * sheet.POINTS


def test_bend():
    """An inextensible roll, R = 150 mm: the surface is as good as on the sheet; edges slide, as the benchmark says."""
    bend = sheet.Bend()
    assert bend.deviation(register_robust(FACE, bend.scan(0)).displacement).mean() < 0.008


@pytest.mark.parametrize("offset", [-8.0, 5.0])
def test_initial_offset(offset):
    scan = sheet.scan("A", 0) + [0, 0, offset]
    moved = register_robust(FACE, scan).displacement.on_grid(np.linspace(0, 75, 40), np.linspace(0, 70, 40))
    true = offset + sheet.height(np.linspace(0, 75, 40)[:, None], np.linspace(0, 70, 40))
    assert np.abs(moved[..., 2] - true).mean() < 0.01


@pytest.mark.parametrize("shift", [-2.5, 2.5])
def test_the_outer_of_two_skins(shift):
    """A sheet of 3 mm scanned from both sides and moved by nearly its thickness: the outward skin is the face."""
    outer, inner = sheet.scan("A", 0, 30000), sheet.scan("A", 1, 30000)
    scan = np.concatenate([outer * [1, 1, 0.3], inner * [1, 1, 0.3] - [0, 0, 3]]) + [0, 0, shift]
    moved = register_robust(FACE, scan).displacement.on_grid(np.linspace(2, 73, 40), np.linspace(2, 68, 40))
    true = shift + 0.3 * sheet.height(np.linspace(2, 73, 40)[:, None], np.linspace(2, 68, 40))
    assert np.abs(moved[..., 2] - true).mean() < 0.01


def test_closed_cylinder():
    """Noise averaged over about 60 control points and 40,000 points leaves 0.005 mm; the seam is C2."""
    face = curved_face()
    result = register_robust(face, curved_scan(40000))
    random = np.random.default_rng(9)
    angle, z = random.uniform((0, 1), (2 * np.pi, 59), (3000, 2)).T
    radius = 20 + np.cos(angle) + 0.5 * np.cos(2 * angle + z / 30)
    true = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)
    assert np.abs(project(face.surface, true, result.displacement).height).mean() < 0.01
    for order in (0, 1, 2):
        field = result.displacement.derivative(order, 0)
        ends = [field(np.array([[u, 30.0]])) for u in (0.0, 2 * np.pi - 1e-12)]
        np.testing.assert_allclose(*ends, atol=1e-7)


def test_poles_of_a_sphere_stay_points(ball):
    random = np.random.default_rng(1)
    way = random.normal(size=(40000, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    scan = way * (20.3 + 0.5 * way[:, 2:] + random.normal(0, 0.05, (40000, 1)))
    result = register_robust(ball, scan)
    points = result.displacement.control_points
    np.testing.assert_array_equal(points[:, 0], np.broadcast_to(points[0, 0], points[:, 0].shape))
    np.testing.assert_array_equal(points[:, -1], np.broadcast_to(points[0, -1], points[:, -1].shape))
    true = way[:2000] * (20.3 + 0.5 * way[:2000, 2:])
    assert np.abs(project(ball.surface, true, result.displacement).height).mean() < 0.01


def test_half_seen_stays_sane():
    """What the scan does not show is carried on smoothly: within 3 mm of a sheet that itself moves by 6 mm."""
    scan = sheet.scan("A", 0)
    result = register_robust(FACE, scan[scan[:, 0] < 40])
    assert 0.45 < result.coverage < 0.6
    assert sheet.deviation(result.displacement).max() < 8.0
    assert np.abs(result.displacement.control_points).max() < 15.0


def test_a_lattice_finer_than_the_usual_raster():
    """More control points than 4096 cells could hold; bending keeps them as quiet as fewer."""
    result = register_robust(FACE, sheet.scan("A", 1, 100_000), (70, 70))
    assert result.lattice == (70, 70) and sheet.deviation(result.displacement).mean() < 0.008


def test_a_given_lattice_is_kept():
    assert register_robust(FACE, sheet.scan("A", 0), (7, 9)).lattice == (7, 9)


@pytest.mark.parametrize(("scan", "lattice", "text"), [
    (sheet.scan("A", 0) + 1e4, None, "does not lie on Sheet"),
    (sheet.scan("A", 0)[:20], None, "does not lie on Sheet"),
    (np.full((500, 3), 30.0) - [0, 0, 29], None, "shows too little of Sheet"),
    (sheet.scan("A", 0, 500), (40, 40), "lattice 40x40 is too fine")])
def test_refusals_say_what_to_do(scan, lattice, text):
    with pytest.raises(RefusedError, match=text):
        register_robust(FACE, scan, lattice)


@pytest.mark.parametrize("name", ["b-springback", "d-bumps", "e-twist", "f-bend"])
def test_cases(shared_data, name):
    """Every curved or plane main face by itself; 0.02 mm is three times what white noise leaves on the smallest."""
    from ffds_workbench.brep import workpiece
    from ffds_workbench.brep.model_files import model_file
    from ffds_workbench.scan import files as scan_files

    folder = shared_data / "cases" / name
    case, truth = json.loads((folder / "case.json").read_text()), np.load(folder / "truth.npz")
    index = int(case["main_face"].removeprefix("Face")) - 1
    face = workpiece.read(model_file.read(folder / "nominal.step").shape).geometry(index)
    points = truth["warped"][(truth["face"] == index) & truth["visible"]]
    result = register_robust(face, scan_files.read(folder / "scan.ply").points)
    assert np.abs(project(face.surface, points, result.displacement).height).mean() < 0.02


def test_real_weld_part(shared_data):
    """Pipe of a robot's laser scan, noise 1.6 mm: held-out points deviate no more than 1.1 times the fitted ones."""
    from ffds_workbench.brep import workpiece
    from ffds_workbench.brep.model_files import model_file
    from ffds_workbench.registration.face.observed_faces import observed_faces
    from ffds_workbench.scan import files as scan_files

    folder = shared_data / "weld_pipe_on_angle"
    part = workpiece.read(model_file.read(folder / "nominal.step").shape)
    faces = [part.geometry(k) for k in range(len(part.faces))]
    scan = scan_files.read(folder / "scan_60deg_aligned_mm.ply").points
    pipe = next(k for k in observed_faces(faces, scan) if faces[k].kind == "Cylinder")
    assert faces[pipe].outward == 1
    held = np.arange(len(scan)) % 5 == 0
    result = register_robust(faces[pipe], scan[~held])
    before = project(faces[pipe].surface, scan)
    near = (np.abs(before.height) < 8) & (np.abs(before.height) > 0)
    after = np.abs(project(faces[pipe].surface, scan, result.displacement).height)
    near &= after < 5 * result.noise
    assert after[near & held].mean() < 1.1 * after[near & ~held].mean()
    assert after[near & held].mean() < np.abs(before.height[near & held]).mean()
    assert 1.0 < result.noise < 2.5
