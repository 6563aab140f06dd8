# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of the normal equations at the current shape: what the scan says, and what the shape resists."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..splines import Array
from .boundary import Borders
from .lattice import Index, cubic
from .problem import Problem
from .raster import Jet, normals
from .settings import Trust
from .stiffness import COMPONENTS
from .values import CellValues


@dataclass(frozen=True)
class NormalEquations:
    """A δ = right on the pattern of the problem: ``blocks`` (size, 3, 3), ``right`` (controls, 3)."""

    blocks: Array
    right: Array

    def __iadd__(self, other: NormalEquations) -> NormalEquations:
        np.add(self.blocks, other.blocks, out=self.blocks)
        np.add(self.right, other.right, out=self.right)
        return self


def data_equations(problem: Problem, jet: Jet, values: CellValues) -> NormalEquations:
    """Point to plane: n·(B δ) = height in every cell (Eq. 3 of the paper, along the normal)."""
    shape = problem.cells.inside.shape
    normal = normals(jet, problem.cells.outward)[0]
    weight = values.weight.reshape(shape)
    used = np.flatnonzero(weight.any(axis=1))
    table = problem.cells.tables[0]
    normal, weight = normal[used], weight[used]
    blocks = np.empty((problem.pattern.size, 3, 3))
    for a, b in COMPONENTS:
        value = _table_products(problem, weight * normal[:, :, a] * normal[:, :, b])
        blocks[:, a, b] = problem.pattern.from_spans(value, used)
        if a != b:
            blocks[:, b, a] = blocks[:, a, b]
    pull = (weight * values.height.reshape(shape)[used])[:, :, None] * normal
    return NormalEquations(blocks, gather(problem, np.matmul(table.T, pull), used))


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


def border_equations(problem: Problem, borders: Borders) -> NormalEquations:
    """m·(B δ) = offset at the visible borders."""
    samples, m = borders.samples, borders.direction
    basis, weight = samples.weights[0], borders.weight[:, None, None]
    products = (weight * basis[:, :, None] * basis[:, None, :]).reshape(len(samples), 256)
    rows, columns = np.repeat(samples.controls, 16, axis=1).ravel(), np.tile(samples.controls, 16).ravel()
    position = problem.pattern.position(rows, columns)
    blocks = np.zeros((problem.pattern.size, 3, 3))
    for a in range(3):
        for b in range(3):
            value = (products * (m[:, a] * m[:, b])[:, None]).ravel()
            blocks[:, a, b] = np.bincount(position, weights=value, minlength=problem.pattern.size)
    right = np.zeros((problem.lattices.count, 3))
    pull = (borders.weight * borders.offset)[:, None, None] * basis[:, :, None] * m[:, None, :]
    np.add.at(right, samples.controls, pull)
    return NormalEquations(blocks, right)


def shape_equations(problem: Problem, control_points: Array, bending: float, trust: Trust,
                    strained: Array) -> NormalEquations:
    """All priors at the current shape with the trust they have; ``bending`` multiplies the weight of bending and
    ``strained`` is `strain_blocks`, which may be those of a shape near by: what is to be solved stays exact."""
    settings, stiffness = problem.settings, problem.stiffness
    weight = bending / (settings.curvature * settings.curvature_length) ** 2
    jet = stiffness.places.displaced(problem.lattices, control_points, 3)
    normal = normals(jet, stiffness.places.outward)[0]
    factors = np.array([1.0, weight, trust.shear, trust.thickness - trust.shear, trust.dihedral])
    blocks = (factors @ problem.constant.reshape(len(factors), -1)).reshape(-1, 3, 3)
    skin, wall = problem.isometry_weights(trust)
    blocks += skin * strained[0]
    blocks += wall * strained[1]
    bent = evenly_bent(problem, control_points, normal) if bending == 1 else np.zeros((len(normal), 3))
    right = (weight * gather(problem, stiffness.bending_load(control_points, problem.lattices, normal, bent))
             + problem.couplings.thickness_load(control_points, trust.thickness, trust.shear)
             + problem.couplings.dihedral_load(control_points, trust.dihedral)
             - _apply(problem, problem.coupled, control_points))
    strain = stiffness.strain(problem.lattices, control_points, normal, problem.sheet_of_span)
    stress = (np.where(problem.skin, skin, wall)[:, None] * stiffness.weight)[..., None] * strain
    right -= gather(problem, stiffness.strain_load(problem.lattices, control_points, normal, problem.sheet_of_span,
                                                   stress))
    return NormalEquations(blocks, right)


def strain_blocks(problem: Problem, control_points: Array) -> Array:
    """Normal matrices of the strain at the current shape, of the skins of sheets and of all other faces, without their
    weights: (2, size, 3, 3)."""
    stiffness = problem.stiffness
    normal = normals(stiffness.places.displaced(problem.lattices, control_points, 3), stiffness.places.outward)[0]
    rows = stiffness.strain_rows(problem.lattices, control_points, normal, problem.sheet_of_span)
    flat = rows.reshape(len(rows), -1, 48)
    weight = np.repeat(stiffness.weight, 3, axis=1)[:, :, None]
    blocks = np.matmul((weight * flat).swapaxes(1, 2), flat).reshape(-1, 16, 3, 16, 3)
    result = np.empty((2, problem.pattern.size, 3, 3))
    for number, spans in enumerate((np.flatnonzero(problem.skin), np.flatnonzero(~problem.skin))):
        own = blocks[spans]
        for a in range(3):
            for b in range(3):
                result[number, :, a, b] = problem.pattern.from_spans(own[:, :, a, :, b], spans)
    return result


def evenly_bent(problem: Problem, control_points: Array, normal: Array) -> Array:
    """Mean change of curvature of the face that a span belongs to: (spans, 3). A sheet rolled as a whole is smooth."""
    face, area = problem.lattices.face_of_span, problem.stiffness.area
    change = np.einsum("sk,skp->sp", area, problem.stiffness.curvature_change(problem.lattices, control_points, normal))
    whole = np.maximum(np.bincount(face, weights=area.sum(axis=1)), 1e-12)
    mean = np.stack([np.bincount(face, weights=change[:, p]) for p in range(3)], axis=1) / whole[:, None]
    return np.where(problem.skin[:, None], mean[face], 0.0)


def _apply(problem: Problem, scalar: Array, control_points: Array) -> Array:
    product = scalar[:, None] * control_points[problem.pattern.indices]
    return np.add.reduceat(product, problem.pattern.indptr[:-1], axis=0)

