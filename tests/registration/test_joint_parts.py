# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pieces of the joint solve, each against an independent computation."""
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_matrix

FreeCAD = pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings, solve
from ffds_workbench.registration.joint.data.borders import find_borders, find_near_edges
from ffds_workbench.registration.joint.data.scan_statistics import scan_statistics
from ffds_workbench.registration.joint.linear.cholesky import FrontCholesky, FrontLayout
from ffds_workbench.registration.joint.linear.elimination_order import dissect
from ffds_workbench.registration.joint.linear.system import Pattern
from ffds_workbench.registration.joint.priors.stiffness import make_stiffness
from ffds_workbench.registration.joint.problem import make_problem
from ffds_workbench.registration.joint.settings import Stage
from ffds_workbench.registration.joint.surfaces.cells import normals
from ffds_workbench.registration.joint.surfaces import solid_sizes, span_counts
from ffds_workbench.registration.joint.surfaces.lattices import build_lattices
from ffds_workbench.registration.joint.surfaces.seam_closing import close_seams
from ffds_workbench.registration.splines import cubic

SPANS, TURNING = 5.0, np.deg2rad(25)


@pytest.fixture(scope="module")
def cylinder():
    return joint_part(read(Part.makeCylinder(12.0, 30.0)))


@pytest.fixture(scope="module")
def lattices(cylinder):
    return lattices_of(cylinder)


def lattices_of(part):
    sizes = solid_sizes(part.faces, part.solids)
    return build_lattices(part.faces, span_counts(part.faces, sizes, SPANS, TURNING, 1e-3))


def fitted(lattices, faces, field):
    """Control points of all faces that follow a field in space, least squares at dense places."""
    points = np.zeros((lattices.count, 3))
    for index, face in enumerate(faces):
        u0, u1, v0, v1 = face.surface.range
        uv = np.stack(np.meshgrid(np.linspace(u0, u1, 80), np.linspace(v0, v1, 40), indexing="ij"), -1).reshape(-1, 2)
        spans, local = lattices.faces[index].locate(uv)
        weights = lattices.weights(spans, local, 0, 0)
        matrix = csr_matrix((weights.ravel(), lattices.controls[spans].ravel(), np.arange(len(uv) + 1) * 16),
                            (len(uv), lattices.count))
        own = np.flatnonzero(lattices.face_of_control == index)
        points[own] = np.linalg.lstsq(matrix[:, own].toarray(), field(face.surface(uv)), rcond=None)[0]
    return points


def test_basis_is_a_partition_of_unity():
    x = np.linspace(0, 1, 11)
    assert cubic(x).sum(axis=1) == pytest.approx(1)
    step = 1e-6
    assert (cubic(x + step) - cubic(x - step)) / (2 * step) == pytest.approx(cubic(x, 1), abs=1e-8)


def test_spline_of_a_face_equals_its_rows(cylinder, lattices):
    points = np.random.default_rng(0).normal(size=(lattices.count, 3))
    for index, face in enumerate(cylinder.faces):
        u0, u1, v0, v1 = face.surface.range
        uv = np.random.default_rng(1).uniform([u0, v0], [u1, v1], (50, 2))
        spans, local = lattices.faces[index].locate(uv)
        weights = lattices.weights(spans, local, 0, 0)
        expected = np.einsum("nc,ncx->nx", weights, points[lattices.controls[spans]])
        assert lattices.spline(index, points)(uv) == pytest.approx(expected, abs=1e-12)


def test_a_narrow_ring_has_stiffness():
    """The end of a square tube, 60 mm wide with a wall of 2 mm, of which no Gauss place is: 464 mm², by samples of 8 to
    a box, in which the wall is between 0.7 and 1.3 samples wide: they are right to a third."""
    tube = Part.makeBox(60, 60, 20).cut(Part.makeBox(56, 56, 20, FreeCAD.Vector(2, 2, 0)))
    part = joint_part(read(tube))
    lattices = build_lattices(part.faces, [(1, 1)] * len(part.faces))
    stiffness = make_stiffness(part.faces, lattices, np.ones(len(lattices.controls)))
    rings = [k for k, face in enumerate(tube.Faces) if abs(face.Area - 464) < 1e-6]
    assert len(rings) == 2 and not stiffness.places.inside[rings].any()
    assert stiffness.area[rings].sum(axis=1) == pytest.approx(464, rel=1 / 3)
    others = np.delete(np.arange(len(tube.Faces)), rings)
    assert stiffness.area[others].sum(axis=1) == pytest.approx([tube.Faces[k].Area for k in others], rel=1e-9)


def test_rigid_rotation_costs_neither_bending_nor_strain(cylinder, lattices):
    angle = 0.1
    rotation = np.array([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]])
    points = fitted(lattices, cylinder.faces, lambda x: x @ rotation.T - x)
    stiffness = make_stiffness(cylinder.faces, lattices, np.ones(len(lattices.controls)))
    jet = stiffness.places.displaced(lattices, points, 3)
    normal = normals(jet, stiffness.places.outward)[0]
    inside = stiffness.places.inside
    hessian = np.matmul(stiffness.hessian, points[lattices.controls][:, None])
    bending = hessian - stiffness.curvature[..., None] * (normal - stiffness.normal)[:, :, None, :]
    strain = stiffness.strain(lattices, points, normal, np.full(len(inside), 3.0))
    # A cubic with spans of 25° follows a circle's field to about 1e-3 of its size; its second derivative to 1 %.
    assert np.abs(bending[inside]).max() < 0.02 * angle / 12
    assert np.abs(strain[inside]).max() < 2e-3 * angle


def test_strain_derivative(cylinder, lattices):
    stiffness = make_stiffness(cylinder.faces, lattices, np.ones(len(lattices.controls)))
    random = np.random.default_rng(3)
    points, change = 0.1 * random.normal(size=(2, lattices.count, 3))
    thickness = np.zeros(len(lattices.controls))
    normal = normals(stiffness.places.displaced(lattices, points, 3), stiffness.places.outward)[0]
    rows = stiffness.strain_rows(lattices, points, normal, thickness)
    step = 1e-6
    ends = [stiffness.strain(lattices, points + s * change, normal, thickness) for s in (step, -step)]
    expected = (ends[0] - ends[1]) / (2 * step)
    assert np.einsum("skpxc,scx->skp", rows, change[lattices.controls]) == pytest.approx(expected, abs=1e-6)


def test_strain_load_is_that_of_the_rows(cylinder, lattices):
    stiffness = make_stiffness(cylinder.faces, lattices, np.ones(len(lattices.controls)))
    random = np.random.default_rng(4)
    points = 0.1 * random.normal(size=(lattices.count, 3))
    thickness = np.full(len(lattices.controls), 3.0)
    normal = normals(stiffness.places.displaced(lattices, points, 3), stiffness.places.outward)[0]
    stress = random.normal(size=normal.shape)
    rows = stiffness.strain_rows(lattices, points, normal, thickness)
    load = stiffness.strain_load(lattices, points, normal, thickness, stress)
    assert load == pytest.approx(np.einsum("skpxc,skp->scx", rows, stress), abs=1e-9)


def test_fronts_solve_and_invert_like_a_dense_matrix():
    side = 14
    place = np.stack(np.meshgrid(np.arange(side), np.arange(side), [0.0], indexing="ij"), -1).reshape(-1, 3)
    near = np.abs(place[:, None] - place[None]).max(axis=2) <= 2
    graph = csr_matrix(near.astype(np.int32))
    random = np.random.default_rng(5)
    rows, columns = np.nonzero(np.triu(near))
    dense = np.zeros((len(place), 3, len(place), 3))
    dense[rows, :, columns, :] = random.normal(size=(len(rows), 3, 3))
    dense = dense.reshape(3 * len(place), -1)
    dense = dense + dense.T + 80 * np.eye(len(dense))
    blocks = dense.reshape(len(place), 3, len(place), 3)[rows, :, columns, :].transpose(1, 2, 0)
    fronts = dissect(graph, place)
    assert sorted(np.concatenate([front.own for front in fronts])) == list(range(len(place)))
    assert len(fronts) > 2
    factor = FrontCholesky(FrontLayout(fronts, rows, columns), blocks)
    right = random.normal(size=len(dense))
    assert factor.solve(right) == pytest.approx(np.linalg.solve(dense, right), abs=1e-10)
    several = random.normal(size=(len(dense), 3))
    assert factor.solve_many(several) == pytest.approx(np.linalg.solve(dense, several), abs=1e-10)
    inverse = np.linalg.inv(dense).reshape(len(place), 3, len(place), 3)[rows, :, columns, :]
    assert factor.inverse_blocks() == pytest.approx(inverse.transpose(1, 2, 0), abs=1e-10)


def test_half_a_pattern_holds_the_whole_matrix(lattices):
    """Of a cylinder, which closes on itself: there the first of two control points of a span may have the larger
    number."""
    random = np.random.default_rng(6)
    spans, size = len(lattices.controls), 3 * lattices.count
    pattern = Pattern(lattices, [], random.normal(size=(lattices.count, 3)))
    each = random.normal(size=(spans, 48, 48))
    each += each.swapaxes(1, 2)
    rows = (3 * lattices.controls[:, None] + np.arange(3)[:, None]).reshape(spans, 48)
    dense = np.zeros((size, size))
    np.add.at(dense, (rows[:, :, None], rows[:, None]), each)
    blocks = pattern.from_span_blocks(lambda some: each[some].reshape(-1, 3, 16, 3, 16))
    for vectors in (random.normal(size=size), random.normal(size=(size, 4))):
        assert pattern.product(blocks)(vectors) == pytest.approx(dense @ vectors, abs=1e-10)
    assert pattern.of_spans(blocks, np.arange(spans)).transpose(0, 3, 1, 4, 2).reshape(each.shape) == pytest.approx(
        dense[rows[:, :, None], rows[:, None]])
    scalar = csr_matrix(dense[::3, ::3])
    assert pattern.from_scalar(scalar) == pytest.approx(blocks[0, 0])
    some = pattern.from_vector(csr_matrix(dense).tobsr((3, 3)))
    again = np.zeros_like(blocks)
    some.add_to(again, 1.0)
    assert again == pytest.approx(blocks)


def test_poles_move_as_one_point():
    part = joint_part(read(Part.makeCone(0.0, 10.0, 20.0)))
    lattices = lattices_of(part)
    points = close_seams(part, lattices, np.random.default_rng(0).normal(size=(lattices.count, 3)))
    apex = next(edge for edge in part.edges if edge.degenerate)
    moved = lattices.spline(apex.faces[0], points)(apex.uv[0])
    assert np.ptp(moved, axis=0) == pytest.approx(0, abs=1e-12)


def test_statistics_of_a_plane():
    random = np.random.default_rng(7)
    points = np.column_stack([random.uniform(0, [80, 50], (40000, 2)), random.normal(0, 0.1, 40000)])
    found = scan_statistics(points)
    # Sixteen neighbours: the density's median is biased by some per cent, the plane's fit by the third dimension.
    assert found.density == pytest.approx(10, rel=0.3)
    assert found.noise == pytest.approx(0.1, rel=0.3)


def plate_problem(random):
    """A plate of 50 × 40 × 2 mm whose upper face was seen by 10 points per mm² at random, without noise."""
    part = joint_part(read(Part.makeBox(50.0, 40.0, 2.0)))
    scan = np.column_stack([random.uniform(0, [50, 40], (20000, 2)), np.full(20000, 2.0)])
    return make_problem(part, scan, JointSettings(), {})


STEPS = (1.0, 0.5, 0.49, 0.4, 0.3, 0.25, 0.2, 0.15)


@pytest.mark.parametrize("all_points, taken", [(False, 3), (True, 8)])
def test_the_first_soft_stage_ends_when_its_steps_no_longer_shrink(all_points, taken, monkeypatch):
    """With the trust settled, the third step is hardly smaller than the second: more of them would only wander."""
    problem = plate_problem(np.random.default_rng(12))
    monkeypatch.setattr(solve, "update_prior_trust", lambda problem, state, stage: state)
    monkeypatch.setattr(solve, "gauss_newton_step", lambda problem, stage, state: replace(
        state, last_step=STEPS[state.iterations], iterations=state.iterations + 1))
    stage = Stage(1.0, 1.0, 8, 0.04, soft=True, all_points=all_points)
    assert solve.run_stage(problem, stage, solve.start(problem)).iterations == taken


def test_points_at_random_put_edges_where_they_are():
    problem = plate_problem(np.random.default_rng(11))
    still = np.zeros((problem.lattices.count, 3))
    near = find_near_edges(problem.scan, problem.couplings.edges, problem.sides, still, problem.lengths, None)
    noise = problem.lengths.noise
    held = np.where(problem.cells.nominal.position[:, :, 2].ravel() > 1.999, 10.0, 0.0)
    found = find_borders(near, problem.couplings.edges, problem.sides, still, problem.lengths,
                         np.full(len(problem.part.faces), noise), held, None)
    # The outermost of 10 points per mm² in strips of 40/32 mm or more: exponential, its deviation 0.08 mm or less.
    assert len(found.along) > 100
    assert abs(found.along.mean()) < 3 * 0.08 / np.sqrt(len(found.along))


def test_thickness_is_measured_along_the_current_normal():
    """Raised by a parabola without turning, a plate of thickness t is t cos θ thick where its slope is θ."""
    problem = plate_problem(np.random.default_rng(12))
    couplings, sharpness = problem.couplings, 0.004
    points = fitted(problem.lattices, problem.part.faces,
                    lambda at: np.column_stack([np.zeros((len(at), 2)), sharpness * (at[:, 1] - 20) ** 2]))
    normal = couplings.sheet_normals(points)
    cosine = 1 / np.hypot(1, 2 * sharpness * (couplings.pairs.front.nominal[0][:, 1] - 20))
    # A parabola is a cubic spline: equal up to rounding.
    assert np.abs(normal[:, 2]) == pytest.approx(cosine, abs=1e-9)
    assert couplings.thickness_misfit(points, normal)[0] == pytest.approx(2 * (1 - cosine), abs=1e-9)


def test_a_sheet_that_moved_by_its_thickness_keeps_its_sides():
    """Rigid shift by the thickness, both skins and a wall seen: the far skin then lies where the near one was."""
    from ffds_workbench.registration.joint import register_joint

    thickness, noise = 2.0, 0.05
    part = joint_part(read(Part.makeBox(50.0, 40.0, thickness)))
    random = np.random.default_rng(3)
    count = 12000
    x, y = random.uniform(0, 50, count), random.uniform(0, 40, count)
    skins = [np.column_stack([x, y, np.full(count, z)]) for z in (0.0, thickness)]
    wall = np.column_stack([np.zeros(800), random.uniform(0, 40, 800), random.uniform(0, thickness, 800)])
    scan = np.concatenate([*skins, wall]) + random.normal(0, noise, (2 * count + 800, 3)) + [0, 0, 0.9 * thickness]
    result = register_joint(part, scan)
    for face, geometry in zip(result.faces, part.faces, strict=True):
        if np.ptp(geometry.surface.control_points[..., 2]) < 1e-9:
            # σ √(dof/n): some 60 degrees of freedom and 12 000 points leave 0.0035 mm rms; three times that
            assert np.abs(face.displacement(face.uv)[:, 2] - 0.9 * thickness).mean() < 0.0105
