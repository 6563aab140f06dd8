# SPDX-License-Identifier: LGPL-2.1-or-later
"""The smooth deformation that a scan of the right part may show beyond its rigid pose."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..model import Target
from ..settings import Rounds
from .displacement_field import DisplacementField, DisplacementObservations, fit_displacement, no_displacement


@dataclass(frozen=True)
class Match:
    """Points of the scan matched with the part after a smooth deformation has been removed from them.

    Attributes
    ----------
    points : (n, 3) where the points lie without the deformation, model coordinates in mm
    distance : (n,) from the sample in mm, infinite where nothing within reach faces the same way
    nearest : (n,) index of the sample
    height, normal : (n,) in mm over the face, and (n, 3) of the face
    """

    points: Array
    distance: Array
    nearest: NDArray[np.intp]
    height: Array
    normal: Array

    def heights(self, points: Array, gate: float, least: int) -> DisplacementObservations | None:
        """The displacements that the heights imply, with the points (n, 3) as scanned; None if fewer than ``least``
        points are matched.

        Points are weighted by their remaining residual, within the gate in mm or the spread of all, if that is wider.
        """
        some = np.flatnonzero(np.isfinite(self.distance))
        if len(some) < least:
            return None
        left, normal = self.height[some], self.normal[some]
        wanted = left + np.einsum("ni,ni->n", normal, points[some] - self.points[some])
        return DisplacementObservations(self.points[some], normal, wanted, left, np.ones(len(some)), gate)


def match_undeformed(target: Target, points: Array, normals: Array, reach: float) -> Match:
    """Match points with outward normals (n, 3), in model coordinates and without the deformation, with the part."""
    distance, nearest = target.nearest(points, normals, reach)
    return Match(points, distance, nearest, *target.heights(points, nearest))


def match_deformed(target: Target, points: Array, normals: Array, reach: float, rounds: Rounds,
                   start: DisplacementField | None = None) -> tuple[Match, DisplacementField]:
    """Match points with the part; each round removes a smooth displacement fitted to the heights of the round before.

    Parameters
    ----------
    target : the nominal part
    points, normals : (n, 3) in model coordinates, normals outward
    reach : largest distance in mm
    rounds : gates as shares of the part's size, and degrees of the deformation
    start : what is known of the deformation
    """
    deformation = no_displacement(target) if start is None else start
    found = match_undeformed(target, points if start is None else deformation.straightened(points, points), normals,
                             reach)
    for gate, degree in rounds:
        heights = found.heights(points, gate * target.size, target.settings.deformation.least_points)
        if heights is None:
            break
        deformation = fit_displacement(deformation.of_degree(degree), heights)
        found = match_undeformed(target, deformation.straightened(points, found.points), normals, reach)
    return found, deformation
