# SPDX-License-Identifier: LGPL-2.1-or-later
"""The final refinement of a pose: on thousands of points and on the scan's ends along the rims, of a rigid part or of a
deformed one."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..arrays import Array
from ..motions import angle, apply, twist_motion, twist_rows
from ..parallel import workers
from ..robust_weights import robust_sigma, tukey
from ..scan_sketch import Sketch, thin
from .deformation import STIFF_DEFORMATION_ROUNDS, DisplacementField, match_deformed, pose_of_deformed_part
from .evidence import hides_sides
from .model import Target, kept_with_target, nearest_field
from .refine import ScanEnds, find_scan_ends, gauss_newton, points_near_rims, refine

_WIDE_GATE, _DEFORMED_HEIGHT = 0.12, 0.002
"""As shares of the part's size: the gate within which points are matched with faces, and the height that a fifth of the
points exceed where the part is deformed."""
_FAR_TURN = 0.07
"""If the pose of a deformed part turns by more than this (rad), it is computed once more, because the first matches
were made too far off."""
_FIRST_POINTS, _DEFORMED_POINTS = 500, 1_000
"""Number of points for the first steps, and about how many for those of a deformed part."""
_ROUGH_POINTS, _HEIGHT_POINTS, _END_POINTS = 2_500, 3_500, 60_000
"""Number of points for the pose of a noisy scan; of a rigid part, for the heights and for the scan's ends."""
_END_REACHES, _ON_FACE_SIGMAS = (0.01, 0.005), 3.0
"""How far from the rim the scan may end, as shares of the part's size, one for each round; and the height, in standard
deviations of the noise, up to which a point lies on a face."""
_END_WEIGHT = 0.25
"""Weight of an end of the scan relative to a point on a face: it may lie outside the rim where the wall below is seen
at a slant."""
_FREE_LEVER = 1e-4
"""Mean square lever arm, in halves of the part's size, below which nothing holds a degree of freedom."""
_PATCH_SAMPLES = 60
"""Number of even samples, of about 2,500, that make the surface around a point: it is a sixth of the part wide."""
_RIGID_GATE = 0.02
"""Gate for a rigid part, as a share of its size."""
_ONE_FACE_SIGMAS = 3.0
"""A point belongs to one face if its height over every other one is more than this many standard deviations of the
noise."""
_LEAST_NOISE = 5e-4
"""Lower bound of the noise, as a share of the part's size."""
_CUTOFF_SIGMAS = 4.0
_STEPS_PER_ROUND, _SETTLED_STEP = 4, 1e-5
"""Steps per round; and the step, as a share of the part's size, below which a round ends."""
_CANDIDATE_SAMPLES = 3


def polish(target: Target, sketch: Sketch, pose: Array, normals: Array) -> Array:
    """Refines a pose on thousands of points.

    A part that is not deformed lies on its faces, and ends at its rims. Of a deformed one the pose is wanted that fits
    all of it best, not where it deformed least: wide gates, and each point against the side that it shows. Where the
    noise is large the side is a guess, and gross errors reach far: no normals then, and a closer gate.

    Parameters
    ----------
    pose : (4, 4), T_model_scan to start from
    normals : (n, 3) outward normals of the sketch in model coordinates
    """
    if hides_sides(target, sketch):
        gate = max(0.02 * target.size, 3.0 * sketch.noise)
        return refine(target, sketch.pool[thin(sketch.pool, _ROUGH_POINTS)], pose, (2.0 * gate, gate), 15)
    if not is_deformed(target, sketch, pose, normals):
        return polish_rigid(target, sketch, pose)
    return polish_deformed(target, sketch, pose, normals)[0]


def polish_deformed(target: Target, sketch: Sketch, pose: Array, normals: Array,
                    deformation: DisplacementField | None = None) -> tuple[Array, DisplacementField]:
    """The pose that fits the whole of a deformed part best, and the deformation that remains; started from
    ``deformation`` if one is known.

    A pose that turns far began at a wrong place, as did the matches: then once more.
    """
    reach, noise = _WIDE_GATE * target.size, max(sketch.noise, _LEAST_NOISE * target.size)
    outward, some = normals @ pose[:3, :3], slice(None, None, max(1, len(normals) // _DEFORMED_POINTS))
    for _ in range(2):
        if deformation is None:
            facing = outward[some] @ pose[:3, :3].T
            deformation = match_deformed(target, apply(pose, sketch.points[some]), facing, reach,
                                         STIFF_DEFORMATION_ROUNDS)[1]
        motion, found = pose_of_deformed_part(target, apply(pose, sketch.points), outward @ pose[:3, :3].T, reach,
                                              apply(pose, sketch.pool), noise, deformation)
        pose, deformation = motion @ pose, None
        if angle(motion, np.eye(4)) < _FAR_TURN:
            break
    return pose, found


def is_deformed(target: Target, sketch: Sketch, pose: Array, normals: Array) -> bool:
    """Whether more than a fifth of the points lie off the part, with normals (n, 3) in the model's frame."""
    moved = apply(pose, sketch.points)
    distance, nearest = target.nearest(moved, normals, _WIDE_GATE * target.size)
    height = target.heights(moved, nearest)[0][np.isfinite(distance)]
    off = max(_DEFORMED_HEIGHT * target.size, 3.0 * sketch.noise)
    return not len(height) or bool(np.quantile(np.abs(height), 0.8) >= off)


def polish_rigid(target: Target, sketch: Sketch, pose: Array) -> Array:
    """Least-squares pose of points on the faces and of the scan's ends on the rims, in two rounds."""
    few = sketch.points[:: 1 + len(sketch.points) // _FIRST_POINTS]
    pose = refine(target, few, pose, (_RIGID_GATE * target.size,), _STEPS_PER_ROUND)
    points = sketch.pool[_informative_points(target, apply(pose, sketch.pool), _HEIGHT_POINTS)]
    noise = max(sketch.noise, _LEAST_NOISE * target.size)
    chosen, nearest = _on_one_face(target, apply(pose, points), _ONE_FACE_SIGMAS * noise)
    points, near = points[chosen], sketch.scan[:: 1 + len(sketch.scan) // _END_POINTS]
    for reach in _END_REACHES:
        moved = apply(pose, near)
        row, entry = points_near_rims(target.rims, moved, reach * target.size)
        ends = find_scan_ends(target.rims, moved[row], entry, reach * target.size, noise, _ON_FACE_SIGMAS * noise)
        pose = _fit_pose(target, points, nearest, pose, replace(ends, weight=_END_WEIGHT * noise**2 * ends.weight))
    return pose


def _informative_points(target: Target, points: Array, count: int) -> NDArray[np.intp]:
    """Indices of at most ``count`` points, drawn more densely where the surface around them constrains the pose more.

    Its leverage in the least squares says that: small faces at the ends of a part hold directions that the large ones
    leave free, and of points drawn evenly hardly any lie on them. The mean over a patch much wider than the noise is
    taken, as a choice by the own place of a point would prefer those that the noise has moved one way.

    Parameters
    ----------
    points : (n, 3) in model coordinates
    """
    field = nearest_field(target)
    nearest = field(points, None)
    normal = field.normals[nearest]
    arm = (points - target.centre) * (2.0 / target.size)
    row = twist_rows(arm, normal)
    inverse = np.linalg.inv(row.T @ row + _FREE_LEVER * len(row) * np.eye(6))
    count_of = np.bincount(nearest, minlength=len(field.points))
    leverage = np.bincount(nearest, np.einsum("ni,ni->n", row @ inverse, row), len(count_of)) / np.maximum(count_of, 1)
    share = np.cumsum(leverage[_neighbourhoods(target)].mean(axis=1)[nearest])
    return np.flatnonzero(np.diff(np.floor(share * (count / share[-1])), prepend=0.0) > 0.0)


@kept_with_target
def _neighbourhoods(target: Target) -> NDArray[np.intp]:
    """Indices of the even samples around each even sample; (m, k)."""
    points = target.even.points
    return np.asarray(cKDTree(points).query(points, k=min(_PATCH_SAMPLES, len(points)))[1]).reshape(len(points), -1)


def _on_one_face(target: Target, points: Array, margin: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The points that lie near one face alone, and the samples of it: beside an edge a point may be on either.

    Parameters
    ----------
    points : (n, 3) in model coordinates
    margin : in mm, height up to which a point may be on a face
    """
    distance, index = target.tree.query(points, k=_CANDIDATE_SAMPLES, distance_upper_bound=_RIGID_GATE * target.size,
                                        workers=workers(points))
    within = np.flatnonzero(np.isfinite(distance[:, 0]))
    index = np.where(np.isfinite(distance), index, index[:, :1])[within]
    height = np.abs(np.stack([target.heights(points[within], column)[0] for column in index.T], axis=1))
    nearest = index[np.arange(len(index)), height.argmin(axis=1)]
    doubtful = ((target.samples.face[index] != target.samples.face[nearest][:, None]) & (height < margin)).any(axis=1)
    return within[~doubtful], nearest[~doubtful]


def _fit_pose(target: Target, points: Array, nearest: NDArray[np.intp], pose: Array, ends: ScanEnds) -> Array:
    """Gauss-Newton steps with the matches as they are."""
    for _ in range(_STEPS_PER_ROUND):
        moved = apply(pose, points)
        height, normal = target.heights(moved, nearest)
        cutoff = _CUTOFF_SIGMAS * max(robust_sigma(height), 1e-6 * target.size)
        update = gauss_newton(np.concatenate([moved, ends.places]) - target.centre,
                              np.concatenate([normal, ends.outwards]), np.concatenate([height, ends.gap]),
                              np.concatenate([tukey(height, cutoff), ends.weight]), target.size)
        motion = twist_motion(update, target.centre)
        pose, ends = motion @ pose, ends.moved(motion)
        if np.abs(update[3:]).max() + 0.5 * target.size * np.abs(update[:3]).max() < _SETTLED_STEP * target.size:
            break
    return pose
