# SPDX-License-Identifier: LGPL-2.1-or-later
"""The families' parts are sound, and their deformations do what their names say, by closed forms."""
from __future__ import annotations

import json

import FreeCAD
import numpy as np
import Part
import pytest
from scipy.spatial import cKDTree

from ffds_workbench.benchmark.simulated import warps
from ffds_workbench.benchmark.simulated.families import WARPS, deformation, make_case
from ffds_workbench.benchmark.simulated.parts import FAMILIES
from ffds_workbench.benchmark.simulated.profile import Piece, Profile
from ffds_workbench.brep.simulated_scan import edge_points
from ffds_workbench.scan import files

HAT = Profile((Piece(15), Piece(8, 1.4), Piece(20), Piece(8, -1.4), Piece(30), Piece(8, -1.4), Piece(20), Piece(8, 1.4),
               Piece(15)), 2.0)


@pytest.mark.parametrize("family", sorted(FAMILIES))
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_parts_are_valid(family, seed):
    shape = FAMILIES[family](np.random.default_rng(seed)).shape
    assert shape.isValid() and all(solid.isClosed() and solid.Volume > 0 for solid in shape.Solids)
    for solid in shape.Solids:      # a pipe that stands on a plate touches it: each solid by itself
        solid.check(True)


def test_profile_coordinates_invert_its_points():
    rng = np.random.default_rng(0)
    index = rng.integers(0, 9, 2000)
    s = rng.random(2000) * np.array([piece.length for piece in HAT.pieces])[index]
    n = rng.uniform(-1, 1, 2000)
    points = HAT.point(s, n, index)
    back = HAT.point(*HAT.coordinates(points))
    assert np.abs(back - points).max() < 1e-12


def test_springback_keeps_lengths_and_holds_the_web():
    warp = warps.springback(HAT, 0.97, 4)
    before = np.concatenate([np.linspace(0, 1, 400)[:, None] * piece.length for piece in HAT.pieces]).ravel()
    index = np.repeat(np.arange(9), 400)
    xz = HAT.point(before, np.zeros(len(before)), index)
    points = np.column_stack([xz[:, 0], np.zeros(len(xz)), xz[:, 1]])
    moved = warp(points)
    length = [np.linalg.norm(np.diff(p, axis=0), axis=1).sum() for p in (points, moved)]
    assert abs(length[1] - length[0]) < 1e-3          # chords of 400 pieces per arc: 8 mm·(1.4/400)²/24
    assert np.abs(moved[index == 4] - points[index == 4]).max() < 1e-12
    assert np.linalg.norm(moved - points, axis=1).max() > 1


def test_rolling_is_an_isometry():
    warp = warps.roll(120.0, 0.4, np.zeros(3))
    rng = np.random.default_rng(1)
    p = np.column_stack([rng.uniform(-40, 40, (500, 2)), np.zeros(500)])
    h = 1e-5
    du, dv = ((warp(p + h * e) - warp(p - h * e)) / (2 * h) for e in np.eye(3)[:2])
    assert np.abs((du**2).sum(1) - 1).max() < 1e-8 and np.abs((du * dv).sum(1)).max() < 1e-8
    assert np.abs((dv**2).sum(1) - 1).max() < 1e-8


@pytest.mark.parametrize("warp", [name for name in WARPS if name not in ("iso", "springback")])
def test_scaled_deformations_reach_their_amplitude(warp):
    part = FAMILIES["free-form-panel"](np.random.default_rng(1))
    points = edge_points(part.shape).reshape(-1, 3)
    move = deformation(part, warp, 1.5, np.random.default_rng(2))
    assert abs(np.linalg.norm(move(points) - points, axis=1).max() - 1.5) < 1e-9


def test_a_case_is_a_folder_that_tells_the_truth(tmp_path):
    case = make_case("free-form-panel", "twist", 3)
    case.write(tmp_path)
    again = make_case("free-form-panel", "twist", 3)
    assert np.array_equal(case.scan.points, again.scan.points)
    truth = dict(np.load(tmp_path / "truth.npz"))
    shape = Part.read(str(tmp_path / "nominal.step"))
    assert truth["edges"].shape == (len(shape.Edges), 200, 3) and truth["face"].max() + 1 == len(shape.Faces)
    assert np.abs(edge_points(shape) - truth["edges_nominal"]).max() < 1e-6
    assert json.loads((tmp_path / "case.json").read_text())["points"] == len(case.scan.points)
    nominal = Part.Vertex(FreeCAD.Vector(*truth["nominal"][7]))
    assert nominal.distToShape(shape.Faces[truth["face"][7]])[0] < 1e-5
    # the scan stands about the warped part: the noise of 0.13 mm along the view, and the truth's own spacing of 1.2 mm
    near = cKDTree(truth["warped"][truth["visible"]]).query(case.scan.points[::50])[0]
    assert np.median(near) < 1.0 and near.max() < 6.0


def test_normals_as_a_sensor_writes_them(tmp_path):
    """The same points as without; normals face the camera and are some degrees off the warped surface's."""
    plain, case = (make_case("free-form-panel", "bend", 15, kind) for kind in ("one-view", "one-view with normals"))
    np.testing.assert_array_equal(plain.scan.points, case.scan.points)
    case.write(tmp_path)
    normals = files.read(tmp_path / "scan.ply").normals
    assert plain.normals is None
    np.testing.assert_allclose(normals, case.normals, atol=1e-12)
    assert (normals @ case.part.views[0] > 0).mean() > 0.98
    truth, seen = case.truth, case.truth.visible
    surface = cKDTree(truth.warped[seen])
    place, index = truth.warped[seen], surface.query(case.scan.points, k=1)[1]
    around = place[surface.query(place, k=30)[1]]
    smooth = np.linalg.svd(around - around.mean(axis=1, keepdims=True), full_matrices=False)[2][:, 2]
    off = np.degrees(np.arccos(np.clip(np.abs(np.einsum("nx,nx->n", normals, smooth[index])), 0, 1)))
    assert 2 < np.median(off) < 20
