# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint solve: scan points pull the displacement lattices of all faces of a part at once.

One least-squares problem in chi-square units: every row is divided by its own standard deviation. The paper's steps
3 to 5 (closest points, Eq. 4, apply) run as Gauss-Newton iterations, stiff first and soft later: trust is earned step
by step.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..arrays import Array
from .body_field import body_informs
from .data import misfit
from .iteration import PointCache, State, gauss_newton_step, start
from .joint_result import JointRegistration
from .lattice_refinement import faces_to_refine, transfer
from .outcome import refuse_unsound, summarise, torn_faces
from .prior_trust import is_isometric, may_be_isometric, update_prior_trust
from .problem import Problem, make_problem
from .settings import JointSettings, Stage
from .skins import candidate_outward_normals, choose_skin, outward_normals_of_all
from .surfaces import JointPart, close_seams

Progress = Callable[[str, float], None]
_TRUST_SETTLES = 0.9
"""While the shape misses the scan, a stage goes on as long as a step lowers the trust in isometry below this factor
times the last one: shapes follow it slowly (calibrated: by hand, on the families of ``./ffds benchmark accuracy``)."""
_SHRINKS = 0.9
"""The first soft stage, which finds how far priors are trusted, ends when that has settled and a step is larger than
this times the last one: what still moves is held by priors alone, and those gain trust again in the next stage
(calibrated: by hand, on the families of ``./ffds benchmark accuracy``)."""
_NO_MORE_STIFF_STAGES = 0.5
"""If a stiff stage ends with a step smaller than this many times the scatter of the points about a stiff shape, the
remaining ones are skipped (unit: time)."""


def register_joint(part: JointPart, scan: Array, settings: JointSettings | None = None,
                   progress: Progress | None = None, scan_normals: Array | None = None) -> JointRegistration:
    """Register all faces of a part to a scan at once.

    Parameters
    ----------
    part : the faces, edges and solids
    scan : (n, 3) points in mm, in the frame of the part
    settings : weights and schedule; the defaults suit parts of any size
    progress : called as ``progress("stage", fraction)``
    scan_normals : (n, 3) unit normals of the scan, zero where it has none; they distinguish the skins of thin sheets,
        and are ignored where they contradict each other or the part

    Raises
    ------
    RefusedError
        no overlap, too few points, everything frozen, a displacement larger than the part, no convergence, or a surface
        that folded over
    """
    settings = settings or JointSettings()
    report = progress or (lambda stage, share: None)
    problem = make_problem(part, scan, settings, {}, scan_normals)         # steps 1 and 2: lattices, rows (assembly.py)
    steps = settings.stages(problem.lengths)                               # stiff first, soft later
    report("joint solve", 0.0)
    state = _fit(problem, steps, report)                                   # steps 3 to 5, Gauss-Newton
    torn = torn_faces(problem, state)                                      # small faces that fit the scan in two places
    if torn:
        problem = problem.without_points_on(torn)
        state = _fit(problem, steps, report)
    finer = faces_to_refine(problem, state) if settings.refine else {}     # where τ² is over a third of τ² + σ²/N
    if finer:
        report("finer lattice", 1.0)
        coarse, problem = problem, make_problem(part, scan, settings, finer).without_points_on(torn)
        state = transfer(coarse, problem, state)
        for stage in steps:
            if stage.soft:
                state = run_stage(problem, stage, state)
    closed = close_seams(part, problem.lattices, state.control_points)     # d at the end: (c₀ + 4 c₁ + c₂)/6
    state = replace(state, control_points=closed)
    refuse_unsound(problem, state)
    return replace(summarise(problem, state), torn=tuple(part.faces[index].name for index in torn))


def _fit(problem: Problem, steps: tuple[Stage, ...], report: Progress) -> State:
    """The shape after all stages, from the nominal one."""
    nominal = start(problem)
    sides, by_normals = candidate_outward_normals(problem)                 # which side of a sheet each point shows
    fits = [_run_stiff_stages(problem, steps, replace(nominal, outward=side), len(sides) > 1) for side in sides]
    state = choose_skin(problem, fits, by_normals)                         # the skin: cost, walls, normals, movement
    for number, stage in enumerate(steps):
        if stage.soft:
            report("joint solve", number / len(steps))
            state = _run_soft_stage(problem, stage, state)
    return state


def _run_stiff_stages(problem: Problem, steps: tuple[Stage, ...], state: State, compared: bool) -> State:
    """The stiff stages, some of which may be skipped; fits that are ``compared`` all end with the last one."""
    stiff = [stage for stage in steps if not stage.soft]
    for stage in stiff:
        if state.last_step > _NO_MORE_STIFF_STAGES * problem.lengths.start or (compared and stage is stiff[-1]):
            state = run_stage(problem, stage, state)
    return state


def _run_soft_stage(problem: Problem, stage: Stage, state: State) -> State:
    """A soft stage. A sheet that can follow the scan without stretching is assumed not to have stretched."""
    if stage.allowance < 1.0 and problem.skin.any():
        unstretched = run_stage(problem, replace(stage, allowance=1.0), state, may_be_isometric)
        if is_isometric(unstretched):
            return unstretched
        del unstretched  # its matrices take much memory
    return run_stage(problem, stage, state)


def run_stage(problem: Problem, stage: Stage, state: State,
              promising: Callable[[State], bool] = lambda state: True) -> State:
    """Gauss-Newton steps of one stage, while it is ``promising``, until they are smaller than what it can resolve."""
    if stage.body and not body_informs(problem, state.trust):
        return state
    cache = state.cache
    if stage.all_points and not stage.body:
        cache = replace(cache, points=PointCache(None, outward_normals_of_all(problem, state.outward)),
                        factor=cache.factor and replace(cache.factor, bending=np.inf))
    if stage.soft:
        cache = replace(cache, matrices=cache.matrices.renewed_thickness(problem, state.control_points), body=None)
    state = replace(state, cache=cache)
    for number in range(stage.iterations):
        before, judged = state, update_prior_trust(problem, state, stage)  # MacKay 1992, eq. 4.8
        if not promising(judged):
            return judged
        state = gauss_newton_step(problem, stage, judged)
        loosening = state.trust.isometry < _TRUST_SETTLES * before.trust.isometry
        if number == 0 and stage.all_points and not stage.body:
            continue  # what it moves by is what other points say, not how far the shape is from settling
        if state.last_step < stage.enough and not (stage.all_points and loosening and _misfits_scan(problem, state)):
            break
        if stage.soft and not stage.all_points and not loosening and state.last_step > _SHRINKS * before.last_step:
            break
    return state


def _misfits_scan(problem: Problem, state: State) -> bool:
    """Whether the shape lies somewhere farther off the scan than its noise."""
    off = misfit(state.values, problem.lattices, problem.cells, problem.body_size)
    return bool(off.max() > problem.lengths.start**2)
