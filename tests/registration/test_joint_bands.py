# SPDX-License-Identifier: LGPL-2.1-or-later
"""The covariance against dense matrices, and bands against quantiles that are known or drawn at random."""
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2, norm

pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings
from ffds_workbench.registration.joint.iteration import add_observations, gauss_newton_step, prior_equations, start
from ffds_workbench.registration.joint.outcome import summarise
from ffds_workbench.registration.joint.problem import make_problem
from ffds_workbench.registration.joint.surfaces import normals
from ffds_workbench.registration.joint.uncertainty import bands, covariance

SIGMA = 0.03


@pytest.fixture(scope="module")
def problem():
    """A small plate seen on both skins."""
    random = np.random.default_rng(1)
    place = random.uniform(0, [30, 20], (4000, 2))
    scan = np.column_stack([place, np.repeat([0.0, 2.0], 2000) + random.normal(0, 0.05, 4000)])
    return make_problem(joint_part(read(Part.makeBox(30.0, 20.0, 2.0))), scan, replace(JointSettings(), spans=5.0), {})


@pytest.fixture(scope="module")
def stepped(problem):
    """A state after one step of the last stage without the body."""
    stage = next(stage for stage in problem.settings.schedule if stage.soft and stage.all_points)
    return gauss_newton_step(problem, replace(stage, gate=1.0, enough=0.02), start(problem))


@pytest.fixture(scope="module")
def dense(problem, stepped):
    """The normal matrix and that of the priors, (3 controls, 3 controls)."""
    equations = prior_equations(problem, stepped, 1.0)
    prior = _dense(problem, equations.blocks)
    jet = problem.cells.displaced(problem.lattices, stepped.control_points)
    add_observations(equations, problem, stepped, jet)
    return _dense(problem, equations.blocks), prior


def _dense(problem, blocks):
    """The whole symmetric matrix, (3 controls, 3 controls), placed block by block: the truth is none of the solve's."""
    rows, columns, count = problem.pattern.rows, problem.pattern.indices, problem.lattices.count
    result = np.zeros((count, 3, count, 3))
    result[columns, :, rows, :] = blocks.transpose(2, 1, 0)
    result[rows, :, columns, :] = blocks.transpose(2, 0, 1)
    return result.reshape(3 * count, 3 * count)


def test_the_product_is_that_of_the_whole_matrix(problem, dense):
    vectors = np.random.default_rng(2).normal(size=(3 * problem.lattices.count, 4))
    wanted = dense[0] @ vectors
    found = problem.pattern.product(_blocks_of(problem, dense[0]))(vectors)
    # Sums of some 150 products, each right to 1e-16 of the largest.
    assert np.abs(found - wanted).max() < 1e-12 * np.abs(wanted).max()


def _blocks_of(problem, matrix):
    """Of a matrix, (3 controls, 3 controls), what the pattern holds: (3, 3, size)."""
    count = problem.lattices.count
    by_node = matrix.reshape(count, 3, count, 3).transpose(1, 3, 0, 2)
    return np.ascontiguousarray(by_node[:, :, problem.pattern.rows, problem.pattern.indices])


def test_the_covariance_is_the_inverse_of_the_normal_matrix(problem, stepped, dense, monkeypatch):
    monkeypatch.setattr(covariance, "_PRIORS_WIDE_ENOUGH", np.inf)
    blocks, errors = covariance.covariance_blocks(problem, stepped)
    wanted = _blocks_of(problem, np.linalg.inv(dense[0]))
    # The condition number is some 1e9 (weights from 1e-2 to 1e7): half of the digits are left.
    assert np.abs(blocks - wanted).max() < 1e-6 * np.abs(wanted).max()
    assert errors.shape == (0, problem.lattices.count, 3)  # of white noise


def test_the_scan_determines_as_many_shapes_as_the_trace_says(problem, dense):
    normal, prior = dense
    factor = covariance.FrontCholesky(problem.pattern.layout, _blocks_of(problem, normal))
    blocks = _blocks_of(problem, prior)
    trace = len(normal) - np.trace(np.linalg.solve(normal, prior))
    # Hutchinson's variance of 16 probes is 2 Σ_{i≠j} m_ij² / 16, of a matrix whose squares add up to less than its
    # trace.
    assert abs(covariance._effective_dof(problem, factor, blocks) - trace) < 3 * np.sqrt(2 * trace / 16)


def test_priors_that_cost_too_much_are_widened(problem, stepped, dense, monkeypatch):
    """Four times the effective number of shapes: the priors' variances are taken four times as large."""
    normal, prior = dense
    monkeypatch.setattr(covariance, "prior_cost", lambda *_: 400.0)
    monkeypatch.setattr(covariance, "_effective_dof", lambda *_: 100.0)
    blocks, _ = covariance.covariance_blocks(problem, stepped)
    wanted = _blocks_of(problem, np.linalg.inv(normal - 0.75 * prior))
    assert np.abs(blocks - wanted).max() < 1e-6 * np.abs(wanted).max()


def test_priors_may_be_widened_by_any_factor(problem, stepped, monkeypatch):
    """One row that outweighs all others by twelve orders of magnitude, as of a badly parametrised face, and costs
    millions: of a sum with it nothing else can be got back, whatever it is divided by afterwards."""
    equations, row = covariance.prior_equations, np.zeros(problem.lattices.count)
    row[problem.lattices.controls[0]] = np.random.default_rng(2).normal(size=16)

    def outweighing(*arguments):
        found = equations(*arguments)
        found.blocks[0, 0] += 1e16 * row[problem.pattern.rows] * row[problem.pattern.indices]
        return found

    monkeypatch.setattr(covariance, "prior_equations", outweighing)
    monkeypatch.setattr(covariance, "prior_cost", lambda *_: 1e9)
    monkeypatch.setattr(covariance, "_effective_dof", lambda *_: 1e3)
    blocks, _ = covariance.covariance_blocks(problem, stepped)
    assert (blocks[[0, 1, 2], [0, 1, 2]][:, problem.pattern.rows == problem.pattern.indices] > 0).all()


def independent(problem, sigma):
    """Blocks of the covariance of control points that err by themselves, by ``sigma`` (3,) in x, y and z."""
    same = problem.pattern.rows == problem.pattern.indices
    return np.diag(np.square(sigma))[:, :, None] * same


def bands_of(problem, blocks, **given):
    """Bands at the Gauss places of all spans, by default far from borders, observed and without misfit."""
    places = problem.stiffness.places
    shape, none = places.inside.shape, np.zeros((0, problem.lattices.count, 3))
    given = {"errors": none, "gap": np.zeros(shape), "border": np.full(shape, 1e9),
             "misfit": np.zeros(shape[0])} | given
    normal = normals(places.nominal, places.outward)[0]
    return bands.normal_bands(problem, blocks, given["errors"], places.tables[0], normal, given["gap"],
                              given["border"], given["misfit"])


def test_a_band_of_control_points_that_err_by_themselves(problem):
    """Var = σ² Σ N², and 95 % of a normal distribution lie within 1.96 σ."""
    found = bands_of(problem, independent(problem, [SIGMA] * 3))
    basis = np.sqrt((problem.stiffness.places.tables[0] ** 2).sum(axis=1))
    assert found == pytest.approx(np.broadcast_to(norm.ppf(0.975) * SIGMA * basis, found.shape), rel=1e-4)


def test_what_moves_along_a_surface_is_in_no_band(problem):
    found = bands_of(problem, independent(problem, [SIGMA, SIGMA, 0.0]))
    skins = problem.skin
    assert found[skins].max() < 1e-9 and found[~skins].min() > 0.5 * SIGMA


def test_misfit_and_shared_noise_add_their_variances(problem):
    one = bands_of(problem, independent(problem, [0.0] * 3), misfit=np.full(len(problem.lattices.step), SIGMA**2))
    assert one == pytest.approx(np.full(one.shape, norm.ppf(0.975) * SIGMA), rel=1e-4)
    # Fields that move all control points by ±δ: a partition of unity moves by δ as well.
    fields = np.stack([np.full((problem.lattices.count, 3), sign * SIGMA) for sign in (1.0, -1.0)])
    shared = bands_of(problem, independent(problem, [0.0] * 3), errors=fields)
    assert shared == pytest.approx(np.full(one.shape, norm.ppf(0.975) * SIGMA), rel=1e-4)


def test_bands_are_wider_where_nothing_was_seen_and_beside_neighbours(problem):
    blocks, shape = independent(problem, [SIGMA] * 3), problem.stiffness.places.inside.shape
    seen = bands_of(problem, blocks)
    unseen = bands_of(problem, blocks, gap=np.full(shape, 1e9))
    # Student's t with two degrees of freedom: 4.303.
    assert unseen / seen == pytest.approx(np.full(shape, 4.303 / 1.960), rel=1e-3)
    assert (bands_of(problem, blocks, border=np.zeros(shape)) > seen).all()
    assert np.isinf(bands_of(problem, blocks, gap=np.full(shape, np.inf))).sum() == 0  # a face that no point shows


@pytest.mark.parametrize("ratio", [0.0, 0.3, 1.0])
def test_the_band_of_an_edge_holds_95_of_100_curves(problem, ratio):
    """Errors across an edge are two-dimensional, with one standard deviation ``ratio`` times the other."""
    edges = problem.couplings.edges
    samples = edges.first
    along_x = np.flatnonzero(np.abs(edges.direction[:, 0]) > 0.99)
    samples, direction = samples.take(along_x), edges.direction[along_x]
    large = 10.0  # so that what else edges are off by is nothing beside it
    blocks = independent(problem, [0.0, large, ratio * large])
    found = bands.edge_bands(problem, blocks, np.zeros((0, problem.lattices.count, 3)), samples, direction,
                             np.zeros(len(samples)), np.zeros(len(samples)))
    basis = np.sqrt((samples.weights[0] ** 2).sum(axis=1))
    drawn = np.random.default_rng(5).normal(size=(2, 400_000))
    inside = np.hypot(drawn[0], ratio * drawn[1]) < (found / (large * basis))[0]
    # Satterthwaite's approximation is exact at both ends and off by half a per cent between them; 3 · 0.034 %.
    assert 100 * inside.mean() == pytest.approx(95.0, abs=0.7)
    if ratio == 1.0:
        assert found == pytest.approx(np.sqrt(chi2.ppf(0.95, 2)) * large * basis, rel=1e-3)


def test_a_face_that_is_carried_makes_no_edge_observed():
    """A block of which the scan shows the bottom and half of the front: the far end of the front is 15 mm from any
    point, whether or not the top, which holds no points, is said to be carried by its neighbours."""
    random = np.random.default_rng(3)
    bottom, front = random.uniform(0, [30, 20], (3000, 2)), random.uniform(0, [15, 8], (600, 2))
    scan = np.vstack([np.insert(bottom, 2, 0.0, axis=1), np.insert(front, 1, 0.0, axis=1)])
    scan += random.normal(0, 0.03, scan.shape)
    shape = Part.makeBox(30.0, 20.0, 8.0)
    seen = make_problem(joint_part(read(shape)), scan, replace(JointSettings(), spans=5.0), {})
    far = [index for index, edge in enumerate(shape.Edges)
           if edge.BoundBox.XMin > 29 and edge.BoundBox.YMax < 1 and edge.BoundBox.ZLength > 7]
    top = [index for index, face in enumerate(shape.Faces) if face.BoundBox.ZMin > 7]
    for given in (seen, seen.without_points_on(top)):
        state = gauss_newton_step(given, given.settings.schedule[0], start(given))
        edge = summarise(given, state).edges[far[0]]
        assert edge.flag != "observed" and np.isfinite(edge.bands).all()
