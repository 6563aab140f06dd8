# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that several tests of the registration share."""
import numpy as np
import pytest

from ffds_workbench.brep.surface_fit import ParameterBox, approximate
from ffds_workbench.registration.face_geometry import FaceGeometry

RADIUS = 20.0


@pytest.fixture(scope="session")
def ball() -> FaceGeometry:
    """A whole sphere, R = 20 mm, with both its poles."""

    def surface(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        x, y = RADIUS * np.cos(u)[:, None] * np.cos(v), RADIUS * np.sin(u)[:, None] * np.cos(v)
        return np.stack(np.broadcast_arrays(x, y, RADIUS * np.sin(v)[None]), axis=-1)

    turn, pole = 2 * np.pi, np.pi / 2
    spline = approximate(surface, ParameterBox(0, turn, -pole, pole, closed_u=True), turn * np.arange(1, 8) / 8,
                         np.linspace(-pole, pole, 9)[1:-1], 4e-6)
    trim = np.array([[0, -pole], [turn, -pole], [turn, pole], [0, pole]])
    return FaceGeometry("Ball", "Sphere", spline, (trim,), 1)
