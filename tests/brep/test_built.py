# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces of a rebuilt shape from their control points; OCCT's own evaluation is the truth."""
from __future__ import annotations

import numpy as np
import Part
import pytest

from ffds_workbench.brep import workpiece
from ffds_workbench.brep.face_displacement import FaceDisplacement
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.brep.rebuilt_faces import built_geometry

SHAPES = {"box": Part.makeBox(10, 20, 30), "cylinder": Part.makeCylinder(10, 20), "torus": Part.makeTorus(10, 3),
          "sphere": Part.makeSphere(5)}


@pytest.mark.parametrize("name", SHAPES)
def test_the_surface_is_occts(name):
    part = workpiece.read(SHAPES[name])
    wave = FaceDisplacement(lambda uv, points: 0.1 * np.sin(points / 5 + 0.3))
    built = rebuild(part, dict.fromkeys(range(len(part.faces)), wave), 1e-4)
    for index, face in enumerate(built.Faces):
        surface = built_geometry(part, index, face).surface
        u0, u1, v0, v1 = surface.range
        uv = np.random.default_rng(0).uniform((u0, v0), (u1, v1), (200, 2))
        theirs = [tuple(face.Surface.value(u, v)) for u, v in uv.tolist()]
        np.testing.assert_allclose(surface(uv), theirs, atol=1e-12)


def test_a_face_that_stays_is_the_nominal_one():
    part = workpiece.read(SHAPES["box"])
    assert built_geometry(part, 0, part.shape.Faces[0]) is part.geometry(0)
