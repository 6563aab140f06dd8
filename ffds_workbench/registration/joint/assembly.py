# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rows of the normal equations at the current shape: what the scan says, and what the shape resists."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..splines import Array
from .boundary import Borders
from .lattice import Index
from .problem import Problem
from .raster import Jet, normals
from .settings import Trust
from .values import CellValues


@dataclass(frozen=True)
class NormalEquations:
    """A δ = right on the pattern of the problem: ``blocks`` (size, 3, 3), ``right`` (controls, 3)."""

    blocks: Array
    right: Array

    def __add__(self, other: NormalEquations) -> NormalEquations:
        return NormalEquations(self.blocks + other.blocks, self.right + other.right)


def data_equations(problem: Problem, jet: Jet, values: CellValues) -> NormalEquations:
    """Point to plane: n·(B δ) = height in every cell (Eq. 3 of the paper, along the normal)."""
    shape = problem.cells.inside.shape
    normal = normals(jet, problem.cells.outward)[0]
    weight = values.weight.reshape(shape)
    used = np.flatnonzero(weight.any(axis=1))
    table = problem.cells.tables[0]
    normal, weight = normal[used], weight[used]
    products = (table[:, :, None] * table[:, None, :]).reshape(len(table), 256)
    blocks = np.zeros((problem.pattern.size, 3, 3))
    position = problem.pattern.span_position.reshape(-1, 256)[used].ravel()
    for a in range(3):
        for b in range(a, 3):
            value = (weight * normal[:, :, a] * normal[:, :, b]) @ products
            blocks[:, a, b] = np.bincount(position, weights=value.ravel(), minlength=problem.pattern.size)
            blocks[:, b, a] = blocks[:, a, b]
    pull = (weight * values.height.reshape(shape)[used])[:, :, None] * normal
    return NormalEquations(blocks, gather(problem, np.matmul(table.T, pull), used))


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


def shape_equations(problem: Problem, control_points: Array, bending: float, trust: Trust) -> NormalEquations:
    """All priors at the current shape with the trust they have; ``bending`` multiplies the weight of bending."""
    settings, stiffness = problem.settings, problem.stiffness
    weight = bending / (settings.curvature * settings.curvature_length) ** 2
    jet = stiffness.places.displaced(problem.lattices, control_points, 3)
    normal = normals(jet, stiffness.places.outward)[0]
    scalar = problem.coupled + trust.shear * problem.shear
    blocks = (scalar[:, None, None] * np.eye(3) + weight * problem.bending + problem.smooth
              + trust.dihedral * problem.dihedral + (trust.thickness - trust.shear) * problem.thickness)
    bent = evenly_bent(problem, control_points, normal) if bending == 1 else np.zeros((len(normal), 3))
    right = (weight * gather(problem, stiffness.bending_load(control_points, problem.lattices, normal, bent))
             + problem.couplings.thickness_load(control_points, trust.thickness, trust.shear)
             + problem.couplings.dihedral_load(control_points, trust.dihedral)
             - _apply(problem, problem.coupled, control_points))
    return NormalEquations(blocks, right) + _isometry(problem, control_points, normal, problem.isometry_weights(trust))


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


def _isometry(problem: Problem, control_points: Array, normal: Array, isometry: Array) -> NormalEquations:
    strain, rows = (of(problem.lattices, control_points, normal, problem.sheet_of_span)
                    for of in (problem.stiffness.strain, problem.stiffness.strain_rows))
    spans = len(rows)
    flat = rows.reshape(spans, -1, 48)
    weight = np.repeat(problem.stiffness.weight * isometry[:, None], 3, axis=1)[:, :, None]
    blocks = np.matmul((weight * flat).swapaxes(1, 2), flat).reshape(spans, 16, 3, 16, 3)
    values = np.empty((problem.pattern.size, 3, 3))
    for a in range(3):
        for b in range(3):
            values[:, a, b] = problem.pattern.from_spans(blocks[:, :, a, :, b])
    load = np.matmul(flat.swapaxes(1, 2), weight * strain.reshape(spans, -1, 1)).reshape(spans, 16, 3)
    return NormalEquations(values, -gather(problem, load))
