# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pose that fits the whole of a deformed part best: in the least squares between each place and its undeformed
place."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...arrays import Array
from ...motions import apply, best_fit
from ..model import Rims, Target, kept_with_target
from ..refine import ScanEnds, find_scan_ends, points_near_rims
from .deformation_match import match_undeformed
from .displacement_field import DisplacementField, DisplacementObservations, fit_displacement


def pose_of_deformed_part(target: Target, points: Array, normals: Array, reach: float, pool: Array, noise: float,
                          deformation: DisplacementField) -> tuple[Array, DisplacementField]:
    """Motion (4, 4) that brings a deformed part onto the nominal one best, over all of its surface alike, and the
    deformation that is left then.

    Distances from the faces alone leave a deformed sheet free to slide and turn in its own surface. Of the deformations
    that explain them and the places where the scan ends, the likeliest is undone. Once the part has moved as a whole,
    the scan is matched again: points far off had been assigned to wrong rims.

    Parameters
    ----------
    target : the nominal part
    points, normals : (n, 3) of the scan in model coordinates, normals outward
    reach : in mm
    pool : (m, 3) more points, which show where the scan ends
    noise : standard deviation of the points in mm
    deformation : that is known already
    """
    middles, area = surface_cells(target)
    pose = np.eye(4)
    for degree, rounds in target.settings.deformation.looks:
        scan = _Scan(apply(pose, points), normals @ pose[:3, :3].T, apply(pose, pool), noise)
        deformation = _fit_look(target, scan, reach, deformation.of_degree(degree), rounds)
        motion = best_fit(middles + deformation(middles), middles, area)
        pose, deformation = motion @ pose, deformation.moved(motion)
    return pose, deformation


@dataclass(frozen=True)
class _Scan:
    """See ``pose_of_deformed_part``."""

    points: Array
    normals: Array
    pool: Array
    noise: float


def _fit_look(target: Target, scan: _Scan, reach: float, deformation: DisplacementField,
              rounds: Sequence[tuple[int, float, float]]) -> DisplacementField:
    """The most likely deformation, given where the scan lies and where it ends, coarse to fine."""
    size, rims, settings = target.size, target.rims, target.settings.deformation
    straight = deformation.straightened(scan.points, deformation.straightened(scan.points, scan.points))
    near = deformation.straightened(scan.pool, scan.pool)
    row, entry = points_near_rims(rims, near, rounds[0][2] * size, _hidden_stretches(rims, straight, scan.normals))
    bent, border = scan.pool.take(row, axis=0), near.take(row, axis=0)
    for turn, (every, gate, end_reach) in enumerate(rounds):
        straight = deformation.straightened(scan.points, straight)
        found = match_undeformed(target, straight[::every], scan.normals[::every], reach)
        heights = found.heights(scan.points[::every], gate * size, settings.least_points)
        if heights is None:
            break
        spread = max(heights.spread, scan.noise)
        border = deformation.straightened(bent, border)
        ends = find_scan_ends(rims, border, entry, end_reach * size, scan.noise,
                              max(settings.on_face_sigmas * spread, 0.0 if turn else settings.first_on_face * size))
        at_ends = _end_observations(ends, deformation, spread, end_reach * size, settings.end_weight)
        deformation = fit_displacement(deformation, heights, at_ends, scan.noise)
    return deformation


def _hidden_stretches(rims: Rims, points: Array, normals: Array) -> NDArray[np.bool_]:
    """Which stretches of rim belong to the side of a sheet that the scan does not show; (m,)."""
    nearest = cKDTree(points, balanced_tree=False, compact_nodes=False).query(rims.middles)[1]
    return np.einsum("ni,ni->n", normals[nearest], rims.faces) < 0.0


def _end_observations(ends: ScanEnds, deformation: DisplacementField, spread: float, cutoff: float,
                      weight: float) -> DisplacementObservations | None:
    """The displacements that the scan's ends ask for, with that ``weight`` against heights; None if there are none."""
    if not len(ends.gap):
        return None
    moved = np.einsum("ni,ni->n", deformation(ends.places), ends.outwards)
    weights = weight * spread**2 * ends.weight
    return DisplacementObservations(ends.places, ends.outwards, moved + ends.gap, ends.gap, weights, cutoff)


@kept_with_target
def surface_cells(target: Target) -> tuple[Array, Array]:
    """Centroids (k, 3) in mm and areas (k,) in mm² of small pieces of the surface.

    A mean over them is exact for what is linear within a piece; one over points at random has the error of a random
    sample, which tilts a bent part by some tenths of a degree.
    """
    samples, seeds = target.samples, target.even.points[:target.settings.deformation.cells]
    cell = cKDTree(seeds).query(samples.points)[1]
    area: Array = np.bincount(cell, samples.area, len(seeds)).astype(float)
    held = area > 0.0
    sums = np.stack([np.bincount(cell, samples.area * samples.points[:, k], len(seeds)) for k in range(3)], axis=1)
    return sums[held] / area[held, None], area[held]
