# SPDX-License-Identifier: LGPL-2.1-or-later
"""The published algorithm: its pseudo-inverses, its steps on a sheet, and what it refuses."""
import numpy as np
import pytest

from ffds_workbench.benchmark.simulated import sheet
from ffds_workbench.benchmark.speed import curved_face, curved_scan
from ffds_workbench.errors import RefusedError
from ffds_workbench.registration.face.control_lattice import displacement_lattice
from ffds_workbench.registration.face.ffds import (equidistant_grid, lattice_basis, pseudo_inverse, register_ffds,
                                                   solve_lattice)
from ffds_workbench.registration.face_geometry import FaceGeometry
from ffds_workbench.registration.trims import inside_trims

RANDOM = np.random.default_rng(3)


@pytest.mark.parametrize("face", [sheet.nominal(), curved_face()], ids=["plane", "closed cylinder"])
@pytest.mark.parametrize("size", [(5, 5), (10, 7), (4, 12)])
def test_kronecker_form_equals_the_dense_pseudo_inverse(face, size):
    """B⁺ = B_u⁺ ⊗ B_v⁺ exactly; 1e-12 leaves room for rounding in an SVD of 400 × 100 numbers of order 1."""
    control = displacement_lattice(face.surface, size)
    u, v, on_face = equidistant_grid(face, 400)
    values = RANDOM.normal(size=(400, 3))
    dense = pseudo_inverse(lattice_basis(control, u, v)) @ values
    np.testing.assert_allclose(solve_lattice(control, u, v, on_face, values), dense, rtol=0, atol=1e-12)


def test_a_field_of_the_lattice_is_found_exactly():
    """Where the displacement lies in the space of Eq. 2, Eq. 4 returns its control points, up to rounding."""
    face = sheet.nominal()
    control = displacement_lattice(face.surface, (6, 5))
    points = RANDOM.normal(size=(30, 3))
    u, v, on_face = equidistant_grid(face, 400)
    moved = control.field(points).on_grid(u, v).reshape(-1, 3)
    np.testing.assert_allclose(solve_lattice(control, u, v, on_face, moved), points, atol=1e-11)


def test_the_sheet_without_noise():
    """A dense clean scan of a gentle bulge: nearest points are off by no more than their spacing along the slope.

    Spacing 0.2 mm, steepest slope 0.27: 0.5 × 0.2 × 0.27 = 0.03 mm, and as much again by sliding on 5 mm of height.
    """
    x, y = np.meshgrid(np.arange(0, 75.1, 0.2), np.arange(0, 70.1, 0.2))
    scan = np.stack([x, y, 0.2 * sheet.height(x, y)], axis=-1).reshape(-1, 3)
    result = register_ffds(sheet.nominal(), scan, (10, 10), 400)
    moved = sheet.nominal().surface.control_points[0, 0] + result.displacement(np.array([[37.0, 35.0]]))[0]
    grid = result.displacement.on_grid(np.linspace(5, 70, 30), np.linspace(5, 65, 30))
    px, py = np.linspace(5, 70, 30)[:, None] + grid[..., 0], np.linspace(5, 65, 30) + grid[..., 1]
    assert np.isfinite(moved).all()
    assert np.abs(grid[..., 2] - 0.2 * sheet.height(px, py)).max() < 0.06
    assert result.lattice == (10, 10)
    assert result.coverage == 1.0


def test_source_points_in_a_hole_are_dropped():
    plain = sheet.nominal()
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    hole = np.stack([37 + 15 * np.cos(angle), 35 + 15 * np.sin(angle)], axis=1)
    face = FaceGeometry("Face1", "Plane", plain.surface, (*plain.trims, hole), 1)
    u, v, on_face = equidistant_grid(face, 400)
    expected = np.hypot(u[:, None] - 37, v - 35) > 15
    assert (on_face != expected).sum() <= 4  # the hole is a polygon of 60 sides, 0.02 mm inside the circle
    result = register_ffds(face, sheet.scan("A", 0), (8, 8), 400)
    assert sheet.deviation(result.displacement)[::7].mean() < 0.5


def test_trims_of_a_closed_direction_may_cross_the_seam():
    face = curved_face()
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    hole = np.stack([2 * np.pi + 0.4 * np.cos(angle), 30 + 8 * np.sin(angle)], axis=1)
    face = FaceGeometry("Face1", "Cylinder", face.surface, (*face.trims, hole), 1)
    inside = inside_trims(face, np.array([0.1, 0.3, 1.0, 5.0, 6.0, 6.2]), np.array([10.0, 30.0]))
    np.testing.assert_array_equal(inside[:, 0], True)
    np.testing.assert_array_equal(inside[:, 1], [False, False, True, True, False, False])


def test_a_closed_face_stays_closed():
    result = register_ffds(curved_face(), curved_scan(20000), (10, 6), 400)
    v = np.linspace(0, 60, 9)
    for order in (0, 1, 2):
        field = result.displacement.derivative(order, 0)
        start, end = (np.stack([np.full(9, u), v], axis=1) for u in (0.0, 2 * np.pi - 1e-12))
        np.testing.assert_allclose(field(start), field(end), atol=1e-8)


@pytest.mark.parametrize(("lattice", "source", "moved", "text"), [
    ((30, 30), 400, 0.0, "too fine"), ((10, 10), 400, 1e4, "does not lie on Sheet")])
def test_refusals_say_what_to_do(lattice, source, moved, text):
    with pytest.raises(RefusedError, match=text):
        register_ffds(sheet.nominal(), sheet.scan("A", 0, 3000) + moved, lattice, source)


def test_a_lattice_that_hangs_over_a_hole_is_refused_and_auto_takes_a_coarser_one():
    """Control points over a hole of a third of the face are held by hardly any source point."""
    plain = sheet.nominal()
    hole = np.array([[15.0, 15.0], [60.0, 15.0], [60.0, 50.0], [15.0, 50.0], [15.0, 15.0]])
    face = FaceGeometry("Face1", "Plane", plain.surface, (*plain.trims, hole), 1)
    scan = sheet.scan("A", 0)
    with pytest.raises(RefusedError, match="too fine for Face1: around holes"):
        register_ffds(face, scan, (12, 12), 400)
    chosen = register_ffds(face, scan, None, 400)
    assert max(chosen.lattice) < 10
    assert np.abs(chosen.displacement.control_points).max() < 4 * 8.0  # the sheet rises less than 8 mm
