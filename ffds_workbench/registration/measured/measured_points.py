# SPDX-License-Identifier: LGPL-2.1-or-later
"""A part through a few measured points: what they leave open, its stiffness fills in.

The rows of the joint solve without a scan: bending, isometry and thickness of sheets, shared edges, as in
`joint.iteration`; of each point one row along its direction. How far the priors are held follows from what the points
make them cost.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, Index
from ..joint.iteration import ShapeMatrices, State, prior_equations, start
from ..joint.linear import FrontCholesky, NormalEquations
from ..joint.prior_trust import prior_cost, update_prior_trust
from ..joint.priors import COMPONENTS
from ..joint.problem import Problem, make_problem
from ..joint.settings import JointSettings, Stage
from ..joint.surfaces import FacePlaces, JointPart, places_on_faces
from ..splines import SplineSurface

_ITERATIONS = 8
"""Gauss-Newton steps (unit: the last ones move by less than a thousandth of the first)."""
_SHAPES_OF_A_SCAN = 60.0
"""Shapes that a whole scan tells of a part, over which few points allow the priors to cost less (unit)."""
_SOFT = Stage(1.0, 1.0, 1, 0.0, soft=True)
"""A stage in which priors are trusted as far as they cost (theory: what measured points say needs no stiff stages)."""


@dataclass(frozen=True)
class MeasuredRows:
    """What was measured, one row each.

    Attributes
    ----------
    face : (n,) numbers of the faces
    uv : (n, 2) parameters on them
    direction : (n, 3) unit vectors along which was measured
    value : (n,) displacement along them in mm
    sigma : (n,) its standard deviation in mm
    """

    face: Index
    uv: Array
    direction: Array
    value: Array
    sigma: Array


@dataclass(frozen=True)
class MeasuredPart:
    """The part through the points.

    Attributes
    ----------
    displacements : d(u, v) of every face, in mm over the face's own (u, v)
    sigma : of places on a face: ``(face, uv (n, 2)) -> (n,)`` standard deviation in mm, of the direction in which it is
        largest
    left : (n,) what the part leaves of every row, in mm
    """

    displacements: tuple[SplineSurface, ...]
    sigma: Callable[[int, Array], Array]
    left: Array


def register_points(part: JointPart, rows: MeasuredRows, surface: Array, settings: JointSettings | None = None
                    ) -> MeasuredPart:
    """The stiffest shape of a part through measured points.

    Parameters
    ----------
    part : the faces, edges and solids
    rows : what was measured
    surface : (n, 3) points all over the part, as far off it as it may have moved, in mm; they give lengths alone
    settings : weights of the priors

    Raises
    ------
    RefusedError : every face is frozen, or there is not enough memory
    """
    problem = make_problem(part, surface, settings or JointSettings(), {})
    places = places_on_faces(part.faces, problem.lattices, rows.face, rows.uv)
    state = start(problem)
    stage = replace(_SOFT, allowance=min(1.0, len(rows.value) / _SHAPES_OF_A_SCAN))
    for _ in range(_ITERATIONS):
        equations = _equations(problem, state, places, rows)
        step = FrontCholesky(problem.pattern.layout, equations.blocks).solve(equations.right.ravel())
        moved = state.control_points + step.reshape(-1, 3)
        state = replace(state, control_points=moved,
                        cache=replace(state.cache, matrices=ShapeMatrices.of(problem, moved)))
        state = update_prior_trust(problem, state, stage)
    left = rows.value - np.einsum("nx,nx->n", rows.direction, places.displacement(state.control_points))
    cost = prior_cost(problem, state) + float(((left / rows.sigma) ** 2).sum())
    wider = np.sqrt(max(1.0, cost / len(rows.value)))
    covariance = FrontCholesky(problem.pattern.layout, _equations(problem, state, places, rows).blocks).inverse_blocks()

    def sigma(face: int, uv: Array) -> Array:
        there = places_on_faces(part.faces, problem.lattices, np.full(len(uv), face), uv)
        blocks = problem.pattern.of_spans(covariance, there.span)
        at = np.einsum("ni,nj,nijxy->nxy", there.weights[0], there.weights[0], blocks, optimize=True)
        return np.asarray(wider * np.sqrt(np.maximum(np.linalg.eigvalsh(at)[:, -1], 0.0)))

    splines = tuple(problem.lattices.spline(face, state.control_points) for face in range(len(part.faces)))
    return MeasuredPart(splines, sigma, left)


def _equations(problem: Problem, state: State, places: FacePlaces, rows: MeasuredRows) -> NormalEquations:
    """All priors at the current shape, and the measured rows: direction · (B δ) = what is left of the value."""
    equations = prior_equations(problem, state, 1.0)
    order = np.argsort(places.span, kind="stable")
    spans, first = np.unique(places.span[order], return_index=True)
    basis, along, weight = places.weights[0], rows.direction, 1.0 / rows.sigma**2
    products = (weight[:, None, None] * basis[:, :, None] * basis[:, None, :])[order]
    for a, b in COMPONENTS:
        values = np.add.reduceat(products * (along[order, a] * along[order, b])[:, None, None], first)
        equations.add_products(a, b, values, spans)
    left = rows.value - np.einsum("nx,nx->n", along, places.displacement(state.control_points))
    pull = (weight * left)[:, None, None] * basis[:, :, None] * along[:, None, :]
    np.add(equations.right, problem.lattices.sum_of_loads(pull, places.span), out=equations.right)
    return equations
