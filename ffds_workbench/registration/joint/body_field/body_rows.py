# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the body implies about its faces: how they slide within themselves, and where unseen ones lie.

A scan shows only where a face lies along its normal. But a body deforms as a whole: its displacement is smooth in
space, and where faces have normals in many directions, their normal components together determine the others.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Index
from ...motions import apply, best_fit
from ..data import Borders, CellHeights
from ..linear import NormalEquations
from ..priors import COMPONENTS, PriorTrust, pose_weight
from ..problem import Problem
from ..surfaces import Jet, normals
from .kriging import FieldModel, Observations, Pose, condition, most_likely_model, overconfidence

_PATCHES_PER_SIDE = 4
"""Patches per direction of a span whose heights are averaged: small against what the field changes over (unit)."""
_LARGEST_SYSTEM = 1500
"""Number of random patches: a dense matrix of this size is factorised (unit: time)."""
_LEAST_PATCH_WEIGHT = 0.1
"""Patches with less than this of the usual weight are left out (unit)."""
_BORDER_STRIDE = 3
"""Only one border row in this many is used: neighbours are close and share their errors (unit)."""
_POSE_PLACES = 200
"""Number of places whose mean pose stays as the solve has it: a turn that nothing observes must not follow residual
errors (unit)."""
_STEPS_TO_SETTLE = 2
"""Number of steps after which the field is no longer renewed (unit)."""
_SHEET_SHARE = 0.2
"""Share of its weight that a row gets on a sheet: there, thickness and lengths say more than a smooth field, whose
errors at neighbouring spans are nearly the same (unit)."""
_NEGLIGIBLE_SHARE = 0.01
"""Share of a row's weight that is negligible (unit)."""


@dataclass(frozen=True)
class BodyRows:
    """Where the body field puts the middles of spans: Σ B d = displacement, with its precision.

    Attributes
    ----------
    model : of the field
    steps : that led to them
    spans : (n,)
    basis : (n, 16) basis functions at the places
    displacement : (n, 3) in mm
    precision : (n, 3, 3) in 1/mm²
    sheet : (n,) whether the span belongs to a sheet
    """

    model: FieldModel
    steps: int
    spans: Index
    basis: Array
    displacement: Array
    precision: Array
    sheet: NDArray[np.bool_]


def body_informs(problem: Problem, trust: PriorTrust) -> bool:
    """Whether the body's rows have any weight: those of isometric sheets have none.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    trust : in the priors
    """
    return bool((_weight_share(_is_sheet(problem, problem.part.solid_of_face), trust) > _NEGLIGIBLE_SHARE).any())


def body_rows(problem: Problem, control_points: Array, jet: Jet, values: CellHeights, borders: Borders,
              earlier: BodyRows | None) -> BodyRows:
    """Rows at the current shape ``jet`` of the cells, with control points (controls, 3) in mm and the scan's ``values``
    and ``borders`` there. Of an ``earlier`` step the model and the precision are kept, and after a few all of it.

    Parameters
    ----------
    problem : what stays the same while the solve runs
    control_points : (controls, 3) of the displacement in mm
    """
    if earlier is not None and earlier.steps == _STEPS_TO_SETTLE:
        return earlier
    seen, face = _observe(problem, control_points, jet, values, borders)
    cells, shape = problem.cells, problem.cells.inside.shape
    shown = values.weight.reshape(shape) > 0
    motion = best_fit(cells.nominal.position[shown], jet.position[shown])
    rigid = apply(motion, seen.place) - seen.place
    seen = replace(seen, value=seen.value - np.einsum("nx,nx->n", seen.direction, rigid))
    model = earlier.model if earlier else most_likely_model(seen)
    some = np.arange(0, len(seen.value), 1 + len(seen.value) // _POSE_PLACES)
    pose = Pose.of(seen.place[some], seen.body[some])
    information = len(problem.scan) / problem.lengths.start**2
    field = condition(model, seen, pose, 1 / pose_weight(problem.lengths, information))
    spans = np.flatnonzero(cells.inside.any(axis=1))
    middle = np.where(cells.inside[spans], ((cells.local - 0.5) ** 2).sum(axis=1), np.inf).argmin(axis=1)
    place = cells.nominal.position[spans, middle]
    body = problem.part.solid_of_face[problem.lattices.face_of_span[spans]]
    displacement = field.mean(place, body) + apply(motion, place) - place
    if earlier is not None:
        return replace(earlier, steps=earlier.steps + 1, displacement=displacement)
    covariance = field.covariance(place, body) + model.variance * model.noise * np.eye(3)
    covariance *= overconfidence(model, seen, face)
    return BodyRows(model, 1, spans, cells.tables[0][middle], displacement, np.linalg.inv(covariance),
                    _is_sheet(problem, body))


def add_body_rows(equations: NormalEquations, problem: Problem, control_points: Array, rows: BodyRows,
                  trust: PriorTrust) -> None:
    """Add the rows of the body at the current shape; sheets count as far as they are not isometric.

    Parameters
    ----------
    equations : that the rows are added to, in place
    problem : what stays the same while the solve runs
    control_points : (controls, 3) of the displacement in mm
    trust : in the priors
    """
    precision = _weight_share(rows.sheet, trust)[:, None, None] * rows.precision
    products = rows.basis[:, :, None] * rows.basis[:, None, :]
    for a, b in COMPONENTS:
        equations.add_products(a, b, precision[:, a, b, None, None] * products, rows.spans)
    now = np.einsum("nc,ncx->nx", rows.basis, control_points[problem.lattices.controls[rows.spans]])
    pull = np.einsum("nxy,ny->nx", precision, rows.displacement - now)
    load = problem.lattices.sum_of_loads(rows.basis[:, :, None] * pull[:, None, :], rows.spans)
    np.add(equations.right, load, out=equations.right)


def _is_sheet(problem: Problem, solid: Index) -> NDArray[np.bool_]:
    """Whether solids (n,) are sheets."""
    return np.asarray(problem.couplings.pairs.solid_thickness)[solid] > 0


def _weight_share(sheet: NDArray[np.bool_], trust: PriorTrust) -> Array:
    """Share of their weight that rows (n,) get, those of a ``sheet`` or others."""
    return np.where(sheet, _SHEET_SHARE * (1 - trust.isometry), 1.0)


def _observe(problem: Problem, control_points: Array, jet: Jet, values: CellHeights, borders: Borders
             ) -> tuple[Observations, Index]:
    """The displacement along the current normals, patch by patch, and across some of the visible borders; and their
    faces."""
    cells, shape = problem.cells, problem.cells.inside.shape
    weight = values.weight.reshape(shape)
    patch = (_PATCHES_PER_SIDE * cells.local).astype(int) @ (1, _PATCHES_PER_SIDE)
    member = (patch[:, None] == np.arange(_PATCHES_PER_SIDE**2)).astype(float)
    total = weight @ member
    height = ((weight * values.height.reshape(shape)) @ member) / np.maximum(total, 1e-12)
    usual = np.median(total[total > 0])
    span, part = np.nonzero(total > _LEAST_PATCH_WEIGHT * usual)
    rank = np.random.default_rng(problem.settings.seed).permutation(total.size).reshape(total.shape)[span, part]
    pick = np.argsort(rank)[:_LARGEST_SYSTEM]
    span, part = span[pick], part[pick]
    middle = np.stack([(weight * place) @ member for place in cells.local.T], axis=2)[span, part]
    away = ((cells.local - (middle / total[span, part, None])[:, None]) ** 2).sum(axis=2)
    cell = np.where(weight[span] > 0, away, np.inf).argmin(axis=1)
    nominal = cells.nominal.position[span, cell]
    normal = normals(jet, cells.outward)[0][span, cell]
    along = np.einsum("nx,nx->n", normal, jet.position[span, cell] - nominal) + height[span, part]
    body = problem.part.solid_of_face
    some = np.arange(0, len(borders.along), _BORDER_STRIDE)
    edge, out, across = borders.samples.take(some), borders.direction[some], borders.along[some]
    face = np.concatenate([problem.lattices.face_of_span[span], edge.face])
    return Observations(np.concatenate([nominal, edge.nominal[0]]), np.concatenate([normal, out]),
                        np.concatenate([body[problem.lattices.face_of_span[span]], body[edge.face]]),
                        np.concatenate([along, across]),
                        np.concatenate([usual / total[span, part], np.zeros(len(across))]),
                        np.concatenate([np.zeros(len(along)), 1 / borders.weight[some]])), face
