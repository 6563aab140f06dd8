# SPDX-License-Identifier: LGPL-2.1-or-later
"""What each prior costs at deformations whose strain, thickness and angles are known in closed form, and the trust."""
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings
from ffds_workbench.registration.joint.iteration import ShapeMatrices, start
from ffds_workbench.registration.joint.prior_trust import (cost_of_each_prior, is_isometric, may_be_isometric,
                                                           observed_strain, prior_cost, update_prior_trust)
from ffds_workbench.registration.joint.problem import make_problem

SIZE, THICKNESS = (50.0, 40.0), 2.0
AREA = 2 * SIZE[0] * SIZE[1]
"""Of both skins."""
SOFT = next(stage for stage in JointSettings().schedule if stage.soft and stage.all_points)


@pytest.fixture(scope="module")
def problem():
    """A plate seen on both skins: two of its faces are skins, four are walls."""
    place = np.random.default_rng(1).uniform(0, SIZE, (12_000, 2))
    scan = np.column_stack([place, np.repeat([0.0, THICKNESS], 6000)])
    return make_problem(joint_part(read(Part.makeBox(*SIZE, THICKNESS))), scan, JointSettings(), {})


@pytest.fixture(scope="module")
def deformed(problem, fit_control_points):
    """A function that gives the state whose displacement follows a field in space, all of it observed."""

    def at(field):
        state, points = start(problem), fit_control_points(problem, field)
        seen = replace(state.values, weight=problem.cells.inside.ravel().astype(float))
        return replace(state, control_points=points, values=seen,
                       cache=replace(state.cache, matrices=ShapeMatrices.of(problem, points)))

    return at


def stretched(strain):
    return lambda at: strain * at * [1, 0, 0]


def bent(radius):
    """Bent about y to a radius of the mid surface, which keeps its lengths; straight normals stay straight."""

    def field(at):
        angle, above = at[:, 0] / radius, at[:, 2] - 0.5 * THICKNESS
        return np.column_stack([(radius + above) * np.sin(angle), at[:, 1],
                                (radius + above) * np.cos(angle) - radius + 0.5 * THICKNESS]) - at

    return field


def test_a_rigid_motion_costs_nothing(problem, deformed):
    turn = 0.3
    matrix = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    state = deformed(lambda at: at @ matrix.T + [1.0, -2.0, 0.5] - at)
    # Affine fields are splines: nothing but rounding, in the squares of some thousands of weights up to 1e5.
    assert max(vars(cost_of_each_prior(problem, state)).values()) < 1e-6
    assert prior_cost(problem, state) < 1e-6
    assert update_prior_trust(problem, state, SOFT).trust == start(problem).trust


@pytest.mark.parametrize("strain", [0.001, 0.02])
def test_a_stretch_costs_the_square_of_its_strain(problem, deformed, strain):
    """Green's strain of a stretch ε is ε + ε²/2."""
    green = strain + 0.5 * strain**2
    state = deformed(stretched(strain))
    assert observed_strain(problem, state) == pytest.approx(green, rel=1e-9)
    small = cost_of_each_prior(problem, deformed(stretched(1e-4))).isometry
    wanted = small * (green / (1e-4 + 0.5e-8)) ** 2
    assert cost_of_each_prior(problem, state).isometry == pytest.approx(wanted, rel=1e-6)


def test_a_bend_keeps_lengths_and_thickness(problem, deformed):
    """Radius 100 mm over 50 mm: the skins stretch by t/2R = 1 %, the mid surface not at all."""
    state = deformed(bent(100.0))
    cost, stretch = cost_of_each_prior(problem, state), cost_of_each_prior(problem, deformed(stretched(0.01)))
    # A cubic misses an arc of a span by (span/R)⁴/384 of the radius: strains of some 1e-5 of those 1 %.
    assert observed_strain(problem, state) < 1e-3 * 0.01
    assert cost.isometry < 1e-6 * stretch.isometry
    trust = update_prior_trust(problem, state, SOFT).trust
    assert trust.isometry == trust.thickness == trust.shear == 1.0


def test_a_sheet_that_swells_costs_thickness_alone(problem, deformed):
    growth = 0.05
    state = deformed(lambda at: growth * (at - [0, 0, 0.5 * THICKNESS]) / THICKNESS * [0, 0, 1])
    cost, weight = cost_of_each_prior(problem, state), problem.couplings.thickness_weight
    assert cost.thickness == pytest.approx(weight.sum() * growth**2, rel=1e-6)
    assert cost.shear < 1e-9 * cost.thickness and cost.isometry < 1e-9 * cost.thickness
    # Every pair stands for its share of the skin; all of them together for no more than all of it.
    assert problem.couplings.pairs.area.sum() == pytest.approx(AREA / 2, rel=0.1)


def test_skins_that_slide_cost_shear_alone(problem, deformed):
    slide = 0.05
    state = deformed(lambda at: slide * (at[:, 2:] / THICKNESS) * [1, 0, 0])
    cost = cost_of_each_prior(problem, state)
    # Straight normals lean by s/t, which is to second order a change of thickness.
    assert cost.shear == pytest.approx(problem.couplings.thickness_weight.sum() * slide**2, rel=1e-6)
    assert cost.thickness < 1e-9 * cost.shear


def test_trust_is_what_is_expected_over_the_cost(problem, deformed):
    """Twice the strain is a quarter of the trust, until the trust is at its least; other priors keep theirs."""
    found = [update_prior_trust(problem, deformed(stretched(strain)), SOFT).trust for strain in (0.02, 0.04, 0.3)]
    assert found[0].isometry < 1.0
    assert found[0].isometry / found[1].isometry == pytest.approx((0.0408 / 0.0202) ** 2, rel=1e-3)
    assert found[0].thickness == found[0].shear == 1.0
    assert 0 < found[2].isometry < found[1].isometry


def test_the_first_soft_stage_allows_less(problem, deformed):
    state = deformed(stretched(0.02))
    first = next(stage for stage in problem.settings.schedule if stage.soft)
    usual, less = (update_prior_trust(problem, state, stage).trust for stage in (replace(first, allowance=1.0), first))
    assert first.allowance < 1.0
    assert less.isometry == pytest.approx(first.allowance * usual.isometry)
    stiff = problem.settings.schedule[0]
    assert update_prior_trust(problem, state, stiff).trust == start(problem).trust


@pytest.mark.parametrize("mode, isometric", [("on", True), ("off", False)])
def test_the_user_overrules(problem, deformed, mode, isometric):
    told = replace(problem, settings=replace(problem.settings, isometry=mode))
    state = update_prior_trust(told, deformed(stretched(0.02)), SOFT)
    assert is_isometric(state) == may_be_isometric(state) == isometric


def test_where_the_body_counts_trust_stays(problem, deformed):
    state = replace(deformed(stretched(0.05)), trust=replace(start(problem).trust, isometry=0.5))
    assert update_prior_trust(problem, state, replace(SOFT, body=True)) is state
