# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bending energies against integrals done by hand."""
from dataclasses import replace

import numpy as np
import pytest

from ffds_workbench.benchmark.simulated import sheet
from ffds_workbench.benchmark.speed import curved_face
from ffds_workbench.registration.face.control_lattice import displacement_lattice
from ffds_workbench.registration.face.ffds import solve_lattice as fit_exactly
from ffds_workbench.registration.face.robust_fit.bending import bending_and_gauge, curvature_variation
from ffds_workbench.registration.face.robust_fit.normal_equations import normal_matrix, solve_banded
from ffds_workbench.registration.splines import SplineSurface

RADIUS, LENGTH = 20.0, 60.0


def dense(banded: np.ndarray) -> np.ndarray:
    band, size = banded.shape[0] - 1, banded.shape[1]
    full = np.zeros((size, size))
    for k in range(band + 1):
        full[np.arange(size - k), np.arange(k, size)] = banded[band - k, k:]
    return np.maximum(full, full.T) + np.minimum(full, full.T) - np.diag(np.diag(full))


def energy(face, size, components, field, of=lambda *args: bending_and_gauge(*args)[0]) -> float:
    lattice = displacement_lattice(face.surface, size)
    layout = normal_matrix(lattice, components)
    bending = of(face.surface, lattice, layout)
    u0, u1, v0, v1 = face.surface.range
    u, v = np.linspace(u0, u1, 60, endpoint=not lattice.periodic_u), np.linspace(v0, v1, 40)
    values = field(face.surface.on_grid(u, v).reshape(-1, 3))
    points = lattice.field(fit_exactly(lattice, u, v, np.ones((60, 40), bool), values)).control_points
    unknowns = np.zeros(layout.size)
    unknowns[layout.unknown.ravel()] = points.ravel()
    return float(unknowns @ dense(bending) @ unknowns)


def test_plane():
    """z = 0.001 x² + 0.002 x y: ∫ z_xx² + 2 z_xy² + z_yy² = (0.002² + 2·0.002²) · 75 · 70, exact for cubics."""
    field = lambda p: (0.001 * p[:, 0] ** 2 + 0.002 * p[:, 0] * p[:, 1])[:, None]
    assert energy(sheet.nominal(), (9, 7), 1, field) == pytest.approx(3 * 0.002**2 * 75 * 70, rel=1e-9)


def test_even_bending_of_a_plane():
    """What bends evenly costs nothing; z = a x³ + b x² y + c y³ costs ∫ z_xxx² + 3 z_xxy² + z_yyy², exact for cubics.

    The same plane with sheared parameters, over 75 × 70 mm again, costs the same."""
    evenly = lambda p: (0.001 * p[:, 0] ** 2 + 0.002 * p[:, 0] * p[:, 1])[:, None]
    a, b, c = 1e-5, 2e-5, 3e-5
    unevenly = lambda p: (a * p[:, 0] ** 3 + b * p[:, 0] ** 2 * p[:, 1] + c * p[:, 1] ** 3)[:, None]
    expected = ((6 * a) ** 2 + 3 * (2 * b) ** 2 + (6 * c) ** 2) * 75 * 70
    plane = sheet.nominal()
    shear = plane.surface.control_points @ np.array([[1.0, 0.0, 0.0], [0.4, 1.0, 0.0], [0.0, 0.0, 1.0]])
    for face in (plane, replace(plane, surface=replace(plane.surface, control_points=shear))):
        assert energy(face, (9, 7), 1, evenly, curvature_variation) < 1e-9 * expected
        assert energy(face, (9, 7), 1, unevenly, curvature_variation) == pytest.approx(expected, rel=1e-6)


def test_even_bending_of_a_plane_along_the_axes():
    """Tangents with zeros that no processor rounds: all numbers are powers of two. ∫ z_xxx² as above."""
    corners = np.array([[[0.0, 0.0, 0.0], [0.0, 32.0, 0.0]], [[64.0, 0.0, 0.0], [64.0, 32.0, 0.0]]])
    surface = SplineSurface(np.repeat([0.0, 64.0], 2), np.repeat([0.0, 32.0], 2), corners, degree_u=1, degree_v=1)
    face = replace(sheet.nominal(), surface=surface)
    cubic = lambda p: (1e-5 * p[:, 0] ** 3)[:, None]
    assert energy(face, (9, 7), 1, cubic, curvature_variation) == pytest.approx(6e-5**2 * 64 * 32, rel=1e-6)


@pytest.mark.parametrize("face", [sheet.nominal(), curved_face()], ids=["plane", "cylinder"])
def test_a_rigid_body_costs_nothing(face):
    """A shift of 1 mm and a turn of 0.01 rad; a cubic lattice of 12 follows a circle to 1e-4 of that."""
    field = lambda p: np.array([1.0, -0.5, 0.3]) + np.cross([0.01, 0.02, -0.01], p)
    assert abs(energy(face, (12, 6), 3, field)) < 1e-6


def test_growth_of_a_cylinder():
    """A radius larger by 1 mm bends every generator by 1/R²: energy 2πRL / R⁴."""
    field = lambda p: p * [1 / RADIUS, 1 / RADIUS, 0]
    assert energy(curved_face(), (16, 5), 3, field) == pytest.approx(2 * np.pi * LENGTH / RADIUS**3, rel=1e-3)


def test_banded_solution():
    lattice = displacement_lattice(curved_face().surface, (9, 6))
    layout = normal_matrix(lattice, 3)
    bending, gauge = bending_and_gauge(curved_face().surface, lattice, layout)
    right = np.random.default_rng(0).normal(size=layout.size)
    np.testing.assert_allclose(dense(bending + gauge) @ solve_banded(bending + gauge, right), right, atol=1e-6)
