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


@pytest.fixture(scope="session")
def fit_control_points():
    """A function that gives the control points of all faces, (controls, 3) in mm, whose displacement follows a field in
    space, by least squares at dense places."""

    def fit(problem, field) -> np.ndarray:
        lattices, points = problem.lattices, np.zeros((problem.lattices.count, 3))
        for index, face in enumerate(problem.part.faces):
            u0, u1, v0, v1 = face.surface.range
            uv = np.stack(np.meshgrid(np.linspace(u0, u1, 60), np.linspace(v0, v1, 60), indexing="ij"), -1)
            uv = uv.reshape(-1, 2)
            spans, local = lattices.faces[index].locate(uv)
            rows = np.zeros((len(uv), lattices.count))
            np.put_along_axis(rows, lattices.controls[spans], lattices.weights(spans, local, 0, 0), axis=1)
            own = np.flatnonzero(lattices.face_of_control == index)
            points[own] = np.linalg.lstsq(rows[:, own], field(face.surface(uv)), rcond=None)[0]
        return points

    return fit
