# SPDX-License-Identifier: LGPL-2.1-or-later
"""One Gauss-Newton step: match the scan to the current shape, weight every cell, solve, move the control points."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....errors import RefusedError
from ...arrays import Array
from ..body_field import body_rows
from ..data import (CellHeights, Correspondence, Scatter, correspond, find_borders, find_near_edges,
                    median_heights, tukey_mean_heights)
from ..linear import NormalEquations, solve_normal_equations
from ..problem import Problem
from ..settings import Stage
from ..surfaces import Jet
from .assembly import add_observations, prior_equations
from .state import EarlierFactor, EdgeCache, State, StepCache

_MATCHES_LAST = 0.08
"""Over the usual side of a cell: after smaller steps, points keep their cells (unit: a small share of a cell)."""
_FACTOR_LASTS = 0.03
"""A factor is not used for a matrix with less than this share of its bending weight (unit: time)."""


def gauss_newton_step(problem: Problem, stage: Stage, state: State) -> State:
    """The state after one step.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    stage : of the schedule
    state : where the solve stands

    Raises
    ------
    RefusedError
        no scan point lies near the part
    """
    jet = problem.cells.displaced(problem.lattices, state.control_points)                 # S₀ + B ΔP̃ (Eq. 2)
    found = _match_scan(problem, stage, state, jet)                                       # step 3: cells, heights h
    state = replace(state, values=_weigh(problem, stage, found, state.values.scatter))    # W/(σ² + N τ²) of each cell
    state = replace(state, cache=_renewed_cache(problem, stage, state, jet))              # borders, body, strain
    equations = prior_equations(problem, state, stage.bending)                            # the table of `assembly`
    add_observations(equations, problem, state, jet)                                      # n·(B δ) = h (Eq. 3)
    del jet  # a factor needs the memory
    step, factor = _solve(problem, stage, state, equations)                               # step 4: δ = A⁻¹ r (Eq. 4)
    face_steps = _face_steps(problem, step)
    last_step = float(face_steps.max())
    cache = state.cache
    cache = replace(cache, points=replace(cache.points, nearest=found.nearest), factor=factor,
                    matrices=replace(cache.matrices, moved=cache.matrices.moved + last_step))
    return replace(state, control_points=state.control_points + step, last_step=last_step,
                   iterations=state.iterations + 1, cache=cache, face_steps=face_steps)


def _match_scan(problem: Problem, stage: Stage, state: State, jet: Jet) -> Correspondence:
    """The scan points of the stage with their cells on the current shape."""
    points = problem.scan if stage.all_points else problem.sample
    frames = problem.frames(jet)
    near = state.last_step < _MATCHES_LAST * problem.cell_side
    found = correspond(points, frames, stage.gate, state.cache.points.nearest if near else None,
                       state.cache.points.outward if stage.all_points else state.outward)
    if not len(found.point):
        raise RefusedError("No scan point lies near the part: check the unit of the scan and align it first.")
    return found


def _weigh(problem: Problem, stage: Stage, found: Correspondence, scatter: Scatter) -> CellHeights:
    """A height and a weight for every cell."""
    face_of_span, per_span = problem.lattices.face_of_span, problem.distance.shape[1]
    if not stage.all_points:
        return median_heights(found, scatter, face_of_span, per_span)
    return tukey_mean_heights(found, scatter, face_of_span, per_span,
                              (problem.lengths.resolution, problem.lengths.model))


def _renewed_cache(problem: Problem, stage: Stage, state: State, jet: Jet) -> StepCache:
    """The cache, renewed where the shape has moved too far since."""
    control_points = state.control_points
    cache = replace(state.cache, matrices=state.cache.matrices.renewed_strain(problem, control_points))
    if not stage.soft:
        return cache
    edges, sides = problem.couplings.edges, problem.sides
    near = find_near_edges(problem.scan, edges, sides, control_points, problem.lengths, cache.edges.near)
    borders = find_borders(near, edges, sides, control_points, problem.lengths,
                           np.maximum(state.values.scatter.loss, problem.lengths.border),
                           state.values.count / np.maximum(problem.area.ravel(), 1e-12), cache.edges.borders)
    cache = replace(cache, edges=EdgeCache(near, borders))
    if not stage.body:
        return cache
    return replace(cache, body=body_rows(problem, control_points, jet, state.values, borders, cache.body))


def _solve(problem: Problem, stage: Stage, state: State, equations: NormalEquations) -> tuple[Array, EarlierFactor]:
    """The step of the control points, (controls, 3) in mm, and the factor to go on with."""
    earlier = state.cache.factor
    near = earlier is not None and stage.bending > _FACTOR_LASTS * earlier.bending
    step, factor = solve_normal_equations(problem.pattern, equations.blocks, equations.right,
                                          None if earlier is None else earlier.cholesky, near)
    free = problem.free_motions
    if free.texts:
        responses = np.array([factor.solve(row.ravel()).reshape(-1, 3) for row in free.rows])
        step = free.hold(state.control_points, step, responses)
    if earlier is not None and factor is earlier.cholesky:
        return step, earlier
    return step, EarlierFactor(factor, stage.bending)


def _face_steps(problem: Problem, step: Array) -> Array:
    """Largest movement of a cell of every face by a step (controls, 3) of the control points: (faces,) in mm."""
    moved = problem.cells.tables[0] @ step[problem.lattices.controls]
    result = np.zeros(len(problem.part.faces))
    np.maximum.at(result, problem.lattices.face_of_span,
                  np.where(problem.cells.inside, np.sqrt((moved**2).sum(axis=2)), 0.0).max(axis=1))
    return result
