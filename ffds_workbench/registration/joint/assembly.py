# SPDX-License-Identifier: LGPL-2.1-or-later
"""The objective, row by row: what the scan says, and what the shape resists, at the current shape.

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
the trusts are ratios of the expected cost of a prior to what it costs (`prior_trust.py`); the scale of Tukey's loss
only falls. Priors and data are in the same unit, so that the inverse of the normal matrix is the covariance.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import blas

from ..arrays import Array, Index
from .data import Borders, CellHeights
from .priors import COMPONENTS, PriorTrust
from .problem import Problem, ThicknessRows
from .surfaces import Jet, cubic, normals


@dataclass(frozen=True)
class NormalEquations:
    """A δ = right on the pattern of the problem: ``blocks`` (size, 3, 3), ``right`` (controls, 3)."""

    blocks: Array
    right: Array


def add_data(equations: NormalEquations, problem: Problem, jet: Jet, values: CellHeights) -> None:
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
        add_products(equations, problem, a, b, products, used)
    pull = (weight * values.height.reshape(shape)[used])[:, :, None] * normal
    np.add(equations.right, gather(problem, np.matmul(table.T, pull), used), out=equations.right)


def add_products(equations: NormalEquations, problem: Problem, a: int, b: int, products: Array, spans: Index) -> None:
    """Add products (n, 16, 16) of basis functions on spans (n,) to components ab and ba."""
    values = problem.pattern.from_spans(products, spans)
    equations.blocks[:, a, b] += values
    if a != b:
        equations.blocks[:, b, a] += values


def _table_products(problem: Problem, weight: Array) -> Array:
    """Σ_k weight_k N_i N_j over the cells of spans, (spans, k): (spans, 16, 16); direction by direction."""
    per_span = int(np.sqrt(weight.shape[1]))
    one = cubic(problem.cells.local[:per_span, 1])
    pairs = (one[:, :, None] * one[:, None, :]).reshape(per_span, 16)
    along = np.matmul(weight.reshape(len(weight), per_span, per_span), pairs)
    both = np.matmul(pairs.T, along).reshape(-1, 4, 4, 4, 4)
    return both.transpose(0, 1, 3, 2, 4)


def gather(problem: Problem, loads: Array, spans: Index | slice = slice(None)) -> Array:
    """Sum loads of spans (spans, 16, 3) over the control points: (controls, 3)."""
    controls = problem.lattices.controls[spans].ravel()
    flat = loads.reshape(-1, 3)
    count = problem.lattices.count
    return np.stack([np.bincount(controls, weights=flat[:, k], minlength=count) for k in range(3)], axis=1)


def add_borders(equations: NormalEquations, problem: Problem, control_points: Array, borders: Borders) -> None:
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
        add_products(equations, problem, a, b, values, spans)
    pull = (borders.weight * borders.offset(control_points))[:, None, None] * basis[:, :, None] * m[:, None, :]
    np.add(equations.right, gather(problem, pull, samples.span), out=equations.right)


def shape_equations(problem: Problem, control_points: Array, bending: float, trust: PriorTrust,
                    strained: Array, across: ThicknessRows) -> NormalEquations:
    """All priors at the current shape with the trust they have; ``bending`` multiplies the weight of bending.

    ``strained`` is `strain_blocks` and ``across`` tells along which normals thickness is measured; both may be those of
    a shape near by, the first without any change of what is solved.
    """
    settings, stiffness = problem.settings, problem.stiffness
    weight = bending / (settings.curvature * settings.curvature_length) ** 2
    jet = stiffness.places.displaced(problem.lattices, control_points, 3)
    normal = normals(jet, stiffness.places.outward)[0]
    blocks = problem.constant.weighted(weight, trust.sliding, trust.shear, trust.dihedral)
    _add_scaled(blocks, across.blocks, trust.thickness - trust.shear, 0, len(blocks))
    skin, wall = problem.isometry_weights(trust)
    for is_skin, first, last in problem.skin_runs:
        _add_scaled(blocks, strained, skin if is_skin else wall, first, last)
    bent = mean_curvature_change(problem, control_points, normal) if bending == 1 else np.zeros((len(normal), 3))
    load = stiffness.bending_load(control_points, problem.lattices, normal, bent, trust.sliding)
    right = (weight * gather(problem, load)
             + problem.couplings.thickness_load(control_points, trust.thickness, trust.shear, across.normal)
             + problem.couplings.dihedral_load(control_points, trust.dihedral)
             - problem.couplings.scalar @ control_points)
    strain = stiffness.strain(problem.lattices, control_points, normal, problem.sheet_of_span)
    stress = (np.where(problem.skin, skin, wall)[:, None] * stiffness.stretched)[..., None] * strain
    right -= gather(problem, stiffness.strain_load(problem.lattices, control_points, normal, problem.sheet_of_span,
                                                   stress))
    return NormalEquations(blocks, right)


def _add_scaled(blocks: Array, others: Array, scale: float, first: int, last: int) -> None:
    """Add a multiple of some of other blocks to blocks (n, 3, 3), in place: fresh memory would take longer."""
    blas.daxpy(others.ravel(), blocks.ravel(), n=9 * (last - first), a=scale, offx=9 * first, offy=9 * first)


def strain_blocks(problem: Problem, control_points: Array) -> Array:
    """Normal matrix of the strain at the current shape, without its weights: (size, 3, 3)."""
    stiffness = problem.stiffness
    normal = normals(stiffness.places.displaced(problem.lattices, control_points, 3), stiffness.places.outward)[0]
    rows = stiffness.strain_rows(problem.lattices, control_points, normal, problem.sheet_of_span)
    flat = rows.reshape(len(rows), -1, 48)
    weight = np.repeat(stiffness.stretched, 3, axis=1)[:, :, None]
    blocks = np.matmul((weight * flat).swapaxes(1, 2), flat).reshape(-1, 3, 16, 3, 16)
    result = np.empty((problem.pattern.size, 3, 3))
    for a, b in COMPONENTS:
        result[:, a, b] = problem.pattern.from_spans(blocks[:, a, :, b])
        if a != b:
            result[:, b, a] = problem.pattern.from_spans(blocks[:, b, :, a])
    return result


def mean_curvature_change(problem: Problem, control_points: Array, normal: Array) -> Array:
    """Mean change of curvature of the face that a span belongs to: (spans, 3). A sheet rolled as a whole is smooth."""
    face, area = problem.lattices.face_of_span, problem.stiffness.area
    change = np.einsum("sk,skp->sp", area, problem.stiffness.curvature_change(problem.lattices, control_points, normal))
    whole = np.maximum(np.bincount(face, weights=area.sum(axis=1)), 1e-12)
    mean = np.stack([np.bincount(face, weights=change[:, p]) for p in range(3)], axis=1) / whole[:, None]
    return np.where(problem.skin[:, None], mean[face], 0.0)
