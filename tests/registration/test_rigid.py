# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rigid alignment: scans of generated parts with known poses.

A pose counts as right within 1 mm and 0.5°, the project's own line for a failed alignment. Truth is the motion that the
test itself applied to the simulated scan.
"""
from __future__ import annotations

import json
from pathlib import Path

import FreeCAD
import numpy as np
import Part
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ffds_workbench import api
from ffds_workbench.brep import workpiece
from ffds_workbench.brep.simulated_scan import scene_of as sensor_target_of
from ffds_workbench.registration.motions import angle, apply, best_fit, describe_difference, motion, shift
from ffds_workbench.registration.rigid import AMBIGUOUS, FAILED, OK, RigidSettings, SampleSettings, align, target_of
from ffds_workbench.registration.rigid.deformation.deformed_pose import surface_cells
from ffds_workbench.registration.rigid.deformation.displacement_field import DisplacementField, displacement_basis
from ffds_workbench.registration.rigid.refine.scan_rims import ScanEnds, find_scan_ends, points_near_rims
from ffds_workbench.registration.rigid.symmetry import symmetry_of
from ffds_workbench.registration.rigid.scan_unit import plausible_scales
from ffds_workbench.registration.scan_points import sketch_of, table_of_sketch
from ffds_workbench.scan.sensor import SensorSettings, View, simulate

FAR, TURNED = 1.0, np.deg2rad(0.5)


def geometry(shape: Part.Shape) -> list:
    part = workpiece.read(shape)
    return [part.geometry(k) for k in range(len(part.faces))]


def bracket_shape() -> Part.Shape:
    """An L without any symmetry: two legs of unequal length, three holes."""
    shape = Part.makeBox(80, 60, 3).fuse(Part.makeBox(3, 60, 45)).removeSplitter()
    for x, y in ((55, 15), (30, 42)):
        shape = shape.cut(Part.makeCylinder(5, 10, FreeCAD.Vector(x, y, -3)))
    return shape.cut(Part.makeCylinder(7, 10, FreeCAD.Vector(-3, 40, 28), FreeCAD.Vector(1, 0, 0)))


def channel_shape() -> Part.Shape:
    """A U that a half turn about z maps onto itself."""
    return Part.makeBox(100, 40, 25, FreeCAD.Vector(-50, -20, 0)).cut(
        Part.makeBox(100, 34, 25, FreeCAD.Vector(-50, -17, 3)))


def scanned(shape: Part.Shape, seed: int = 1) -> np.ndarray:
    views = (View((0.5, 0.3, 1.0)), View((0.9, -0.3, 0.6)))
    return simulate(sensor_target_of(shape), SensorSettings(spacing=0.5, views=views, seed=seed)).points


def anywhere(scan: np.ndarray, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return motion(Rotation.random(random_state=seed).as_matrix(), rng.uniform(-400, 400, 3))


def nearby(scan: np.ndarray, seed: int) -> np.ndarray:
    """30° and 50 mm away."""
    axis, way = (v / np.linalg.norm(v) for v in np.random.default_rng(seed).normal(size=(2, 3)))
    rotation = Rotation.from_rotvec(np.deg2rad(30) * axis).as_matrix()
    middle = scan.mean(axis=0)
    return motion(rotation, middle - rotation @ middle + 50 * way)


def is_right(pose: np.ndarray, moved: np.ndarray, centre: np.ndarray) -> bool:
    found = pose @ moved
    return bool(shift(found, np.eye(4), centre) < FAR and angle(found, np.eye(4)) < TURNED)


@pytest.fixture(scope="module")
def bracket():
    shape = bracket_shape()
    return target_of(geometry(shape)), scanned(shape)


@pytest.fixture(scope="module")
def channel():
    shape = channel_shape()
    return target_of(geometry(shape)), scanned(shape)


def test_samples_lie_on_the_shape_and_heights_follow_the_curvature():
    """A cylinder of radius 10: the height of a point is its distance from the axis less 10, to the third order."""
    target = target_of(geometry(Part.makeCylinder(10, 40)))
    wall = np.abs(target.samples.normals[:, 2]) < 0.5
    assert np.abs(np.linalg.norm(target.samples.points[wall, :2], axis=1) - 10).max() < 1e-5
    rng = np.random.default_rng(0)
    turn, radius = rng.uniform(0, 2 * np.pi, 200), rng.uniform(9.5, 10.5, 200)
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), rng.uniform(10, 30, 200)], axis=1)
    height, normal = target.heights(points, target.tree.query(points)[1])
    assert np.abs(height - (radius - 10)).max() < 2e-3          # spacing³ / R² is 1e-3 mm
    assert np.abs(normal[:, 2]).max() < 1e-6


def test_faces_that_nothing_outside_sees_are_left_out():
    """Two boxes in contact: no sample lies where they touch."""
    shape = Part.makeCompound([Part.makeBox(40, 40, 10), Part.makeBox(40, 40, 10, FreeCAD.Vector(0, 0, 10))])
    points = target_of(geometry(shape)).samples.points
    inside = (np.abs(points[:, :2] - 20) < 15).all(axis=1)
    assert not (np.abs(points[inside, 2] - 10) < 1e-3).any()


def test_rims_are_where_the_surface_ends():
    """All edges of a box are rims; the seam of a cylinder is none."""
    rims = target_of(geometry(Part.makeCylinder(10, 40))).rims
    at_ends = np.minimum(np.abs(rims.points[:, 2]), np.abs(rims.points[:, 2] - 40)) < 1e-6
    assert at_ends.all() and len(rims.points) > 100


def test_normals_of_a_thin_sheet_keep_their_side_around_its_rim():
    """A rimmed plate 1.5 mm thick, seen on both sides: where it is flat each point's outside is known."""
    shape = Part.makeBox(80, 60, 12).cut(Part.makeBox(77, 57, 12, FreeCAD.Vector(1.5, 1.5, 1.5)))
    views = (View((0.3, 0.2, 1.0)), View((-0.5, 0.4, -1.0)), View((-0.6, -0.6, 0.6)))
    scan = simulate(sensor_target_of(shape), SensorSettings(spacing=0.4, views=views, seed=2)).points
    for seed in range(4):
        sketch = sketch_of(apply(anywhere(scan, seed), scan), np.random.default_rng(seed))
        back = np.linalg.inv(anywhere(scan, seed))
        points, normals = apply(back, sketch.points), sketch.normals @ back[:3, :3].T
        flat = (np.abs(points[:, :2] - (40, 30)) < (35, 25)).all(axis=1) & (sketch.piece == 0)
        side = normals[flat, 2] * np.where(points[flat, 2] > 0.75, 1.0, -1.0)
        assert flat.sum() > 500 and abs(np.mean(side > 0) - 0.5) > 0.47     # noise turns single ones


def ends_of(points: np.ndarray, reach: float, noise: float) -> ScanEnds:
    """Of a scan of a plate of 60 × 40 × 3 mm."""
    rims = target_of(geometry(Part.makeBox(60, 40, 3))).rims
    row, entry = points_near_rims(rims, points, reach)
    return find_scan_ends(rims, points[row], entry, reach, noise, 0.5)


@pytest.mark.parametrize(("noise", "shift_of_scan"), [(0.0, 0.15), (0.1, 0.15), (0.1, -0.2)])
def test_ends_of_a_scan_are_found_however_noise_blurs_them(noise, shift_of_scan):
    """The top of a plate alone, 20 points per mm²: a stretch of 2 mm is known to 0.05 mm beside the noise's 0.1 mm, of
    which it takes off what the fourth outermost point lies out."""
    rng = np.random.default_rng(0)
    top = np.column_stack([rng.uniform(0, 60, 48_000), rng.uniform(0, 40, 48_000), np.full(48_000, 3.0)])
    top[:, 1] += shift_of_scan
    ends = ends_of(top + rng.normal(0.0, noise, top.shape), 0.6, max(noise, 0.01))
    for side in (1.0, -1.0):
        mine = ends.outwards[:, 1] * side > 0.99
        assert mine.sum() > 10
        assert np.average(ends.gap[mine], weights=ends.weight[mine]) == pytest.approx(side * shift_of_scan, abs=0.09)


def test_cells_stand_for_the_surface_evenly():
    """A bent part's pose hangs on moments of its area: to 0.5 % of a box's, where 600 points at random give 4 %."""
    middles, area = surface_cells(target_of(geometry(Part.makeBox(60, 40, 3))))
    a, b, c = 60.0, 40.0, 3.0
    assert area.sum() == pytest.approx(2 * (a * b + b * c + a * c), rel=1e-3)
    np.testing.assert_allclose(np.average(middles, axis=0, weights=area), (a / 2, b / 2, c / 2), atol=0.1)
    second = np.average((middles[:, 0] - a / 2) ** 2, weights=area)
    exact = (2 * a**3 / 12 * (b + c) + 2 * b * c * a**2 / 4) / (2 * (a * b + b * c + a * c))
    assert second == pytest.approx(exact, rel=5e-3)


def test_nearest_point_of_the_rims_is_looked_up():
    """To within the voxel's diagonal, an eightieth of 60 mm · √3, and none where 8 % of 60 mm are far off."""
    rims = target_of(geometry(Part.makeBox(60, 40, 3))).rims
    points = np.random.default_rng(3).uniform((-9, -9, -9), (69, 49, 12), (5_000, 3))
    exact, found = rims.tree.query(points)[0], rims.nearest(points, np.eye(4))
    near, diagonal = found >= 0, 60.0 / 80.0 * np.sqrt(3.0)
    assert (np.linalg.norm(points[near] - rims.points[found[near]], axis=1) < exact[near] + diagonal).all()
    assert near[exact < 4.8 - diagonal].all() and not near[exact > 4.8 + diagonal].any()


def test_a_wall_that_is_seen_is_no_end():
    """Beside a wall that the scan shows, points below the face would count as the face going on."""
    rng = np.random.default_rng(0)
    top = np.column_stack([rng.uniform(0, 60, 48_000), rng.uniform(0, 40, 48_000), np.full(48_000, 3.0)])
    wall = np.column_stack([rng.uniform(0, 60, 3600), np.full(3600, 40.0), rng.uniform(0, 3, 3600)])
    ends = ends_of(np.concatenate([top, wall]), 0.3, 0.01)
    assert not ((ends.places[:, 1] > 39.9) & (ends.outwards[:, 1] > 0.99)).any()
    assert ((ends.places[:, 1] < 0.1) & (ends.outwards[:, 1] < -0.99)).any()


def test_a_stretch_unlike_its_neighbours_is_no_end():
    """A notch of 2 mm in the scan, where a clamp hid the part: no end is told in it."""
    rng = np.random.default_rng(0)
    top = np.column_stack([rng.uniform(0, 60, 48_000), rng.uniform(0, 40, 48_000), np.full(48_000, 3.0)])
    notch = (np.abs(top[:, 0] - 30.0) < 1.0) & (top[:, 1] > 38.0)
    ends = ends_of(top[~notch], 3.0, 0.01)
    far = (ends.outwards[:, 1] > 0.99) & (ends.places[:, 2] > 2.9)
    assert far.sum() > 10 and np.abs(ends.gap[far]).max() < 0.3


def test_points_of_a_sheet_lie_beside_rims_of_the_side_that_is_seen():
    """The top of a plate that is off by 2 of its 3 mm lies nearer to the rims of the bottom."""
    rims = target_of(geometry(Part.makeBox(60, 40, 3))).rims
    top = np.column_stack([np.random.default_rng(0).uniform(0, (60, 40), (20_000, 2)), np.full(20_000, 1.0)])
    hidden = rims.faces[:, 2] < -0.5
    assert hidden.any() and not (rims.normals[points_near_rims(rims, top, 1.0)[1], 2] > 0.5).any()
    assert (rims.normals[points_near_rims(rims, top, 1.0, hidden)[1], 2] > 0.5).any()


def linear(space, gradient: np.ndarray, shift_of_all: np.ndarray) -> DisplacementField:
    """d(X) = A (X − middle) + b."""
    return DisplacementField(space, np.vstack([shift_of_all, 0.5 * space.size * gradient.T]))


def test_strain_of_a_deformation_is_greens():
    """½ (A + Aᵀ + AᵀA) for d = A X + b, so none for a turn; derivatives against differences of it."""
    space = displacement_basis(target_of(geometry(Part.makeBox(60, 40, 3))))
    rng = np.random.default_rng(0)
    a = 0.2 * rng.normal(size=(3, 3))
    turn = Rotation.from_rotvec((0.3, -0.5, 0.2)).as_matrix() - np.eye(3)
    components = ((0, 0, 1.0), (0, 1, np.sqrt(2.0)), (1, 2, np.sqrt(2.0)), (2, 2, 1.0))
    for gradient in (a, turn):
        strain = 0.5 * (gradient + gradient.T + gradient.T @ gradient)
        local = np.einsum("ain,ij,bjn->nab", space.frames, strain, space.frames)
        expected = np.concatenate([share * local[:, i, j] for i, j, share in components])
        found = linear(space, gradient, rng.normal(size=3)).strains(components)[0]
        np.testing.assert_allclose(found, expected, atol=1e-12)
    coefficients = 0.1 * rng.normal(size=(len(space.degree), 3))
    step = 1e-6 * rng.normal(size=coefficients.shape)
    rows = DisplacementField(space, coefficients).strains(components)[1]
    before, after = (DisplacementField(space, coefficients + k * step).strains(components)[0] for k in (-1.0, 1.0))
    np.testing.assert_allclose(2.0 * step.ravel() @ rows, after - before, atol=1e-12)


def test_a_deformation_moves_with_the_part():
    """M (X + d(X)) = X + d'(X) inside the box that the polynomials are evaluated in, to single precision of 30 mm."""
    space = displacement_basis(target_of(geometry(Part.makeBox(60, 40, 3))))
    rng = np.random.default_rng(0)
    deformation = DisplacementField(space, rng.normal(size=(len(space.degree), 3)))
    move = motion(Rotation.from_rotvec((0.2, 0.1, -0.3)).as_matrix(), np.array([3.0, -2.0, 1.0]))
    places = rng.uniform((0, 0, 0), (60, 40, 3), (200, 3))
    np.testing.assert_allclose(places + deformation.moved(move)(places), apply(move, places + deformation(places)),
                               atol=1e-4)


def test_poses_are_told_apart_in_words():
    half = motion(Rotation.from_rotvec([0, 0, -np.pi]).as_matrix(), np.array([1.0, 2.0, 3.0]))
    assert describe_difference(np.eye(4), half, np.zeros(3)) == "turned by 180° about z"
    up = motion(np.eye(3), np.array([0.0, 0.0, -3.0]))
    assert describe_difference(half, up @ half, np.zeros(3)) == "moved by 3 mm along −z"


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("mode", ["fine", "global"])
def test_finds_the_pose(bracket, mode, seed):
    target, scan = bracket
    moved = (nearby if mode == "fine" else anywhere)(scan, seed)
    found = align(target, apply(moved, scan), mode, seed=seed)
    assert found.verdict == OK and is_right(found.T_model_scan, moved, target.centre)
    assert found.fitness > 0.99 and found.confidence > 0.5


def test_bias_on_an_undeformed_part(bracket):
    """The line is 0.02 mm; noise of 0.13 mm over some thousand points leaves a few micrometres."""
    target, scan = bracket
    moved = anywhere(scan, 5)
    found = align(target, apply(moved, scan), "global")
    assert shift(found.T_model_scan @ moved, np.eye(4), target.centre) < 0.02


@pytest.mark.parametrize(("share", "seed"), [(0.05, 7), (0.05, 2), (0.2, 1)])
def test_cropped_scan_with_clutter(bracket, share, seed):
    """A quarter of the scan missing and stray points in its box: they hardly weigh on what the scan proves."""
    target, scan = bracket
    part = scan[scan[:, 1] < np.quantile(scan[:, 1], 0.75)]
    rng = np.random.default_rng(0)
    stray = rng.uniform(part.min(axis=0), part.max(axis=0), (int(share * len(part)), 3))
    moved = anywhere(part, seed)
    found = align(target, apply(moved, np.concatenate([part, stray])), "global")
    assert found.verdict == OK and is_right(found.T_model_scan, moved, target.centre)
    assert found.explained > 0.9 and found.confidence > 0.25


def test_table_with_most_of_the_points(bracket):
    target, scan = bracket
    rng = np.random.default_rng(0)
    place = rng.uniform(-60, 140, (int(1.5 * len(scan)), 2))
    hidden = cKDTree(target.samples.points[:, :2]).query(place)[0] < 2.0
    table = np.column_stack([place, rng.normal(0, 0.13, len(place))])[~hidden]
    moved = anywhere(scan, 3)
    found = align(target, apply(moved, np.concatenate([scan, table])), "global")
    assert found.table and is_right(found.T_model_scan, moved, target.centre)


def test_no_table_where_there_is_none(bracket):
    target, scan = bracket
    rng = np.random.default_rng(0)
    assert table_of_sketch(sketch_of(scan, rng), target.largest_projection, rng) is None


@pytest.mark.parametrize("mode", ["fine", "global"])
def test_symmetric_part_is_ambiguous_and_every_pose_is_listed(channel, mode):
    target, scan = channel
    moved = (nearby if mode == "fine" else anywhere)(scan, 2)
    found = align(target, apply(moved, scan), mode)
    assert found.verdict == AMBIGUOUS and "180°" in found.symmetry and len(found.poses) == 2
    assert any(is_right(pose.T_model_scan, moved, target.centre) for pose in found.poses)


def test_symmetries():
    box = symmetry_of(target_of(geometry(Part.makeBox(60, 40, 20))))
    assert len(box.motions) == 3 and box.exact.all()             # three half turns
    assert symmetry_of(target_of(geometry(Part.makeCylinder(10, 40)))).axis is not None
    pipe = symmetry_of(target_of(geometry(Part.makeCylinder(30, 200).cut(Part.makeCylinder(27, 200)))))
    assert pipe.axis is not None and pipe.ends_alike             # what can be seen of its bore has ragged borders
    cone = symmetry_of(target_of(geometry(Part.makeCone(20, 5, 40))))
    assert cone.axis is not None and not cone.ends_alike
    assert not symmetry_of(target_of(geometry(bracket_shape()))).exact.any()


@pytest.mark.parametrize(("scale", "unit"), [(1000.0, "m"), (10.0, "cm"), (25.4, "in"), (100.0, "dm")])
def test_unit_is_recognised(bracket, scale, unit):
    target, scan = bracket
    assert scale in plausible_scales(scan / scale, target.size)
    found = align(target, scan / scale, "global")
    assert found.unit == unit and found.verdict == OK


def test_deformed_sheet_keeps_its_sides(bracket):
    """Bent by 5 mm, more than its thickness: the pose that fits all of it best, each point against where it was."""
    target, scan = bracket
    bent = scan + np.outer(5.0 * ((scan[:, 1] - 30) / 30) ** 2 - 5.0 / 3, [0.0, 0.0, 1.0])
    whole = target.even.points
    goal = best_fit(whole + np.outer(5.0 * ((whole[:, 1] - 30) / 30) ** 2 - 5.0 / 3, [0.0, 0.0, 1.0]), whole)
    moved = anywhere(scan, 4)
    found = align(target, apply(moved, bent), "global")
    assert found.verdict == OK
    assert shift(found.T_model_scan @ moved, goal, target.centre) < FAR
    assert angle(found.T_model_scan @ moved, goal) < TURNED


def test_plain_plate_from_one_side_is_ambiguous():
    """Its top face alone: every pose that the plate's half turns connect, and no noise to divide by."""
    target = target_of(geometry(Part.makeBox(60, 40, 3)))
    top = np.column_stack([np.random.default_rng(0).uniform(0, (60, 40), (20_000, 2)), np.full(20_000, 3.0)])
    moved = anywhere(top, 1)
    found = align(target, apply(moved, top), "global")
    assert found.verdict == AMBIGUOUS and len(found.poses) >= 4 and "180°" in found.reason
    assert any(is_right(pose.T_model_scan, moved, target.centre) for pose in found.poses)


def test_a_plane_face_is_aligned():
    random = np.random.default_rng(0)
    scan = np.column_stack([random.uniform((0, 0), (60, 40), (5000, 2)), random.normal(0, 0.05, 5000)])
    found = align(target_of(geometry(Part.makePlane(60, 40))), apply(anywhere(scan, 3), scan), "global")
    assert found.verdict == AMBIGUOUS


def test_another_part_fails(bracket, channel):
    assert align(channel[0], apply(anywhere(bracket[1], 1), bracket[1]), "global").verdict == FAILED


def test_command_writes_scan_and_pose(ffds, tmp_path: Path, bracket):
    target, scan = bracket
    bracket_shape().exportStep(str(tmp_path / "part.step"))
    np.savetxt(tmp_path / "scan.xyz", apply(anywhere(scan, 6), scan)[::5] / 1000)
    process = ffds("align", "part.step", "scan.xyz", "--out", "aligned.ply", "--pose", "pose.json")
    assert process.returncode == 0, process.stderr
    pose = json.loads((tmp_path / "pose.json").read_text())
    assert pose["verdict"] == "ok" and pose["unit"] == "m"
    aligned = api.read_scan(tmp_path / "aligned.ply").points
    assert np.abs(aligned - scan[::5]).max() < 1.0


def test_command_writes_nothing_when_it_fails(ffds, tmp_path: Path, channel):
    bracket_shape().exportStep(str(tmp_path / "part.step"))
    np.savetxt(tmp_path / "scan.xyz", channel[1][::5])
    process = ffds("align", "part.step", "scan.xyz", "--out", "aligned.ply", "--pose", "pose.json")
    assert process.returncode == 3 and "could not be aligned" in process.stderr
    assert len(process.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "aligned.ply").exists() and not (tmp_path / "pose.json").exists()


def test_real_weld_part(shared_data: Path):
    """Raw scan in metres and in the robot's frame, noise 1.6 mm: no worse than the pose that its makers found."""
    folder = shared_data / "weld_pipe_on_angle"
    faces = geometry(api.read_model(folder / "nominal.step").shape)
    raw = api.read_scan(folder / "scan_robot_laser_60deg.pcd").points
    known = np.array(json.loads((folder / "pose.json").read_text())["T_model_scan_mm"])
    found = align(target_of(faces), raw, "global")
    dense = cKDTree(target_of(faces, RigidSettings(samples=SampleSettings(250_000))).samples.points)
    (fitness, rmse), (known_fitness, known_rmse) = (
        (float((d < 4).mean()), float(np.sqrt((d[d < 4] ** 2).mean())))
        for d in (dense.query(apply(pose, 1000 * raw))[0] for pose in (found.T_model_scan, known)))
    assert found.unit == "m" and found.verdict == OK
    assert fitness >= known_fitness and rmse <= 1.05 * known_rmse
