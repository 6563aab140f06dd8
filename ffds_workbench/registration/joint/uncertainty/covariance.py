# SPDX-License-Identifier: LGPL-2.1-or-later
"""The covariance of the control points, with priors widened as far as the scan requires."""
from __future__ import annotations

import numpy as np

from ...arrays import Array
from ..iteration import State, add_observations, prior_equations
from ..linear import FrontCholesky, NormalEquations
from ..prior_trust import prior_cost
from ..problem import Problem
from .shared_noise import shared_errors

_PRIORS_WIDE_ENOUGH = 1.2
"""Priors are widened if their cost exceeds the effective degrees of freedom by more than this factor (unit)."""
_HUTCHINSON_PROBES = 16
"""Vectors of random signs: they tell a trace T to √(2/16 T) or better (theory: Hutchinson)."""


def covariance_blocks(problem: Problem, state: State) -> tuple[Array, Array]:
    """Blocks (3, 3, size) of the covariance on the pattern, and the errors that `shared_errors` finds.

    In chi-square units the normal matrix is the inverse of the covariance. The cost of the priors, over the effective
    degrees of freedom that the scan determines, is the factor by which their variances are too small (MacKay, Neural
    Computation 4, 1992, eq. 4.8, for all priors together).
    """
    factor, errors = _factor(problem, state)
    return factor.inverse_blocks(), errors


def _factor(problem: Problem, state: State) -> tuple[FrontCholesky, Array]:
    prior = prior_equations(problem, state, 1.0).blocks
    # By themselves: of a sum with priors of many orders of magnitude the observations cannot be got back.
    observations = NormalEquations(problem.pattern, np.zeros_like(prior), np.zeros((problem.lattices.count, 3)))
    add_observations(observations, problem, state, problem.cells.displaced(problem.lattices, state.control_points))
    # The factor that the solve ends with is of an earlier trust in the priors.
    factor = FrontCholesky(problem.pattern.layout, observations.blocks + prior)
    ratio = prior_cost(problem, state) / max(_effective_dof(problem, factor, prior), 1.0)
    errors = shared_errors(problem, state, factor)
    if ratio < _PRIORS_WIDE_ENOUGH:
        return factor, errors
    prior /= ratio
    prior += observations.blocks
    return FrontCholesky(problem.pattern.layout, prior, factor), errors


def _effective_dof(problem: Problem, factor: FrontCholesky, prior: Array) -> float:
    """Effective degrees of freedom that the scan determines: the trace of 1 − A⁻¹ P with the factor of A, estimated
    from random signs (Hutchinson, Communications in Statistics 18, 1989) to about 2 %."""
    unknowns = 3 * problem.lattices.count
    signs = np.random.default_rng(problem.settings.seed).choice([-1.0, 1.0], (unknowns, _HUTCHINSON_PROBES))
    carried = factor.solve_many(problem.pattern.product(prior)(signs))
    return float(((signs - carried) * signs).sum() / _HUTCHINSON_PROBES)
