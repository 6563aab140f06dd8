# SPDX-License-Identifier: LGPL-2.1-or-later
"""The objective, row by row: the data and the priors at the current shape.

Minimised over the control points is twice a negative log posterior, a sum of squares, each over its own variance:

======================= ============================================= ==============================================
row                     what is squared                               weight, 1/variance
======================= ============================================= ==============================================
cell of the scan        n·d − h, height h in mm of its Tukey mean      W/(σ² + N τ²) in 1/mm²: W points (robust
                                                                      weights) of N in the patch, σ the sensor's
                                                                      noise, τ the model's error (`data/scatter.py`)
visible border          m·d − offset, mm                              1/σ_b², and Huber's weight (`data/borders.py`)
bending                 ∫ (change of curvature)² dA, no unit           1/(κ₀ l)², no unit; times the stage's multiple
sliding                 the same within the surface                   0.3 of it × trust
isometry                ∫ (strain of the mid surface)² dA / size²,     1/(ε₀ l)² × trust on skins, l over the size of
                        no unit                                       the solid; less on walls
thickness, shear        d_back − d_front + t (n − n₀), mm,            1/σ_t² × trust, once per square of the thickness
                        along the normal and across it
dihedral                change of an edge's angle, rad                1/σ_a² × trust, one for all of an edge's length
edges, seams, poles     difference of d on both sides, mm             1/σ_e²
pose, contacts, frozen  d, or its difference, mm                      1/σ_p², or a share of the whole scan's weight
body                    d − kriging's mean, mm                        inverse of its covariance (`body_field`)
======================= ============================================= ==============================================

The variances σ² and τ² are estimated anew in every step, from differences of neighbours that the shape does not enter;
the trusts are ratios of a prior's expected cost to its actual one (`prior_trust.py`); the scale of Tukey's loss
only decreases. Priors and data are in the same unit, so that the inverse of the normal matrix is the covariance.
"""
from __future__ import annotations

from itertools import product

import numpy as np

from ...arrays import Array
from ...splines import cubic
from ..body_field import add_body_rows
from ..data import Borders, CellHeights
from ..linear import NormalEquations
from ..priors import COMPONENTS
from ..problem import Problem
from ..surfaces import Jet, normals
from .state import State


def add_observations(equations: NormalEquations, problem: Problem, state: State, jet: Jet) -> None:
    """Add all rows from the scan at the current shape ``jet`` of the cells, directly or by way of the body.

    Parameters
    ----------
    equations : that the rows are added to, in place
    problem : what stays the same while the solve runs
    state : where the solve stands
    """
    _add_heights(equations, problem, jet, state.values)
    if state.cache.edges.borders is not None:
        _add_borders(equations, problem, state.control_points, state.cache.edges.borders)
    if state.cache.body is not None:
        add_body_rows(equations, problem, state.control_points, state.cache.body, state.trust)


def _add_heights(equations: NormalEquations, problem: Problem, jet: Jet, values: CellHeights) -> None:
    """Add the rows of the scan, point to plane: n·(B δ) = height in every cell (Eq. 3 of the paper, along the
    normal)."""
    shape = problem.cells.inside.shape
    normal = normals(jet, problem.cells.outward)[0]
    weight = values.weight.reshape(shape)
    used = np.flatnonzero(weight.any(axis=1))
    table = problem.cells.tables[0]
    normal, weight = normal[used], weight[used]
    for a, b in COMPONENTS:
        products = _table_products(problem, weight * normal[:, :, a] * normal[:, :, b])
        equations.add_products(a, b, products, used)
    pull = (weight * values.height.reshape(shape)[used])[:, :, None] * normal
    np.add(equations.right, problem.lattices.sum_of_loads(np.matmul(table.T, pull), used), out=equations.right)


def _table_products(problem: Problem, weight: Array) -> Array:
    """Σ_k weight_k N_i N_j over the cells of spans, (spans, k): (spans, 16, 16); direction by direction."""
    per_span = int(np.sqrt(weight.shape[1]))
    one = cubic(problem.cells.local[:per_span, 1])
    pairs = (one[:, :, None] * one[:, None, :]).reshape(per_span, 16)
    along = np.matmul(weight.reshape(len(weight), per_span, per_span), pairs)
    both = np.matmul(pairs.T, along).reshape(-1, 4, 4, 4, 4)
    return both.transpose(0, 1, 3, 2, 4)


def _add_borders(equations: NormalEquations, problem: Problem, control_points: Array, borders: Borders) -> None:
    """Add m·(B δ) = offset at the visible borders."""
    samples, m = borders.samples, borders.direction
    order = np.argsort(samples.span, kind="stable")
    spans, first = np.unique(samples.span[order], return_index=True)
    if not len(spans):
        return
    basis = samples.weights[0]
    products = (borders.weight[:, None, None] * basis[:, :, None] * basis[:, None, :])[order]
    for a, b in COMPONENTS:
        values = np.add.reduceat(products * (m[order, a] * m[order, b])[:, None, None], first)
        equations.add_products(a, b, values, spans)
    pull = (borders.weight * borders.offset(control_points))[:, None, None] * basis[:, :, None] * m[:, None, :]
    np.add(equations.right, problem.lattices.sum_of_loads(pull, samples.span), out=equations.right)


def prior_equations(problem: Problem, state: State, bending: float) -> NormalEquations:
    """All priors at the current shape with the trust they have; ``bending`` multiplies the weight of bending.

    The cached matrices may be those of a shape near by, that of the strain without any change of what is solved.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    state : where the solve stands
    """
    settings, stiffness, trust, control_points = problem.settings, problem.stiffness, state.trust, state.control_points
    strained, across = state.cache.matrices.strain, state.cache.matrices.thickness
    weight = bending / (settings.curvature * settings.curvature_length) ** 2
    jet = stiffness.places.displaced(problem.lattices, control_points, 3)
    normal = normals(jet, stiffness.places.outward)[0]
    blocks = problem.constant.weighted(weight, trust.sliding, trust.shear, trust.dihedral)
    across.blocks.add_to(blocks, trust.thickness - trust.shear)
    skin, wall = problem.isometry_weights(trust)
    isometry = np.where(problem.skin_of_block, skin, wall)
    for a, b in product(range(3), repeat=2):
        blocks[a, b] += isometry * strained[a, b]
    bent = mean_curvature_change(problem, control_points, normal) if bending == 1 else np.zeros((len(normal), 3))
    load = stiffness.bending_load(control_points, problem.lattices, normal, bent, trust.sliding)
    right = (weight * problem.lattices.sum_of_loads(load)
             + problem.couplings.thickness_load(control_points, trust.thickness, trust.shear, across.normal)
             + problem.couplings.dihedral_load(control_points, trust.dihedral)
             - problem.couplings.scalar @ control_points)
    sheet = problem.sheet_of_span
    strain = stiffness.strain(problem.lattices, control_points, normal, sheet)
    stress = (np.where(problem.skin, skin, wall)[:, None] * stiffness.stretched)[..., None] * strain
    load = stiffness.strain_load(problem.lattices, control_points, normal, sheet, stress)
    right -= problem.lattices.sum_of_loads(load)
    return NormalEquations(problem.pattern, blocks, right)


def mean_curvature_change(problem: Problem, control_points: Array, normal: Array) -> Array:
    """Mean change of curvature of the face that a span belongs to: (spans, 3). A sheet rolled as a whole is smooth.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    control_points : (controls, 3) of the displacement in mm
    normal : (spans, k, 3) current one at the Gauss places
    """
    face, area = problem.lattices.face_of_span, problem.stiffness.area
    change = np.einsum("sk,skp->sp", area, problem.stiffness.curvature_change(problem.lattices, control_points, normal))
    whole = np.maximum(np.bincount(face, weights=area.sum(axis=1)), 1e-12)
    mean = np.stack([np.bincount(face, weights=change[:, p]) for p in range(3)], axis=1) / whole[:, None]
    return np.where(problem.skin[:, None], mean[face], 0.0)
