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
from ..robust_weights import TUKEY_SIGMAS, robust_sigma, tukey
from ..scan_points import Sketch, thin, workers
from .deformation import DisplacementField, match_deformed, pose_of_deformed_part
from .model import Target, kept_with_target, nearest_field
from .refine import ScanEnds, find_scan_ends, gauss_newton, points_near_rims, refine


def polish(target: Target, sketch: Sketch, pose: Array, normals: Array,
           deformation: DisplacementField | None = None) -> tuple[Array, DisplacementField | None]:
    """Refines a pose on thousands of points.

    A part that is not deformed lies on its faces, and ends at its rims. For a deformed one the pose is the one that
    fits all of it best, not the part that deformed least: wide gates, and each point against the side that it shows. If
    the noise is large, the side is a guess and gross errors reach far: then no normals are used, and a closer gate.

    Parameters
    ----------
    target, sketch : the part, and even points of the scan
    pose : (4, 4), T_model_scan to start from
    normals : (n, 3) outward normals of the sketch in model coordinates
    deformation : if one is known already

    Returns
    -------
    pose : (4, 4)
    deformation : that is left, or None
    """
    settings, hiding = target.settings.polish, target.settings.evidence.hiding_noise
    if sketch.noise > hiding * target.size:
        gate = max(settings.rigid_gate * target.size, settings.on_face_sigmas * sketch.noise)
        return refine(target, sketch.pool[thin(sketch.pool, settings.rough_points)], pose, (2.0 * gate, gate), 15), None
    if not is_deformed(target, sketch, pose, normals):
        return _polish_rigid(target, sketch, pose), None
    return _polish_deformed(target, sketch, pose, normals, deformation)


def _polish_deformed(target: Target, sketch: Sketch, pose: Array, normals: Array,
                     deformation: DisplacementField | None) -> tuple[Array, DisplacementField]:
    """The pose that fits the whole of a deformed part best, and the deformation that remains.

    A large rotation means that the start and its matches were wrong: then this is repeated once.
    """
    settings = target.settings.polish
    reach, noise = settings.gate * target.size, max(sketch.noise, settings.least_noise * target.size)
    outward, some = normals @ pose[:3, :3], slice(None, None, max(1, len(normals) // settings.deformed_points))
    for _ in range(2):
        if deformation is None:
            facing = outward[some] @ pose[:3, :3].T
            deformation = match_deformed(target, apply(pose, sketch.points[some]), facing, reach,
                                         settings.first_rounds)[1]
        motion, found = pose_of_deformed_part(target, apply(pose, sketch.points), outward @ pose[:3, :3].T, reach,
                                              apply(pose, sketch.pool), noise, deformation)
        pose, deformation = motion @ pose, None
        if angle(motion, np.eye(4)) < settings.far_turn:
            break
    return pose, found


def is_deformed(target: Target, sketch: Sketch, pose: Array, normals: Array) -> bool:
    """Whether more than a fifth of the points of a ``sketch`` at a ``pose`` (4, 4) lie off the ``target``, with
    ``normals`` (n, 3) in the model's frame."""
    settings = target.settings.polish
    moved = apply(pose, sketch.points)
    distance, nearest = target.nearest(moved, normals, settings.gate * target.size)
    height = target.heights(moved, nearest)[0][np.isfinite(distance)]
    off = max(settings.deformed_height * target.size, settings.on_face_sigmas * sketch.noise)
    return not len(height) or bool(np.quantile(np.abs(height), 0.8) >= off)


def _polish_rigid(target: Target, sketch: Sketch, pose: Array) -> Array:
    """Least-squares pose of points on the faces and of the scan's ends on the rims, in two rounds."""
    settings = target.settings.polish
    few = sketch.points[:: 1 + len(sketch.points) // settings.first_points]
    pose = refine(target, few, pose, (settings.rigid_gate * target.size,), settings.steps)
    points = sketch.pool[_informative_points(target, apply(pose, sketch.pool), settings.height_points)]
    noise = max(sketch.noise, settings.least_noise * target.size)
    on_face = settings.on_face_sigmas * noise
    chosen, nearest = _on_one_face(target, apply(pose, points), on_face)
    points, near = points[chosen], sketch.scan[:: 1 + len(sketch.scan) // settings.end_points]
    for reach in settings.end_reaches:
        moved = apply(pose, near)
        row, entry = points_near_rims(target.rims, moved, reach * target.size)
        ends = find_scan_ends(target.rims, moved[row], entry, reach * target.size, noise, on_face)
        ends = replace(ends, weight=settings.end_weight * noise**2 * ends.weight)
        pose = _fit_pose(target, points, nearest, pose, ends)
    return pose


def _informative_points(target: Target, points: Array, count: int) -> NDArray[np.intp]:
    """Indices of at most ``count`` points, drawn more densely where the surface around them constrains the pose more.

    Their leverage in the least squares measures this: small faces at the ends of a part constrain directions that the
    large ones leave free, and few evenly drawn points lie on them. It is averaged over a patch much wider than the
    noise, as a choice by the point's own position would prefer points that noise has moved one way.

    Parameters
    ----------
    points : (n, 3) in model coordinates
    """
    field = nearest_field(target)
    nearest = field(points, None)
    normal = field.normals[nearest]
    arm = (points - target.centre) * (2.0 / target.size)
    row = twist_rows(arm, normal)
    inverse = np.linalg.inv(row.T @ row + target.settings.polish.free_lever * len(row) * np.eye(6))
    count_of = np.bincount(nearest, minlength=len(field.points))
    leverage = np.bincount(nearest, np.einsum("ni,ni->n", row @ inverse, row), len(count_of)) / np.maximum(count_of, 1)
    share = np.cumsum(leverage[_neighbourhoods(target)].mean(axis=1)[nearest])
    return np.flatnonzero(np.diff(np.floor(share * (count / share[-1])), prepend=0.0) > 0.0)


@kept_with_target
def _neighbourhoods(target: Target) -> NDArray[np.intp]:
    """Indices of the even samples around each even sample; (m, k)."""
    points, count = target.even.points, target.settings.polish.patch_samples
    return np.asarray(cKDTree(points).query(points, k=min(count, len(points)))[1]).reshape(len(points), -1)


def _on_one_face(target: Target, points: Array, margin: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The points that lie near one face alone, and the samples of it: beside an edge a point may be on either.

    Parameters
    ----------
    points : (n, 3) in model coordinates
    margin : in mm, height up to which a point may be on a face
    """
    settings = target.settings.polish
    distance, index = target.tree.query(points, k=settings.candidate_samples, workers=workers(points),
                                        distance_upper_bound=settings.rigid_gate * target.size)
    within = np.flatnonzero(np.isfinite(distance[:, 0]))
    index = np.where(np.isfinite(distance), index, index[:, :1])[within]
    height = np.abs(np.stack([target.heights(points[within], column)[0] for column in index.T], axis=1))
    nearest = index[np.arange(len(index)), height.argmin(axis=1)]
    doubtful = ((target.samples.face[index] != target.samples.face[nearest][:, None]) & (height < margin)).any(axis=1)
    return within[~doubtful], nearest[~doubtful]


def _fit_pose(target: Target, points: Array, nearest: NDArray[np.intp], pose: Array, ends: ScanEnds) -> Array:
    """Gauss-Newton steps with the matches as they are."""
    settings = target.settings.polish
    for _ in range(settings.steps):
        moved = apply(pose, points)
        height, normal = target.heights(moved, nearest)
        cutoff = TUKEY_SIGMAS * max(robust_sigma(height), 1e-6 * target.size)
        update = gauss_newton(np.concatenate([moved, ends.places]) - target.centre,
                              np.concatenate([normal, ends.outwards]), np.concatenate([height, ends.gap]),
                              np.concatenate([tukey(height, cutoff), ends.weight]), target.size)
        motion = twist_motion(update, target.centre)
        pose, ends = motion @ pose, ends.moved(motion)
        if np.abs(update[3:]).max() + 0.5 * target.size * np.abs(update[:3]).max() < settings.settled * target.size:
            break
    return pose
