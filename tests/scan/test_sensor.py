# SPDX-License-Identifier: LGPL-2.1-or-later
"""The virtual sensor against closed forms. Statistical tolerances are about four standard errors of the sample."""
from __future__ import annotations

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from ffds_workbench.brep import workpiece
from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.scan.sensor import Scene, SensorSettings, View, make_truth, simulate
from ffds_workbench.scan.sensor.errors import correlated
from ffds_workbench.scan.sensor.truth import foot

UP = View((0.0, 0.0, 1.0))


def target_of(shape: Part.Shape, displace=None) -> Scene:
    piece = workpiece.read(shape)
    faces = [piece.geometry(i) for i in range(len(piece.faces))]
    return Scene(faces, dict.fromkeys(range(len(faces)), displace) if displace else None)


@pytest.fixture(scope="module")
def holed_plate() -> Part.Shape:
    plate = Part.makePlane(60, 40)
    return plate.cut(Part.makeCylinder(8, 10, Vector(20, 20, -5))).Faces[0]


def test_area_uniform_on_the_trimmed_face(holed_plate):
    scan = simulate(target_of(holed_plate), SensorSettings(spacing=0.2, noise=0.0, seed=1))
    expected = holed_plate.Area * 25
    assert abs(len(scan.points) - expected) < 4 * np.sqrt(expected)
    assert np.abs(scan.points[:, 2]).max() < 1e-9
    # the trim polyline lies up to R(1 − cos(π/64)) = 0.01 mm inside the circle of 8 mm
    assert np.hypot(*(scan.points[:, :2] - 20).T).min() > 8 - 0.02
    clear = scan.points[scan.points[:, 0] > 30]
    counts = np.histogram2d(clear[:, 0], clear[:, 1], bins=(6, 8), range=((30, 60), (0, 40)))[0]
    assert np.abs(counts - 625).max() < 4.5 * np.sqrt(625)


def test_points_lie_on_curved_faces_exactly():
    scan = simulate(target_of(Part.makeSphere(20)), SensorSettings(spacing=0.5, noise=0.0))
    assert np.abs(np.linalg.norm(scan.points, axis=1) - 20).max() < 5e-6      # the lattices' own 4e-6 mm
    octant = (np.sign(scan.points) + 1) @ [0.5, 1, 2]
    counts = np.bincount(octant.astype(int), minlength=8)
    assert np.abs(counts - counts.mean()).max() < 4.5 * np.sqrt(counts.mean())


def test_a_plate_hides_what_is_behind_it():
    above, below = Part.makePlane(20, 20, Vector(-10, -10, 30)), Part.makePlane(60, 60, Vector(-30, -30, 0))
    settings = SensorSettings(spacing=0.3, noise=0.0, views=(UP,))
    target = target_of(Part.makeCompound([above, below]))
    scan = simulate(target, settings)
    lower = scan.points[scan.face == 1]
    reach = np.abs(lower[:, :2]).max(axis=1)
    camera = 15 + settings.standoff            # above the middle of the box
    shadow = 10 * camera / (camera - 30)       # the upper plate's half side, projected on the lower plate
    assert abs(reach.min() - shadow) < 1.0     # one to two pixels of the depth picture
    truth = make_truth(target, settings, np.zeros((0, 200, 3)), np.zeros((0, 200, 3)))
    wrong = truth.visible != ((truth.face == 0) | (np.abs(truth.warped[:, :2]).max(axis=1) > shadow))
    assert np.abs(np.abs(truth.warped[wrong][:, :2]).max(axis=1) - shadow).max(initial=0) < 1.0


def test_back_faces_and_steep_walls_are_not_seen():
    scan = simulate(target_of(Part.makeBox(30, 30, 10)), SensorSettings(spacing=0.3, noise=0.0, views=(UP,)))
    assert np.abs(scan.points[:, 2] - 10).max() < 1e-9


def test_field_of_view_density_and_limit():
    target = target_of(Part.makePlane(240, 240, Vector(-120, -120, 0)))
    settings = SensorSettings(spacing=0.5, noise=0.0, views=(UP,))
    points = simulate(target, settings).points
    assert np.allclose(np.ptp(points, axis=0)[:2], (155, 118), atol=0.1)
    assert abs(len(points) - 155 * 118 * 4) < 4 * np.sqrt(155 * 118 * 4)
    fewer = simulate(target, SensorSettings(spacing=0.5, noise=0.0, views=(UP,), limit=1000)).points
    assert len(fewer) == 1000
    aimed = simulate(target, SensorSettings(spacing=0.5, views=(View((0, 0, 1), aim=(40, 0, 0)),))).points
    assert abs(aimed[:, 0].mean() - 40) < 1


def test_noise_is_along_the_line_of_sight():
    target = target_of(Part.makePlane(40, 40, Vector(-20, -20, 0)))
    view = View((1.0, 0.0, 1.0))
    white = simulate(target, SensorSettings(spacing=0.2, noise=0.13, views=(view,))).points
    # seen at 45°, give or take the rays' 3°
    assert abs(white[:, 2].std() - 0.13 * np.sqrt(0.5)) < 0.003
    along_normal = simulate(target, SensorSettings(spacing=0.2, noise=0.13)).points
    assert abs(along_normal[:, 2].std() - 0.13) < 0.003


def test_correlated_noise_has_the_covariance_of_filtered_white_noise():
    rng = np.random.default_rng(3)
    where = rng.uniform(0, 200, (60_000, 2))
    field = correlated(where, 1.5, rng)
    assert abs(field.std() - 1) < 0.05
    for lag in (1.0, 2.0, 4.0):
        other = correlated(np.concatenate([where, where + [lag, 0]]), 1.5, np.random.default_rng(4))
        measured = np.mean(other[:60_000] * other[60_000:])
        assert abs(measured - np.exp(-lag**2 / (4 * 1.5**2))) < 0.06


def test_gaps_outliers_and_dropouts():
    target = target_of(Part.makePlane(60, 60))
    whole = simulate(target, SensorSettings(spacing=0.3, noise=0.0, seed=2))
    gaps = simulate(target, SensorSettings(spacing=0.3, noise=0.0, holes=3, outliers=0.02, seed=2))
    inliers = gaps.face >= 0
    assert abs((~inliers).sum() - 0.02 * inliers.sum()) <= 1
    assert inliers.sum() < len(whole.points) - 3 * 0.25 * np.pi * 3**2 / 0.09
    beside = simulate(target, SensorSettings(spacing=0.3, noise=0.0, views=(UP,), edge_dropout=1.0)).points
    assert beside[:, :2].min() > 0.3 and beside[:, :2].max() < 59.7
    everywhere = simulate(target, SensorSettings(spacing=0.3, noise=0.0, edge_dropout=1.0)).points
    assert everywhere[:, :2].min() > 0.95 and everywhere[:, :2].max() < 59.05
    table = simulate(target, SensorSettings(spacing=0.3, noise=0.0, views=(UP,), table=2.0))
    assert np.allclose(table.points[table.face == -2][:, 2], -2.0)


def test_views_are_fused_with_their_pose_error():
    target = target_of(Part.makePlane(50, 50))
    settings = SensorSettings(spacing=0.4, noise=0.0, views=(UP, View((0.2, 0.1, 1.0))), pose_error=0.2, seed=5)
    scan = simulate(target, settings)
    assert set(scan.shot) == {0, 1}
    for shot, pose in enumerate(scan.poses):
        back = (scan.points[scan.shot == shot] - pose[:3, 3]) @ pose[:3, :3]
        assert np.abs(back[:, 2]).max() < 1e-9 and np.linalg.norm(pose[:3, 3]) > 0


def test_the_seed_decides():
    target = target_of(Part.makeCylinder(10, 30))
    one, two, other = (simulate(target, SensorSettings(spacing=0.5, seed=seed, views=(UP,))) for seed in (1, 1, 2))
    assert np.array_equal(one.points, two.points) and not np.array_equal(one.points[:50], other.points[:50])


def test_truth_of_a_rolled_sheet_keeps_its_thickness():
    radius = 150.0

    def roll(_uv, points):
        angle, arm = points[:, 0] / radius, radius + points[:, 2] - 1.5
        return np.column_stack([arm * np.sin(angle), points[:, 1], arm * np.cos(angle) - radius + 1.5]) - points

    target = target_of(Part.makeBox(40, 30, 3), roll)
    truth = make_truth(target, SensorSettings(), np.zeros((0, 200, 3)), np.zeros((0, 200, 3)), thickness=3.0)
    assert len(truth.sheet_t) > 100 and np.abs(truth.sheet_t - 3).max() < 1e-6
    assert truth.visible.all()
    expected = truth.nominal + roll(None, truth.nominal)
    assert np.abs(truth.warped - expected).max() < 1e-9
    samples = target.sample(1.0, np.random.default_rng(0))
    top = max(range(6), key=lambda i: target.nominal(i, samples.uv[samples.face == i])[:, 2].min())
    uv, distance = foot(target, top, np.array([[radius * 0.1, 10.0, 100.0]]))
    axis = np.array([0.0, 1.5 - radius])
    exact = np.hypot(radius * 0.1, 100.0 - axis[1]) - (radius + 1.5)
    assert abs(distance[0] - exact) < 1e-6


def test_what_makes_no_sense_is_refused():
    with pytest.raises(InputError, match="spacing"):
        SensorSettings(spacing=0)
    with pytest.raises(InputError, match="share"):
        SensorSettings(outliers=1.5)
    with pytest.raises(InputError, match="view"):
        SensorSettings(table=1.0)
    with pytest.raises(RefusedError, match="nothing"):
        simulate(target_of(Part.makePlane(10, 10)), SensorSettings(views=(View((0, 0, -1)),)))
