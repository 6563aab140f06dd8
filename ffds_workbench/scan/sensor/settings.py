# SPDX-License-Identifier: LGPL-2.1-or-later
"""The virtual sensor and its errors."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import InputError

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class View:
    """One shot: where the camera stands.

    Attributes
    ----------
    direction : from the part to the camera, any length but zero
    aim : the point in mm in the middle of the picture; None is the middle of the part's bounding box
    """

    direction: Vector
    aim: Vector | None = None


@dataclass(frozen=True)
class SensorSettings:
    """A scan to be simulated. Lengths in mm, angles in rad.

    Attributes
    ----------
    spacing : mean distance of the points: 1/spacing² points per mm², of the surface without views, else of the picture
    noise : standard deviation along the line of sight (along the surface normal without views)
    correlation : width of the Gaussian filter that correlates the noise; 0 is white noise
    correlated_share : share of the noise's variance that is correlated, where ``correlation`` is given
    views : the shots; without any, the whole surface is seen from everywhere
    field : width and height that a shot covers at the stand-off distance
    standoff : distance of the camera from the aim
    limit : largest number of points of a shot
    grazing : surfaces seen at less than this angle to the line of sight give no points
    edge_dropout : probability that a point beside a jump in depth is lost; without views, beside a face's boundary
    edge_band : width of that strip, in the picture or on the face
    holes, hole_radius : number of round gaps in the scan, and the range of their radii
    outliers : gross outliers as a share of the other points, uniform in the scan's box grown by ``outlier_margin``
    table : distance of a flat background behind the part, square to the first view (needs views); None: no background
    pose_error, pose_error_angle : standard deviations of each shot's shift and rotation, per axis, about the part's
        middle: the error with which several shots are put together
    seed : of the random numbers
    """

    spacing: float = 0.2
    noise: float = 0.13
    correlation: float = 0.0
    correlated_share: float = 1.0
    views: tuple[View, ...] = ()
    field: tuple[float, float] = (155.0, 118.0)
    standoff: float = 370.0
    limit: int = 360_000
    grazing: float = np.deg2rad(12.0)
    edge_dropout: float = 0.0
    edge_band: float = 1.0
    holes: int = 0
    hole_radius: tuple[float, float] = (3.0, 7.0)
    outliers: float = 0.0
    outlier_margin: float = 8.0
    table: float | None = None
    pose_error: float = 0.0
    pose_error_angle: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        if not np.isfinite([self.spacing, self.noise, self.correlation, self.pose_error, self.pose_error_angle]).all():
            raise InputError("Spacing, noise, correlation and pose error of a simulated scan are finite numbers.")
        if not self.spacing > 0:
            raise InputError(f"The spacing of a simulated scan must be positive, not {self.spacing:g} mm.")
        if min(self.noise, self.correlation, self.pose_error, self.pose_error_angle, self.edge_band, self.holes) < 0:
            raise InputError("Noise, correlation, holes, edge band and pose error of a scan cannot be negative.")
        for name, share in (("outliers", self.outliers), ("dropout", self.edge_dropout),
                            ("correlated share", self.correlated_share)):
            if not 0 <= share <= 1:
                raise InputError(f"The {name} of a simulated scan is a share between 0 and 1, not {share:g}.")
        if any(not (np.isfinite(view.direction).all() and np.linalg.norm(view.direction) > 0) for view in self.views):
            raise InputError("A view needs a direction from the part to the camera: 0,0,0 is none.")
        if self.table is not None and not self.views:
            raise InputError("A table is seen by a camera: name at least one view.")
