# SPDX-License-Identifier: LGPL-2.1-or-later
"""Foot points against closed forms, on a plane, a full cylinder and a sphere with both poles."""
import numpy as np
import pytest

from ffds_workbench.benchmark.simulated import sheet
from ffds_workbench.benchmark.speed import curved_face
from ffds_workbench.registration.face.robust_fit.face_points import face_points
from ffds_workbench.registration.face_geometry import FaceGeometry
from ffds_workbench.registration.footpoints import surface_coordinates
from ffds_workbench.registration.projection import project
from ffds_workbench.registration.uv_raster import make_raster

RADIUS = 20.0


def test_plane_is_exact():
    scan = sheet.scan("A", 1, 5000)
    found = surface_coordinates(make_raster(sheet.nominal()), scan, 10.0)
    assert len(found.index) == 5000
    np.testing.assert_allclose(found.height, scan[:, 2], atol=1e-12)


@pytest.mark.parametrize("outward", [1, -1])
def test_cylinder(outward):
    """Heights up to 9 mm over R = 20 mm. The frames are quadratic: third order of half a cell (0.7 mm) leaves 1e-4."""
    random = np.random.default_rng(2)
    plain = curved_face()
    face = FaceGeometry("Face1", "Cylinder", plain.surface, plain.trims, outward)
    angle, z = random.uniform((0, 0.5), (2 * np.pi, 59.5), (20000, 2)).T
    height = random.uniform(-9, 9, 20000)
    scan = np.stack([(RADIUS + height) * np.cos(angle), (RADIUS + height) * np.sin(angle), z], axis=1)
    raster = make_raster(face)
    found = surface_coordinates(raster, scan, 10.0)
    assert len(found.index) == 20000
    np.testing.assert_allclose(found.height, outward * height, atol=1e-4)
    turns = (found.x / raster.shape[0] * 2 * np.pi - angle + np.pi) % (2 * np.pi) - np.pi
    assert np.abs(turns).max() * RADIUS < 0.02


def test_sphere_with_poles(ball):
    """All but the few points right over the poles, where parameters end, are found; heights as on the cylinder."""
    random = np.random.default_rng(4)
    way = random.normal(size=(20000, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    height = random.uniform(-3, 3, 20000)
    found = surface_coordinates(make_raster(ball), way * (RADIUS + height)[:, None], 10.0)
    assert len(found.index) > 0.99 * 20000
    np.testing.assert_allclose(found.height, height[found.index], atol=1e-3)


def test_projection_is_exact(ball):
    """Damped Newton to 1e-9 mm on a surface that is itself within 4e-6 mm of the sphere."""
    random = np.random.default_rng(5)
    way = random.normal(size=(2000, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    height = random.uniform(-5, 5, 2000)
    found = project(ball.surface, way * (RADIUS + height)[:, None])
    np.testing.assert_allclose(found.height, height, atol=1e-5)


@pytest.mark.parametrize("points", [20_000, 300_000], ids=["kept", "located anew"])
def test_inner_points_and_rim_share_the_face(points):
    scan = sheet.scan("D", 0, points)
    raster = make_raster(sheet.nominal())
    found = face_points(raster, scan, 10.0, 0.7, 5000)
    inner, rim = (np.concatenate([piece[k].index for piece in found.pieces()]) for k in (0, 1))
    x, y = scan[:, 0], scan[:, 1]
    nearest, next_nearest = np.sort([x, sheet.SIZE[0] - x, y, sheet.SIZE[1] - y], axis=0)[:2]
    nearest[next_nearest < 2.5] = np.nan      # in the corners, within two cells, depth is not linear as it is taken
    assert np.nanmin(nearest[inner]) > 0.6 and np.nanmax(nearest[rim]) < 0.8
    whole = surface_coordinates(raster, scan, 10.0, 0.0).index
    np.testing.assert_array_equal(np.sort(np.concatenate([inner, rim])), whole)
    assert len(found.sample.x) == 5000 and found.count == pytest.approx(len(inner), rel=0.02)


def test_points_elsewhere_are_left_out():
    found = surface_coordinates(make_raster(curved_face()), np.full((100, 3), 1e4), 10.0)
    assert len(found.index) == 0
