# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where lattices get finer, and that a displacement is the same on the finer ones."""
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings
from ffds_workbench.registration.joint.data import CellHeights, Scatter
from ffds_workbench.registration.joint.iteration import start
from ffds_workbench.registration.joint.lattice_refinement import faces_to_refine, transfer
from ffds_workbench.registration.joint.problem import make_problem

NOISE = 0.02


@pytest.fixture(scope="module")
def part():
    """A disc with a closed face, a seam and two flat ones."""
    return joint_part(read(Part.makeCylinder(20.0, 30.0)))


@pytest.fixture(scope="module")
def scan():
    random = np.random.default_rng(1)
    angle, z = random.uniform([-np.pi, 0], [np.pi, 30], (20_000, 2)).T
    reach = 20.0 + random.normal(0, NOISE, 20_000)
    return np.column_stack([reach * np.cos(angle), reach * np.sin(angle), z])


@pytest.fixture(scope="module")
def coarse(part, scan):
    return make_problem(part, scan, JointSettings(), {})


@pytest.mark.parametrize("faces", [{}, {0: 2}, {0: 2, 1: 2, 2: 2}])
def test_the_displacement_stays_the_same(part, scan, coarse, faces):
    """Halved spans hold every spline of the whole ones: any control points, equal everywhere but for rounding."""
    fine = make_problem(part, scan, coarse.settings, faces)
    state = replace(start(coarse), control_points=np.random.default_rng(2).normal(size=(coarse.lattices.count, 3)))
    moved = transfer(coarse, fine, state)
    for index, face in enumerate(part.faces):
        u0, u1, v0, v1 = face.surface.range
        u, v = np.linspace(u0, u1, 41), np.linspace(v0, v1, 37)
        before = coarse.lattices.spline(index, state.control_points).on_grid(u, v)
        after = fine.lattices.spline(index, moved.control_points).on_grid(u, v)
        assert np.abs(after - before).max() < 1e-9


def test_a_larger_sample_keeps_its_sides(coarse):
    """Every point of the scan takes the outward normal of the nearest sampled one: three in four are sampled, 0.5 mm
    apart, and hardly any is four times as far; on a radius of 20 mm that turns the normal by 0.1."""
    def radial(points):
        return points * [1, 1, 0] / np.linalg.norm(points[:, :2], axis=1, keepdims=True)

    fine = replace(coarse, sample=coarse.scan)
    moved = transfer(coarse, fine, replace(start(coarse), outward=radial(coarse.sample)))
    assert len(moved.outward) == len(coarse.scan) > len(coarse.sample)
    assert np.einsum("nx,nx->n", moved.outward, radial(coarse.scan)).min() > np.cos(0.1)


def judged(problem, model, sensor=NOISE):
    """Which faces ask, whose cells have full weight and whose patches share errors of ``model`` (faces,) mm."""
    faces = len(problem.part.faces)
    sigma = np.full(faces, sensor)
    scatter = Scatter(sigma, np.asarray(model, dtype=float), sigma)
    count = np.full(problem.distance.size, 8.0)
    values = CellHeights(np.zeros(count.size), count / sensor**2, count, scatter)
    return faces_to_refine(problem, replace(start(problem), values=values))


def test_only_the_face_that_errs_more_than_its_noise_is_refined(coarse):
    assert judged(coarse, [0.0, 0.0, 0.0]) == {}
    assert judged(coarse, [0.5 * NOISE, 0.0, 0.0]) == {0: 2}
    # A patch of n points errs by σ/√n: an error far below that of its mean is not worth a finer lattice.
    per_patch = 8.0 * coarse.distance.shape[1] / 4
    assert judged(coarse, [0.2 * NOISE / np.sqrt(per_patch), 0.0, 0.0]) == {}


def test_where_all_faces_ask_the_noise_is_smooth_and_not_the_shape_rough(coarse):
    assert judged(coarse, [0.5 * NOISE] * 3) == {}
    # Unless what points share exceeds what each of them has.
    assert judged(coarse, [2.0 * NOISE] * 3) == {0: 2, 1: 2, 2: 2}


def test_faces_that_nobody_saw_are_left_alone(coarse):
    state = start(coarse)
    assert faces_to_refine(coarse, state) == {}
