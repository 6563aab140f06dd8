# SPDX-License-Identifier: LGPL-2.1-or-later
"""A joint solve for previews: coarse lattices, few points, and one step from the last state when a setting changes."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..splines import SplineSurface
from .iteration import State, gauss_newton_step, start
from .prior_trust import update_prior_trust
from .problem import Problem, make_problem
from .settings import JointSettings, Stage
from .skins import candidate_outward_normals
from .surfaces import JointPart

_COARSER = 0.4
"""Spans of a preview over those of the result (unit: time)."""
_SAMPLE_SIZE = 6000
"""Scan points of a preview (unit: time)."""


class LiveJoint:
    """The joint registration of a part to a scan, coarse and fast.

    Parameters
    ----------
    part, scan, settings, scan_normals : as in `register_joint`; the settings are where it starts from

    Raises
    ------
    RefusedError : as `register_joint` does
    """

    def __init__(self, part: JointPart, scan: Array, settings: JointSettings,
                 scan_normals: Array | None = None) -> None:
        some = np.random.default_rng(settings.seed).permutation(len(scan))[:_SAMPLE_SIZE]
        self._problem = make_problem(part, scan[some], _coarse(settings), {},
                                     None if scan_normals is None else scan_normals[some])
        state = start(self._problem)
        sides, _ = candidate_outward_normals(self._problem)
        self._state = replace(state, outward=sides[0])
        for stage in settings.stages(self._problem.lengths):
            if not stage.all_points:
                self._state = update_prior_trust(self._problem, self._state, stage)
                self._state = _steps(self._problem, stage, self._state, stage.iterations)
        self._isometry = settings.isometry

    def step(self, settings: JointSettings) -> list[SplineSurface]:
        """Displacements of all faces, d(u, v) in mm, one step further with these weights and gates."""
        problem = replace(self._problem, settings=_coarse(settings))
        steps = settings.stages(problem.lengths)
        stage = replace([stage for stage in steps if not stage.all_points][-1], gate=steps[-1].gate)
        if settings.isometry != self._isometry:
            self._state = update_prior_trust(problem, self._state, stage)
            self._isometry = settings.isometry
        self._state = _steps(problem, stage, self._state, 1)
        lattices = problem.lattices
        return [lattices.spline(index, self._state.control_points) for index in range(len(problem.part.faces))]


def _coarse(settings: JointSettings) -> JointSettings:
    return replace(settings, spans=_COARSER * settings.spans, refine=False)


def _steps(problem: Problem, stage: Stage, state: State, most: int) -> State:
    """Gauss-Newton steps without visible borders, which change little here and take half of the time."""
    state = replace(state, cache=replace(state.cache, points=replace(state.cache.points, nearest=None)))
    for _ in range(most):
        state = gauss_newton_step(problem, replace(stage, soft=False), state)
        if state.last_step < stage.enough:
            break
    return state
