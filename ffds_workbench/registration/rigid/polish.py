# SPDX-License-Identifier: LGPL-2.1-or-later
"""The last word on a pose: thousands of points, the scan's ends along the rims, and what a deformed part asks for."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array
from ..motions import angle, apply, step, twist_rows
from ..parallel import workers
from ..robust_weights import tukey
from ..scan_sketch import Sketch, thin
from .deformation import STIFF, Deformation, match, settle
from .evidence import is_rough
from .model import Target, once_for_target
from .refine import Ends, beside, find_ends, gauss_newton, refine
from .search import field_of

_WIDE, _DEFORMED = 0.12, 0.002
"""Shares of the part's size: within which a point has its face, and that a fifth lie off a part that is deformed."""
_FAR = 0.07
"""Turn in rad from which the pose of a deformed part is looked for once more: what began so far off was matched
with wrong places."""
_FEW, _MATCHED = 500, 1_000
"""Points that a pose is brought nearer with, and about how many one of a deformed part."""
_POINTS, _ON_FACES, _LOOKED_AT = 2_500, 3_500, 60_000
"""Points for the pose of a rough scan; of a part that is not deformed, for heights, and for the ends."""
_REACHES, _ON_FACE = (0.01, 0.005), 3.0
"""How far off the ends of the scan may lie, as a share of the part's size, and height up to which a point is on a face,
in standard deviations of the noise."""
_ENDS = 0.25
"""What an end counts against a point on a face: it may lie outside the rim where a wall below it is seen askew."""
_LEAST_HELD = 1e-4
"""Mean square lever arm, in halves of the part's size, below which a freedom counts as free."""
_PATCH = 60
"""Of the even samples, some 2,500, so many are the surface around a point: a sixth of the part across."""
_CLOSE = 0.02
"""Gate for a part that is not deformed, as a share of its size."""
_APART = 3.0
"""In standard deviations of the noise: the height over a second face below which nobody can tell which face a point is
on."""
_FINEST = 5e-4
"""Least noise that is reckoned with, as a share of the part's size."""
_CUT = 4.0
_STEPS, _STILL = 4, 1e-5
"""Steps of a round, and the share of the part's size below which one ends it."""
_CANDIDATES = 3


def polish(target: Target, sketch: Sketch, pose: Array, normals: Array) -> Array:
    """The pose on thousands of points.

    A part that is not deformed lies on its faces, and ends at its rims. Of a deformed one the pose is wanted that fits
    all of it best, not where it deformed least: wide gates, and each point against the side that it shows. Where the
    noise is large the side is a guess, and gross errors reach far: no normals then, and a closer gate.

    Parameters
    ----------
    pose : (4, 4), T_model_scan to start from
    normals : (n, 3) outward normals of the sketch in model coordinates
    """
    if is_rough(target, sketch):
        gate = max(0.02 * target.size, 3.0 * sketch.noise)
        return refine(target, sketch.pool[thin(sketch.pool, _POINTS)], pose, (2.0 * gate, gate), 15)
    if not is_deformed(target, sketch, pose, normals):
        return polish_rigid(target, sketch, pose)
    return polish_deformed(target, sketch, pose, normals)[0]


def polish_deformed(target: Target, sketch: Sketch, pose: Array, normals: Array,
                    deformation: Deformation | None = None) -> tuple[Array, Deformation]:
    """The pose that fits all of a deformed part best, and the deformation that is left then; from one, if it is known.

    A pose that turns far began at a wrong place, as did the matches: then once more.
    """
    reach, noise = _WIDE * target.size, max(sketch.noise, _FINEST * target.size)
    outward, some = normals @ pose[:3, :3], slice(None, None, max(1, len(normals) // _MATCHED))
    for _ in range(2):
        if deformation is None:
            facing = outward[some] @ pose[:3, :3].T
            deformation = match(target, apply(pose, sketch.points[some]), facing, reach, STIFF)[1]
        motion, found = settle(target, apply(pose, sketch.points), outward @ pose[:3, :3].T, reach,
                               apply(pose, sketch.pool), noise, deformation)
        pose, deformation = motion @ pose, None
        if angle(motion, np.eye(4)) < _FAR:
            break
    return pose, found


def is_deformed(target: Target, sketch: Sketch, pose: Array, normals: Array) -> bool:
    """Whether more than a fifth of the points lie off the part, with normals (n, 3) in the model's frame."""
    moved = apply(pose, sketch.points)
    distance, nearest = target.nearest(moved, normals, _WIDE * target.size)
    height = target.heights(moved, nearest)[0][np.isfinite(distance)]
    return not len(height) or bool(np.quantile(np.abs(height), 0.8) >= max(_DEFORMED * target.size, 3.0 * sketch.noise))


def polish_rigid(target: Target, sketch: Sketch, pose: Array) -> Array:
    """Least-squares pose of points on the faces and of the scan's ends on the rims, in two rounds."""
    few = sketch.points[:: 1 + len(sketch.points) // _FEW]
    pose = refine(target, few, pose, (_CLOSE * target.size,), _STEPS)
    points = sketch.pool[_telling(target, apply(pose, sketch.pool), _ON_FACES)]
    noise = max(sketch.noise, _FINEST * target.size)
    chosen, nearest = _on_one_face(target, apply(pose, points), _APART * noise)
    points, near = points[chosen], sketch.scan[:: 1 + len(sketch.scan) // _LOOKED_AT]
    for reach in _REACHES:
        moved = apply(pose, near)
        row, entry = beside(target.rims, moved, reach * target.size)
        ends = find_ends(target.rims, moved[row], entry, reach * target.size, noise, _ON_FACE * noise)
        pose = _fit(target, points, nearest, pose, replace(ends, weight=_ENDS * noise**2 * ends.weight))
    return pose


def _telling(target: Target, points: Array, count: int) -> NDArray[np.intp]:
    """Indices of at most ``count`` points, the more the more the surface around them tells of the pose.

    Its leverage in the least squares says that: small faces at the ends of a part hold directions that the large ones
    leave free, and of points drawn evenly hardly any lie on them. The mean over a patch much wider than the noise is
    taken, as a choice by the own place of a point would prefer those that the noise has moved one way.

    Parameters
    ----------
    points : (n, 3) in model coordinates
    """
    field = field_of(target)
    nearest = field(points, None)
    normal = field.normals[nearest]
    arm = (points - target.centre) * (2.0 / target.size)
    row = twist_rows(arm, normal)
    inverse = np.linalg.inv(row.T @ row + _LEAST_HELD * len(row) * np.eye(6))
    count_of = np.bincount(nearest, minlength=len(field.points))
    leverage = np.bincount(nearest, np.einsum("ni,ni->n", row @ inverse, row), len(count_of)) / np.maximum(count_of, 1)
    share = np.cumsum(leverage[_patches(target)].mean(axis=1)[nearest])
    return np.flatnonzero(np.diff(np.floor(share * (count / share[-1])), prepend=0.0) > 0.0)


@once_for_target
def _patches(target: Target) -> NDArray[np.intp]:
    """The even samples around each of them; (m, k)."""
    points = target.even.points
    return np.asarray(cKDTree(points).query(points, k=min(_PATCH, len(points)))[1]).reshape(len(points), -1)


def _on_one_face(target: Target, points: Array, margin: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The points that lie near one face alone, and the samples of it: beside an edge a point may be on either.

    Parameters
    ----------
    points : (n, 3) in model coordinates
    margin : in mm, height up to which a point may be on a face
    """
    distance, index = target.tree.query(points, k=_CANDIDATES, distance_upper_bound=_CLOSE * target.size,
                                        workers=workers(points))
    within = np.flatnonzero(np.isfinite(distance[:, 0]))
    index = np.where(np.isfinite(distance), index, index[:, :1])[within]
    height = np.abs(np.stack([target.heights(points[within], column)[0] for column in index.T], axis=1))
    nearest = index[np.arange(len(index)), height.argmin(axis=1)]
    doubtful = ((target.samples.face[index] != target.samples.face[nearest][:, None]) & (height < margin)).any(axis=1)
    return within[~doubtful], nearest[~doubtful]


def _fit(target: Target, points: Array, nearest: NDArray[np.intp], pose: Array, ends: Ends) -> Array:
    """Gauss-Newton steps with the matches as they are."""
    for _ in range(_STEPS):
        moved = apply(pose, points)
        height, normal = target.heights(moved, nearest)
        cutoff = _CUT * max(1.4826 * float(np.median(np.abs(height))), 1e-6 * target.size)
        update = gauss_newton(np.concatenate([moved, ends.places]) - target.centre,
                              np.concatenate([normal, ends.outwards]), np.concatenate([height, ends.gap]),
                              np.concatenate([tukey(height, cutoff), ends.weight]), target.size)
        motion = step(update, target.centre)
        pose, ends = motion @ pose, ends.moved(motion)
        if np.abs(update[3:]).max() + 0.5 * target.size * np.abs(update[:3]).max() < _STILL * target.size:
            break
    return pose
