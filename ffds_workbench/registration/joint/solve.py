# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint solve: scan points pull the displacement lattices of all faces of a part at once.

One least-squares problem in chi-square units: every row is divided by its own standard deviation. The paper's steps
3 to 5 (closest points, Eq. 4, apply) run as Gauss-Newton iterations, stiff first and soft later: trust is earned
in order.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...errors import RefusedError
from ..arrays import Array
from .assembly import add_borders, add_data, shape_equations, strain_blocks
from .body_field import add_body_rows, body_informs, body_rows
from .data import (CellHeights, Correspondence, Scatter, correspond, find_borders, find_near_edges, make_frames,
                   median_heights, tukey_mean_heights)
from .joint_result import JointRegistration
from .lattice_refinement import faces_to_refine, transfer
from .linear import solve_normal_equations
from .outcome import refuse_unsound, summarise, torn_faces
from .prior_trust import is_isometric, may_be_isometric, update_prior_trust
from .problem import Problem, make_problem
from .settings import JointSettings, Stage, stages
from .skins import candidate_outward_normals, choose_skin, outward_normals_of_all
from .state import State, StepCache, start
from .surfaces import Jet, JointPart, close_seams
from .uncertainty import misfit

Progress = Callable[[str, float], None]
_TRUST_SETTLES = 0.9
"""While the shape misses the scan, a stage goes on as long as a step lowers the trust in isometry below this factor
times the last one: shapes follow it slowly."""
_NO_MORE_STIFF_STAGES = 0.05
"""If a stiff stage ends with a step smaller than this in mm, the remaining stiff stages are skipped."""
_MATCHES_LAST = 0.1
"""After a step smaller than this in mm, points keep their cells: it is a small share of a cell."""
_STRAIN_LASTS = 0.5
"""The strain matrices are kept until the shape has moved by this in mm: by a small share of a span no face turns so far
that the steps would go astray."""
_FACTOR_LASTS = 0.03
"""A factor is not used for a matrix with less than this share of its bending weight."""


def register_joint(part: JointPart, scan: Array, settings: JointSettings | None = None,
                   progress: Progress | None = None, scan_normals: Array | None = None) -> JointRegistration:
    """Register all faces of a part to a scan at once.

    Parameters
    ----------
    part : the faces, edges and solids
    scan : (n, 3) points in mm, in the frame of the part
    settings : weights and schedule; the defaults suit sheet parts of 50–150 mm
    progress : called as ``progress("stage", fraction)``
    scan_normals : (n, 3) unit normals that the scan brings, zero where it has none; they tell the skins of thin sheets
        apart, and are left aside where they contradict each other or the part

    Raises
    ------
    RefusedError
        no overlap, too few points, everything frozen, a displacement larger than the part, no convergence, or a surface
        that folded over
    """
    settings = settings or JointSettings()
    report = progress or (lambda stage, share: None)
    problem = make_problem(part, scan, settings, {}, scan_normals)
    state = start(problem)
    steps = stages(settings.schedule, state.reach)
    report("joint solve", 0.0)
    sides, told = candidate_outward_normals(problem, state.reach)
    state = choose_skin(problem, [_run_stiff_stages(problem, steps, replace(state, facing=outward), len(sides) > 1)
                                  for outward in sides], told)
    stiff, state = state, _run_soft_stages(problem, steps, state, report)
    torn = torn_faces(problem, state)
    if torn:
        problem = problem.without_points_on(torn)
        state = _run_soft_stages(problem, steps, stiff, report)
    finer = faces_to_refine(problem, state) if settings.refine else {}
    if finer:
        report("finer lattice", 1.0)
        coarse, problem = problem, make_problem(part, scan, settings, finer).without_points_on(torn)
        state = transfer(coarse, problem, state)
        for stage in steps:
            if stage.soft:
                state = run_stage(problem, stage, state)
    state = replace(state, control_points=close_seams(part, problem.lattices, state.control_points))
    refuse_unsound(problem, state)
    return replace(summarise(problem, state), torn=tuple(part.faces[index].name for index in torn))


def _run_stiff_stages(problem: Problem, steps: tuple[Stage, ...], state: State, compared: bool) -> State:
    """The stiff stages, some of which may be skipped; fits that are ``compared`` all end with the last one."""
    stiff = [stage for stage in steps if not stage.soft]
    for stage in stiff:
        if state.last_step > _NO_MORE_STIFF_STAGES or (compared and stage is stiff[-1]):
            state = run_stage(problem, stage, state)
    return state


def _run_soft_stages(problem: Problem, steps: tuple[Stage, ...], state: State, report: Progress) -> State:
    for number, stage in enumerate(steps):
        if stage.soft:
            report("joint solve", number / len(steps))
            state = _run_soft_stage(problem, stage, state)
    return state


def _run_soft_stage(problem: Problem, stage: Stage, state: State) -> State:
    """A soft stage. A sheet that can follow the scan without stretching is taken not to have stretched."""
    if stage.allowance < 1.0 and problem.skin.any():
        unstretched = run_stage(problem, replace(stage, allowance=1.0), state, may_be_isometric)
        if is_isometric(unstretched):
            return unstretched
    return run_stage(problem, stage, state)


def run_stage(problem: Problem, stage: Stage, state: State,
              promising: Callable[[State], bool] = lambda state: True) -> State:
    """Gauss-Newton steps of one stage, while it is ``promising``, until they are smaller than what it can resolve."""
    if stage.body and not body_informs(problem, state.trust):
        return state
    cache = state.cache
    if stage.all_points and not stage.body:
        cache = replace(cache, nearest=None, factor_bending=np.inf,
                        facing=outward_normals_of_all(problem, state.facing))
    if stage.soft:
        cache = replace(cache, thickness_rows=problem.thickness_rows(state.control_points, cache.thickness_rows),
                        body=None)
    state = replace(state, cache=cache)
    for _ in range(stage.iterations):
        before, judged = state, update_prior_trust(problem, state, stage)
        if not promising(judged):
            return judged
        state = gauss_newton_step(problem, stage, judged)
        loosening = stage.all_points and state.trust.isometry < _TRUST_SETTLES * before.trust.isometry
        if state.last_step < stage.enough and not (loosening and _misfits_scan(problem, state)):
            break
    return state


def _misfits_scan(problem: Problem, state: State) -> bool:
    """Whether the shape lies somewhere farther off the scan than its noise."""
    return bool(misfit(problem, state.values).max() > problem.lengths.start**2)


def gauss_newton_step(problem: Problem, stage: Stage, state: State) -> State:
    """One step: match the scan to the current shape, weigh every cell, solve, move the control points."""
    jet = problem.cells.displaced(problem.lattices, state.control_points)
    found = _match_scan(problem, stage, state, jet)
    values = _weigh(problem, stage, found, state.values.scatter)
    cache = _renewed_cache(problem, stage, replace(state, values=values), jet)
    equations = shape_equations(problem, state.control_points, stage.bending, state.trust, cache.strain_matrices,
                                cache.thickness_rows)
    add_data(equations, problem, jet, values)
    if cache.borders is not None:
        add_borders(equations, problem, state.control_points, cache.borders)
    if cache.body is not None:
        add_body_rows(equations, problem, state.control_points, cache.body, state.trust)
    near = stage.bending > _FACTOR_LASTS * cache.factor_bending
    step, factor = solve_normal_equations(problem.pattern, equations.blocks, equations.right, cache.factor, near)
    free = problem.free_motions
    if free.texts:
        step = free.hold(state.control_points, step, np.array([factor.solve(row.ravel()).reshape(-1, 3)
                                                               for row in free.rows]))
    moved = problem.cells.tables[0] @ step[problem.lattices.controls]
    face_steps = np.zeros(len(problem.part.faces))
    np.maximum.at(face_steps, problem.lattices.face_of_span,
                  np.where(problem.cells.inside, np.sqrt((moved**2).sum(axis=2)), 0.0).max(axis=1))
    last_step = float(face_steps.max())
    cache = replace(cache, nearest=found.nearest, moved=cache.moved + last_step, factor=factor,
                    factor_bending=cache.factor_bending if factor is cache.factor else stage.bending)
    return replace(state, control_points=state.control_points + step, values=values,
                   last_step=last_step, iterations=state.iterations + 1, cache=cache, face_steps=face_steps)


def _match_scan(problem: Problem, stage: Stage, state: State, jet: Jet) -> Correspondence:
    """The scan points of the stage with their cells on the current shape."""
    points = problem.scan if stage.all_points else problem.sample
    frames = make_frames(problem.lattices, problem.cells, jet, problem.margin, problem.distance)
    gate = max(stage.gate, 4 * problem.lengths.noise)
    found = correspond(points, frames, gate, state.cache.nearest if state.last_step < _MATCHES_LAST else None,
                       state.cache.facing if stage.all_points else state.facing)
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
    cache, control_points = state.cache, state.control_points
    if cache.moved > _STRAIN_LASTS:
        cache = replace(cache, strain_matrices=strain_blocks(problem, control_points), moved=0.0)
    if stage.soft:
        edges, sides = problem.couplings.edges, problem.sides
        near_edges = find_near_edges(problem.scan, edges, sides, control_points, cache.near_edges)
        borders = find_borders(near_edges, edges, sides, control_points, problem.lengths.noise,
                               np.maximum(state.values.scatter.loss, problem.lengths.border),
                               state.values.count / np.maximum(problem.area.ravel(), 1e-12), cache.borders)
        cache = replace(cache, near_edges=near_edges, borders=borders)
        if stage.body:
            cache = replace(cache, body=body_rows(problem, control_points, jet, state.values, borders, cache.body))
    return cache
