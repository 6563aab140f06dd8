# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finer lattices where the data require them: where the residuals of the cells are larger than the noise explains."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.linalg import lstsq
from scipy.spatial import cKDTree

from ..arrays import Array
from ..splines import cubic, greville
from .data import patch_sums
from .iteration import EdgeCache, ShapeMatrices, State, StepCache
from .problem import Problem
from .surfaces import FaceLattice

_MODEL_SHARE = 1 / 3
"""Share of the model's error in the variance of a patch's mean from which the spans of a face are divided
(calibrated: families of seeds from 1001 on)."""
_LEAST_PATCHES = 8
"""Patches that a face must have to be judged (theory: the variance of fewer is not known to a half, √(2/8))."""
_FULL_PATCH = 0.3
"""Of the usual weight, what a patch has to have to be judged (unit)."""
_LARGEST_LATTICE = 6000
"""Control points from which on no face is refined (unit: time)."""
_SENSOR_NOISE_SHARE = 0.5
"""Share of the faces: where more of them ask, the sensor's noise is smooth rather than the shape rough, unless points
share more of an error than they have noise of their own (unit)."""


def faces_to_refine(problem: Problem, state: State) -> dict[int, int]:
    """Faces whose spans are to be halved, {face: 2}; empty where the lattice follows the scan down to its noise."""
    if problem.lattices.count > _LARGEST_LATTICE:
        return {}
    scatter, faces = state.values.scatter, len(problem.part.faces)
    precision = patch_sums(state.values.weight.reshape(problem.distance.shape))
    if not precision.any():
        return {}
    full = precision > _FULL_PATCH * np.median(precision[precision > 0])
    face = np.broadcast_to(problem.lattices.face_of_span[:, None, None], full.shape)[full]
    count = np.bincount(face, minlength=faces)
    usual = np.bincount(face, precision[full], faces) / np.maximum(count, 1)
    judged = count >= _LEAST_PATCHES
    asks = judged & (usual * scatter.model**2 > _MODEL_SHARE) & (scatter.model > problem.lengths.model)
    if asks.sum() > _SENSOR_NOISE_SHARE * judged.sum():
        asks &= scatter.model > scatter.sensor
    return dict.fromkeys(np.flatnonzero(asks).tolist(), 2)


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
    cache = StepCache(ShapeMatrices.of(fine, control_points), edges=EdgeCache(state.cache.edges.near))
    outward = state.outward
    if outward is not None:  # more spans have a larger sample
        outward = outward[cKDTree(coarse.sample).query(fine.sample, workers=-1)[1]]
    return replace(state, control_points=control_points, cache=cache, outward=outward)


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
