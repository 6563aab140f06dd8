# SPDX-License-Identifier: LGPL-2.1-or-later
"""The iteration: `state` (the current point, and what is reused), `assembly` (the objective, row by row), `step` (one
Gauss-Newton step) and `shape_matrices` (what the priors add to the matrix, kept for shapes near by).
"""
from .assembly import add_observations, mean_curvature_change, prior_equations
from .shape_matrices import ShapeMatrices
from .state import EdgeCache, PointCache, State, StepCache, start
from .step import gauss_newton_step

__all__ = ["EdgeCache", "PointCache", "ShapeMatrices", "State", "StepCache", "add_observations", "gauss_newton_step",
           "mean_curvature_change", "prior_equations", "start"]
