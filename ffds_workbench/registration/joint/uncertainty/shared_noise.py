# SPDX-License-Identifier: LGPL-2.1-or-later
"""The effect of correlated noise, which the lattices follow as they follow shape.

The result is linear in the heights of the scan, so that random fields drawn from the sensor's profile and put through
the last normal equations scatter as the result does.
"""
from __future__ import annotations

import numpy as np

from ...arrays import Array
from ..iteration import State
from ..linear import FrontCholesky
from ..problem import Problem
from ..surfaces import normals

_FIELD_COUNT, _WAVE_COUNT = 48, 300
"""Fields that are drawn, which tell a standard deviation to 1/√(2 · 48) = 10 % (theory), and waves of each (unit)."""
_CHUNK = 8192
"""Places that are looked at together (unit: memory)."""


def shared_errors(problem: Problem, state: State, factor: FrontCholesky) -> Array:
    """Changes of the control points, (fields, controls, 3) in mm, that fields of shared noise cause; none without.

    ``factor`` is that of the last normal equations.
    """
    sensor = problem.settings.sensor
    if not sensor.shared:
        return np.zeros((0, problem.lattices.count, 3))
    shape = problem.cells.inside.shape
    weight = state.values.weight.reshape(shape)
    cells = np.flatnonzero(weight)
    heights = np.zeros((problem.cells.inside.size, _FIELD_COUNT))
    heights[cells] = sensor.sigma_c * _random_fields(problem.cells.nominal.position.reshape(-1, 3)[cells],
                                                     sensor.correlation_length,
                                                     np.random.default_rng(problem.settings.seed))
    jet = problem.cells.displaced(problem.lattices, state.control_points)
    rows = weight[:, :, None] * normals(jet, problem.cells.outward)[0]
    table = problem.cells.tables[0]
    loads = np.stack([problem.lattices.sum_of_loads(np.matmul(table.T, field[:, :, None] * rows)).ravel()
                      for field in heights.T.reshape(_FIELD_COUNT, *shape)], axis=1)
    return factor.solve_many(loads).T.reshape(_FIELD_COUNT, -1, 3)


def _random_fields(place: Array, length: float, rng: np.random.Generator) -> Array:
    """Random fields of unit variance with the correlation exp(−r²/2 length²) at places (n, 3): (n, fields).

    Sums of random waves (Rahimi and Recht, Random Features for Large-Scale Kernel Machines, 2007).
    """
    waves = rng.normal(0.0, 1.0 / length, (3, _WAVE_COUNT))
    amplitude = rng.normal(0.0, 1.0 / np.sqrt(_WAVE_COUNT), (2, _WAVE_COUNT, _FIELD_COUNT))
    result = np.empty((len(place), _FIELD_COUNT))
    for start in range(0, len(place), _CHUNK):
        phase = place[start : start + _CHUNK] @ waves
        result[start : start + _CHUNK] = np.cos(phase) @ amplitude[0] + np.sin(phase) @ amplitude[1]
    return result
