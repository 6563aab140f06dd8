# SPDX-License-Identifier: LGPL-2.1-or-later
"""A face is named that the scan does not show: the points are those of the other skin of the sheet."""
import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench import api

LENGTH, WIDTH, THICKNESS, NOISE = 80.0, 50.0, 3.0, 0.1


@pytest.fixture(scope="module")
def plate() -> Part.Shape:
    return Part.makeBox(LENGTH, WIDTH, THICKNESS)


def face_at(shape: Part.Shape, z: float) -> str:
    return next(f"Face{i + 1}" for i, face in enumerate(shape.Faces)
                if face.CenterOfMass.distanceToPoint(FreeCAD.Vector(LENGTH / 2, WIDTH / 2, z)) < 1e-9)


def scan_of_top(sag: float, points: int = 20_000) -> np.ndarray:
    """The top seen from above, lower in the middle by ``sag`` mm."""
    random = np.random.default_rng(1)
    x, y = random.uniform((0, 0), (LENGTH, WIDTH), (points, 2)).T
    z = THICKNESS - sag * np.sin(np.pi * x / LENGTH) + random.normal(0, NOISE, points)
    return np.stack([x, y, z], axis=1)


@pytest.mark.parametrize("method", ["robust", "ffds"])
def test_the_hidden_skin_is_not_pulled_through_the_sheet(plate, method):
    with pytest.raises(api.RefusedError, match=f"shows {face_at(plate, THICKNESS)}.*not {face_at(plate, 0.0)}"):
        api.register(plate, scan_of_top(0.5), faces=[face_at(plate, 0.0)], method=method)


@pytest.mark.parametrize("sag", [0.5, 2 * THICKNESS])
def test_the_skin_that_is_seen_may_bend_through_the_sheet(plate, sag):
    """20,000 points bring the noise well below a tenth of it; half of it leaves room for the lattice."""
    top = face_at(plate, THICKNESS)
    result = api.register(plate, scan_of_top(sag), faces=[top], method="robust")
    middle = FreeCAD.Vector(LENGTH / 2, WIDTH / 2, THICKNESS - sag)
    assert result.shape.Faces[int(top[4:]) - 1].distToShape(Part.Vertex(middle))[0] < NOISE / 2


def test_a_scan_that_may_show_either_skin_is_said_so(plate):
    """One skin alone, 1.3 mm inwards of the top and 1.7 mm of the bottom, if it were that: the nearer one is taken."""
    scan = scan_of_top(0.0) - [0.0, 0.0, 1.3]
    result = api.register(plate, scan)
    assert result.report["sheet"]["unsure"] == pytest.approx(THICKNESS, abs=NOISE)
    assert "is a guess" in result.table()
    assert next(face["band"] for face in result.report["faces"] if face["name"] == face_at(plate, THICKNESS)) > 0.5
