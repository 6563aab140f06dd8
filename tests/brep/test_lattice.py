# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation on knots that are refined where the error asks for it."""
import FreeCAD
import numpy as np
import Part
import pytest
from scipy.interpolate import BSpline

from ffds_workbench.brep.face_parameters import closed_form
from ffds_workbench.brep.surface_fit import ParameterBox, approximate
from ffds_workbench.registration.splines import basis_rows


def test_a_kink_that_no_knot_marks_does_not_pile_up_knots():
    """|v − 0.4| has no fourth derivative to gain from: it ends at 1e-5 of the side, less a division by 6."""

    def roof(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.stack(np.broadcast_arrays(u[:, None], v, np.abs(v - 0.4123456789)), axis=-1)

    surface = approximate(roof, ParameterBox(0, 1, 0, 1), np.empty(0), np.empty(0), 1e-9)
    assert np.diff(np.unique(surface.knots_v)).min() > 1e-5 / 6.5


@pytest.mark.parametrize("kink, multiplicity", [(0.0, 2), (1e-4, 3)])
def test_seeds_that_nearly_coincide_allow_a_kink_only_where_there_is_one(kink, multiplicity):
    """A wave, with and without a kink of 1e-4 rad at the seeds, met to 1e-7 either way."""
    place = 0.166654145374

    def wave(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        height = 0.1 * np.sin(3 * u[:, None]) + kink * np.abs(u[:, None] - place)
        return np.stack(np.broadcast_arrays(u[:, None], v, height), axis=-1)

    surface = approximate(wave, ParameterBox(0, 1, 0, 1), place + np.array([0, 6.5e-7, 9.3e-7]), np.empty(0), 1e-7)
    knots, counts = np.unique(surface.knots_u, return_counts=True)
    assert counts[np.abs(knots - place) < 1e-6].tolist() == [multiplicity]
    at = np.linspace(0, 1, 4001)
    assert np.abs(surface.on_grid(at, np.zeros(1)) - wave(at, np.zeros(1))).max() < 1.5e-7


def test_a_closed_direction_ends_exactly_at_its_end():
    """Start and period chosen so that start + (end − start) misses the end by rounding."""
    box = ParameterBox(3.03867513291346e-14, 80.5907195137207, 0, 1, closed_u=True)

    def ring(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * (u[:, None] - box.u0) / (box.u1 - box.u0)
        return np.stack(np.broadcast_arrays(np.cos(angle), np.sin(angle), v), axis=-1)

    surface = approximate(ring, box, np.empty(0), np.empty(0), 1e-6)
    assert surface.range[1] == box.u1
    assert np.diff(np.unique(surface.knots_u)).min() > 1e-3


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_basis_rows_are_those_of_scipy(degree):
    random = np.random.default_rng(degree)
    inner = np.sort(np.repeat(random.uniform(0.1, 0.9, 4), [1, 1, 1, degree]))
    knots = np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])
    x = np.concatenate([[0.0, 1.0], inner, random.uniform(0, 1, 50)])
    first, values = basis_rows(knots, x, degree)
    dense = np.zeros((len(x), len(knots) - degree - 1))
    dense[np.arange(len(x))[:, None], first[:, None] + np.arange(degree + 1)] = values
    assert dense == pytest.approx(BSpline.design_matrix(x, knots, degree).toarray(), abs=1e-13)


def test_planes_and_cylinders_in_closed_form():
    placement = FreeCAD.Placement(FreeCAD.Vector(100, -50, 33), FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 40))
    for shape in (Part.makeBox(30, 20, 5), Part.makeCylinder(7, 40)):
        shape = shape.mirror(FreeCAD.Vector(), FreeCAD.Vector(1, 0.3, 0.2))
        shape.Placement = placement.multiply(shape.Placement)
        for face in shape.Faces:
            u, v = np.random.default_rng(0).uniform(-6, 6, (2, 50))
            expected = np.array([tuple(face.Surface.value(a, b)) for a, b in zip(u, v, strict=True)])
            assert closed_form(face.Surface)(u, v) == pytest.approx(expected, abs=1e-10)
