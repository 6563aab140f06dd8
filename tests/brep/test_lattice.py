# SPDX-License-Identifier: LGPL-2.1-or-later
"""Interpolation on knots that are refined where the error asks for it."""
import numpy as np

from ffds_workbench.brep.lattice import ParameterBox, approximate


def test_a_kink_that_no_knot_marks_does_not_pile_up_knots():
    """|v − 0.4| has no fourth derivative to gain from: it ends at 1e-5 of the side, less a division by 6."""

    def roof(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.stack(np.broadcast_arrays(u[:, None], v, np.abs(v - 0.4123456789)), axis=-1)

    surface = approximate(roof, ParameterBox(0, 1, 0, 1), np.empty(0), np.empty(0), 1e-9)
    assert np.diff(np.unique(surface.knots_v)).min() > 1e-5 / 6.5


def test_a_closed_direction_ends_exactly_at_its_end():
    """Start and period chosen so that start + (end − start) misses the end by rounding."""
    box = ParameterBox(3.03867513291346e-14, 80.5907195137207, 0, 1, closed_u=True)

    def ring(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        angle = 2 * np.pi * (u[:, None] - box.u0) / (box.u1 - box.u0)
        return np.stack(np.broadcast_arrays(np.cos(angle), np.sin(angle), v), axis=-1)

    surface = approximate(ring, box, np.empty(0), np.empty(0), 1e-6)
    assert surface.range[1] == box.u1
    assert np.diff(np.unique(surface.knots_u)).min() > 1e-3
