# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deformation by a lattice in space: its equations, its fast form against the dense one, and what it gives."""
from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from ffds_workbench.errors import RefusedError
from ffds_workbench.registration.face import ffd, ffds
from ffds_workbench.registration.face.control_lattice import displacement_lattice
from ffds_workbench.registration.face_geometry import FaceGeometry
from ffds_workbench.registration.splines import SplineSurface, clamped_knots, greville


def plane(size_u: float = 75.0, size_v: float = 70.0, hole: bool = False) -> FaceGeometry:
    ku, kv = clamped_knots(0.0, size_u, 4), clamped_knots(0.0, size_v, 4)
    u, v = np.meshgrid(greville(ku), greville(kv), indexing="ij")
    surface = SplineSurface(ku, kv, np.stack([u, v, np.zeros_like(u)], axis=-1))
    outer = np.array([[0, 0], [size_u, 0], [size_u, size_v], [0, size_v], [0, 0]], dtype=float)
    trims = (outer, np.array([[20, 20], [40, 20], [40, 40], [20, 40], [20, 20]], dtype=float)) if hole else (outer,)
    return FaceGeometry("Face1", "Plane", surface, trims, 1)


def arch() -> FaceGeometry:
    """A curved face: a parabolic arch."""
    face = plane()
    points = face.surface.control_points.copy()
    points[1:3, :, 2] = 30.0
    surface = SplineSurface(face.surface.knots_u, face.surface.knots_v, points)
    return FaceGeometry("Face1", "BSplineSurface", surface, face.trims, 1)


def source_of(face: FaceGeometry, count: int) -> ffd.FaceSource:
    u, v, on_face = ffds.equidistant_grid(face, count)
    return ffd.FaceSource(u, v, face.surface.on_grid(u, v), on_face)


def bulge(points):
    x, y = points[..., 0] / 75 - 0.5, points[..., 1] / 70 - 0.5
    return np.stack([0.3 * x * y, 0.2 * y, 4 * np.exp(-(x**2 + y**2) / 0.2) + x], axis=-1)


@pytest.mark.parametrize("face", [plane(), arch()])
def test_undeformed_lattice_is_the_identity(face):
    lattice = ffd.enclose(face, (6, 5, 4))
    points = face.surface.on_grid(np.linspace(0, 75, 7), np.linspace(0, 70, 8)).reshape(-1, 3)
    moved = ffd.volume_basis(lattice, points) @ lattice.control_points.reshape(-1, 3)
    assert np.abs(moved - points).max() < 1e-12 * 75        # rounding
    assert np.abs((lattice.axes @ lattice.axes.T) - np.eye(3)).max() < 1e-12


def test_a_point_depends_on_64_control_points():
    lattice = ffd.enclose(arch(), (8, 8, 8))
    points = arch().surface(np.random.default_rng(0).uniform(5, 65, (50, 2)))
    assert (np.count_nonzero(ffd.volume_basis(lattice, points), axis=1) <= 64).all()
    control = np.random.default_rng(1).normal(size=(8, 8, 8, 3))
    direct = ffd.volume_basis(lattice, points) @ control.reshape(-1, 3)
    assert np.abs(lattice.displacement(control, points) - direct).max() < 1e-12


@pytest.mark.parametrize("face", [plane(), plane(hole=True), arch()], ids=["grid", "holed", "curved"])
def test_fast_solution_is_the_pseudo_inverse(face):
    lattice = ffd.enclose(face, (6, 6, 6))
    source = source_of(face, 400)
    points = source.points[source.on_face]
    values = bulge(points)
    dense = ffd.solve_volume_dense(lattice, points, values)
    fast = ffd.solve_volume(lattice, source, values)
    assert np.abs(fast - dense).max() < 1e-7 * np.abs(dense).max()   # the Gram matrix squares the condition, 1e3 to 1e5
    effect = [lattice.displacement(control, points) for control in (dense, fast)]
    assert np.abs(effect[0] - effect[1]).max() < 1e-9


def test_on_an_aligned_plane_it_is_the_surface_based_deformation():
    face = plane()
    source = source_of(face, 400)
    values = bulge(source.points.reshape(-1, 3))
    lattice = ffd.enclose(face, (7, 7, 7))
    control = displacement_lattice(face.surface, (7, 7))
    surface_based = control.field(ffds.solve_lattice(control, source.u, source.v, source.on_face, values))
    uv = np.random.default_rng(2).uniform((0, 0), (75, 70), (500, 2))
    in_space = lattice.displacement(ffd.solve_volume_dense(lattice, source.points.reshape(-1, 3), values),
                                    face.surface(uv))
    assert np.abs(in_space - surface_based(uv)).max() < 1e-10
    told = ffd.on_surface(lattice, ffd.solve_volume(lattice, source, values), face.surface, (7, 7))
    assert told.control_points.shape == (7, 7, 3)
    assert np.abs(told(uv) - surface_based(uv)).max() < 1e-10


@pytest.mark.parametrize("face", [plane(), plane(hole=True), arch()], ids=["grid", "holed", "curved"])
def test_registration_follows_the_scan(face):
    rng = np.random.default_rng(3)
    nominal = face.surface(rng.uniform((0, 0), (75, 70), (40_000, 2)))
    scan = nominal + bulge(nominal)
    result = ffd.register_ffd(face, scan, lattice=(8, 8))
    check = face.surface(rng.uniform((3, 3), (72, 67), (300, 2)))
    before = cKDTree(scan).query(check)[0]
    uv = rng.uniform((3, 3), (72, 67), (300, 2))
    after = cKDTree(scan).query(face.surface(uv) + result.displacement(uv))[0]
    assert result.coverage == 1.0
    # closest points slide on the bulge: the mean falls to the spacing of the scan, 0.5/√density = 0.18 mm, and little
    assert after.mean() < 0.3 and after.mean() < 0.25 * before.mean()


def test_a_scan_elsewhere_is_refused():
    with pytest.raises(RefusedError, match="Face1"):
        ffd.register_ffd(plane(), np.random.default_rng(4).uniform(500, 600, (1000, 3)))
