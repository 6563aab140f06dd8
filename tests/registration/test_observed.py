# SPDX-License-Identifier: LGPL-2.1-or-later
"""Observed faces of a plate, scanned from above, and of real parts where they are."""
import numpy as np
import Part
import pytest

from ffds_workbench.brep import workpiece
from ffds_workbench.registration.face.observed_faces import observed_faces

LENGTH, WIDTH = 60.0, 40.0


@pytest.fixture(scope="module")
def plate():
    part = workpiece.read(Part.makeBox(LENGTH, WIDTH, 3.0))
    return [part.geometry(k) for k in range(6)]


def top(points: int = 20000, seed: int = 0) -> np.ndarray:
    random = np.random.default_rng(seed)
    return np.c_[random.uniform((0, 0), (LENGTH, WIDTH), (points, 2)), 3 + random.normal(0, 0.1, points)]


def test_one_skin(plate):
    found = observed_faces(plate, top())
    assert list(found) == [5]
    assert found[5] > 0.95


@pytest.mark.parametrize("sag", [-2.2, 2.0])
def test_a_skin_that_moved_by_more_than_half_the_thickness(plate, sag):
    """A tilt: one end in place, the other nearer to the other skin's nominal than to its own."""
    scan = top()
    scan[:, 2] += sag * scan[:, 0] / LENGTH
    assert list(observed_faces(plate, scan)) == [5]


def test_both_skins(plate):
    scan = np.concatenate([top(), top(seed=1) - [0, 0, 3]])
    assert set(observed_faces(plate, scan)) == {4, 5}


def test_half_a_skin_is_judged_by_the_coverage_asked_for(plate):
    scan = top()
    scan = scan[scan[:, 0] < 0.4 * LENGTH]
    assert observed_faces(plate, scan) == {}
    assert list(observed_faces(plate, scan, least=0.3)) == [5]


def test_far_away(plate):
    assert observed_faces(plate, top() + 1e4) == {}


def test_visible_faces_of_a_bracket(shared_data):
    """Every face that the case calls visible and that is no sliver is found, and no hidden one."""
    import json

    from ffds_workbench.brep.model_files import model_file
    from ffds_workbench.scan import files as scan_files

    folder = shared_data / "cases" / "b-springback"
    part = workpiece.read(model_file.read(folder / "nominal.step").shape)
    case = json.loads((folder / "case.json").read_text())
    faces = [part.geometry(k) for k in range(len(part.faces))]
    found = observed_faces(faces, scan_files.read(folder / "scan.ply").points)
    assert {f"Face{k + 1}" for k in found} == set(case["visible_faces"])
