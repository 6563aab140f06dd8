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
from .body_field import add_body, body_rows, body_tells
from .data import (CellValues, Correspondence, Scatter, correspond, find_borders, find_near_edges, make_frames, medians,
                   tukey_means)
from .joint_result import JointRegistration
from .lattice_refinement import finer_faces, transfer
from .linear import solve
from .outcome import refuse_bad, summarise
from .part import JointPart
from .prior_trust import is_isometric, judge
from .problem import Problem, make_problem
from .settings import JointSettings, Stage, stages
from .skins import facing, shown
from .state import Kept, State, start
from .surfaces import Jet, exact_ends
from .uncertainty import misfit

Progress = Callable[[str, float], None]
_FIRM = 0.9
"""Where the shape lies off all of the scan, a stage goes on while the trust in isometry falls by more than this factor:
shapes follow it slowly."""
_SETTLED = 0.05
"""A stage that ends with a step smaller than this in mm leaves nothing to do for the other stiff ones."""
_HARDLY_MOVES = 0.1
"""Movement in mm after which points keep their cells: a small share of a cell."""
_HARDLY_TURNS = 0.5
"""Movement in mm over which the directions of strain are taken as they were: by a small share of a span no face turns
so far that the steps would go astray."""
_SOFTER = 0.03
"""A matrix with this share of the bending is too far from one with all of it to be solved with that one's factor."""


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
    sides, told = facing(problem, state.reach)
    state = shown(problem, [_stiff(problem, steps, replace(state, facing=outward), len(sides) > 1)
                            for outward in sides], told)
    for number, stage in enumerate(steps):
        if stage.soft:
            report("joint solve", number / len(steps))
            state = _soft(problem, stage, state)
    finer = finer_faces(problem, state) if settings.refine else {}
    if finer:
        report("finer lattice", 1.0)
        coarse, problem = problem, make_problem(part, scan, settings, finer)
        state = transfer(coarse, problem, state)
        for stage in steps:
            if stage.soft:
                state = run_stage(problem, stage, state)
    state = replace(state, control_points=exact_ends(part, problem.lattices, state.control_points))
    refuse_bad(problem, state)
    return summarise(problem, state)


def _stiff(problem: Problem, steps: tuple[Stage, ...], state: State, compared: bool) -> State:
    """The stiff stages, of which some can be left out; fits that are ``compared`` all end with the last one."""
    stiff = [stage for stage in steps if not stage.soft]
    for stage in stiff:
        if state.last_step > _SETTLED or (compared and stage is stiff[-1]):
            state = run_stage(problem, stage, state)
    return state


def _soft(problem: Problem, stage: Stage, state: State) -> State:
    """A soft stage; a sheet that complies without any stretch has not stretched."""
    if stage.allowance < 1.0 and problem.skin.any():
        unstretched = run_stage(problem, replace(stage, allowance=1.0), state)
        if is_isometric(unstretched):
            return unstretched
    return run_stage(problem, stage, state)


def run_stage(problem: Problem, stage: Stage, state: State) -> State:
    """Gauss-Newton steps of one stage, until they are small against what the stage can tell."""
    if stage.body and not body_tells(problem, state.trust):
        return state
    kept = state.kept
    if stage.all_points and not stage.body:
        kept = replace(kept, nearest=None, factor=None)
    if stage.soft:
        kept = replace(kept, across=problem.across(state.control_points, kept.across), body=None)
    state = replace(state, kept=kept)
    for _ in range(stage.iterations):
        before, state = state, iterate(problem, stage, judge(problem, state, stage))
        loosening = stage.all_points and state.trust.isometry < _FIRM * before.trust.isometry
        if state.last_step < stage.enough and not (loosening and _is_off(problem, state)):
            break
    return state


def _is_off(problem: Problem, state: State) -> bool:
    """Whether the shape lies somewhere farther off the scan than its noise."""
    return bool(misfit(problem, state.values).max() > problem.lengths.start**2)


def iterate(problem: Problem, stage: Stage, state: State) -> State:
    """One step: match the scan to the current shape, weigh every cell, solve, move the control points."""
    jet = problem.cells.displaced(problem.lattices, state.control_points)
    found = _match(problem, stage, state, jet)
    values = _weigh(problem, stage, found, state.values.scatter)
    kept = _renew(problem, stage, replace(state, values=values), jet)
    equations = shape_equations(problem, state.control_points, stage.bending, state.trust, kept.strained, kept.across)
    add_data(equations, problem, jet, values)
    if kept.borders is not None:
        add_borders(equations, problem, state.control_points, kept.borders)
    if kept.body is not None:
        add_body(equations, problem, state.control_points, kept.body, state.trust)
    near = kept.factor if stage.bending > _SOFTER * kept.stiff else None
    step, factor = solve(problem.pattern, equations.blocks, equations.right, near)
    moved = problem.cells.tables[0] @ step[problem.lattices.controls]
    last_step = float(np.sqrt((moved[problem.cells.inside] ** 2).sum(axis=1).max()))
    kept = replace(kept, nearest=found.nearest, turned=kept.turned + last_step, factor=factor,
                   stiff=stage.bending if factor is not near else kept.stiff)
    return replace(state, control_points=state.control_points + step, values=values, last_step=last_step,
                   iterations=state.iterations + 1, kept=kept)


def _match(problem: Problem, stage: Stage, state: State, jet: Jet) -> Correspondence:
    """The scan points of the stage with their cells on the current shape."""
    points = problem.scan if stage.all_points else problem.sample
    frames = make_frames(problem.lattices, problem.cells, jet, problem.margin, problem.distance)
    gate = max(stage.gate, 4 * problem.statistics.noise)
    found = correspond(points, frames, gate, state.kept.nearest if state.last_step < _HARDLY_MOVES else None,
                       None if stage.all_points else state.facing)
    if not len(found.point):
        raise RefusedError("No scan point lies near the part: check the unit of the scan and align it first.")
    return found


def _weigh(problem: Problem, stage: Stage, found: Correspondence, scatter: Scatter) -> CellValues:
    """A height and a weight for every cell."""
    face_of_span, per_span = problem.lattices.face_of_span, problem.distance.shape[1]
    if not stage.all_points:
        return medians(found, scatter, face_of_span, per_span)
    return tukey_means(found, scatter, face_of_span, per_span, (problem.lengths.resolution, problem.lengths.model))


def _renew(problem: Problem, stage: Stage, state: State, jet: Jet) -> Kept:
    """What is kept, renewed where the shape has moved too far since."""
    kept, control_points = state.kept, state.control_points
    if kept.turned > _HARDLY_TURNS:
        kept = replace(kept, strained=strain_blocks(problem, control_points), turned=0.0)
    if stage.soft:
        edges, sides = problem.couplings.edges, problem.sides
        near_edges = find_near_edges(problem.scan, edges, sides, control_points, kept.near_edges)
        borders = find_borders(near_edges, edges, sides, control_points, problem.lengths.noise, problem.lengths.start,
                               kept.borders)
        kept = replace(kept, near_edges=near_edges, borders=borders)
        if stage.body:
            kept = replace(kept, body=body_rows(problem, control_points, jet, state.values, borders, kept.body))
    return kept
