# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint solve: scan points pull the displacement lattices of all faces at once."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..splines import Array
from .assembly import data_equations, shape_equations
from .correspondence import correspond, make_frames, trim_margin
from .isometry import isometry_weights, observed_strain
from .part import JointPart
from .problem import Problem, make_problem
from .settings import JointSettings
from .system import solve
from .values import CellValues, medians, tukey_means

Progress = Callable[[str, float], None]
_NO_PROGRESS: Progress = lambda stage, share: None  # noqa: E731


def run(problem: Problem, control_points: Array, settings: JointSettings, progress: Progress = _NO_PROGRESS, debug=None):
    cells, lattices = problem.cells, problem.lattices
    face_of_cell = problem.face_of_cell
    noise = np.full(len(problem.part.faces), problem.statistics.noise)
    factor = None
    count = face_of_cell.size
    step_size = []
    isometry = None
    k = 0
    for stage in settings.schedule:
        factor = None
        for _ in range(stage.iterations):
            jet = cells.displaced(lattices, control_points)
            points = problem.scan if stage.all_points else problem.sample
            margin = trim_margin(lattices, problem.distance, 0.7)
            frames = make_frames(lattices, cells, jet, margin, problem.distance)
            gate = max(stage.gate, 4 * problem.statistics.noise)
            found = correspond(points, frames, gate)
            values = (tukey_means if stage.all_points else medians)(found, count, noise, face_of_cell)
            noise = values.noise
            if k in (0, 5):
                isometry = isometry_weights(problem, control_points, values, settings, decide=k > 0)
                factor = None
            equations = (data_equations(problem, jet, values)
                         + shape_equations(problem, control_points, stage.bending, isometry))
            step, factor = solve(problem.pattern, equations.blocks, equations.right, factor)
            control_points = control_points + step
            k += 1
            step_size.append(np.abs(step).max())
            if debug:
                debug(k, stage, found, values, control_points, step)
    return control_points, values, factor, isometry
