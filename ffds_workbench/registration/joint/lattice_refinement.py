# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finer lattices where the data ask for them: where the residuals of the cells are larger than the noise explains."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.linalg import lstsq

from ..arrays import Array
from ..splines import greville
from .problem import Problem
from .state import State, fresh_cache
from .surfaces import FaceLattice, cubic

_EXCESS_VARIANCE = 1.5
"""Ratio of the variance of patch means to that of noise alone, from which the spans of a face are divided."""
_LEAST_PATCHES = 8
_PATCHES_PER_SPAN = 2
"""Patches along a span: noise averages out over one, a shape that the lattice cannot follow does not."""
_FULL_PATCH = 0.3
_LARGEST_LATTICE = 6000
_SENSOR_NOISE_SHARE = 0.5


def faces_to_refine(problem: Problem, state: State) -> dict[int, int]:
    """Faces whose spans are to be halved, {face: 2}; empty where the lattice follows the scan down to its noise."""
    if problem.lattices.count > _LARGEST_LATTICE:
        return {}
    ratio, face = patch_ratios(problem, state)
    judged = [index for index in range(len(problem.part.faces)) if (face == index).sum() >= _LEAST_PATCHES]
    chosen = [index for index in judged
              if ratio[face == index].mean() > _EXCESS_VARIANCE + 2 * np.sqrt(2 / (face == index).sum())]
    # Where all faces ask, it is the sensor's noise that is smooth, not the shape that is rough.
    return {} if len(chosen) > _SENSOR_NOISE_SHARE * len(judged) else dict.fromkeys(chosen, 2)


def patch_ratios(problem: Problem, state: State) -> tuple[Array, Array]:
    """Squared mean residuals of patches of cells over their variance from noise, and the patches' faces: (n,) each."""
    per_span = int(np.sqrt(problem.cells.inside.shape[1]))
    size = max(1, per_span // _PATCHES_PER_SPAN)
    count = per_span // size
    spans = len(problem.lattices.controls)

    def summed(cells: Array) -> Array:
        grid = cells.reshape(spans, per_span, per_span)[:, : count * size, : count * size]
        return grid.reshape(spans, count, size, count, size).sum(axis=(2, 4))

    pull, weight = summed(state.values.height * state.values.weight), summed(state.values.weight)
    if not weight.any():
        return np.zeros(0), np.zeros(0)
    full = weight > _FULL_PATCH * np.median(weight[weight > 0])
    face = np.broadcast_to(problem.lattices.face_of_span[:, None, None], full.shape)
    return pull[full] ** 2 / weight[full], face[full]


def transfer(coarse: Problem, fine: Problem, state: State) -> State:
    """The same displacement on other lattices, fitted at the Greville points of each face."""
    control_points = np.zeros((fine.lattices.count, 3))
    for face, lattice in enumerate(fine.lattices.faces):
        own = coarse.lattices.spline(face, state.control_points)
        spline = fine.lattices.spline(face, control_points)
        u, v = _sites(greville(spline.knots_u), own.range[:2]), _sites(greville(spline.knots_v), own.range[2:])
        values = own.on_grid(u, v)
        for axis, sites in enumerate((u, v)):
            rows = _rows(lattice, axis, sites)
            values = np.moveaxis(np.tensordot(lstsq(rows, np.eye(len(sites)))[0], values, axes=(1, axis)), 0, axis)
        size = lattice.shape[0] * lattice.shape[1]
        control_points[lattice.first_control : lattice.first_control + size] = values.reshape(size, 3)
    cache = replace(fresh_cache(fine, control_points), near_edges=state.cache.near_edges)
    return replace(state, control_points=control_points, cache=cache)


def _sites(places: Array, bounds: tuple[float, float]) -> Array:
    """Interpolation sites within the bounds: some Greville abscissae of an unclamped lattice lie outside."""
    return np.unique(np.clip(np.concatenate([places, np.linspace(*bounds, len(places))]), *bounds))


def _rows(lattice: FaceLattice, axis: int, sites: Array) -> Array:
    """Dense basis of one direction at sites: (n, free control points)."""
    place = (sites - lattice.corner[axis]) / lattice.step[axis]
    span = np.clip(np.floor(place), 0, lattice.spans[axis] - 1).astype(int)
    rows = np.zeros((len(sites), lattice.shape[axis]))
    columns = (span[:, None] + np.arange(4)) % lattice.shape[axis]
    np.add.at(rows, (np.arange(len(sites))[:, None], columns), cubic(place - span))
    return rows
