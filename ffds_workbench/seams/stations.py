# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stations of a seam, with what the robot and the welder need at each of them."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import RefusedError
from ..registration.arrays import Array
from . import frames
from .chains import Seam, Stretch
from .sampling import Places, sample
from .settings import SeamSettings
from .weldment import Weldment

_ASIDE = 0.2
"""Step in mm off an edge, along a face, that tells on which side the face lies."""


@dataclass(frozen=True)
class Stations:
    """A seam, sampled. All arrays have a row per station; a closed seam's last station is its first.

    Attributes
    ----------
    seam : the edges it runs along
    places : the stations on these edges
    positions : (n, 3) in mm
    tangents : (n, 3) unit travel directions
    n1, n2 : (n, 3) outward unit normals; n1 is the lower-numbered face's
    bisector : (n, 3, 3) frames whose approach halves the angle of the faces
    torch : (n, 3, 3) the frames to weld with: ``bisector``, leaning by the work and travel angles
    curvature : (n,) in 1/mm
    opening : (n,) angle in rad between the faces, through the air
    gap : (n,) distance in mm of the edge from the other part, negative where it is inside; NaN without another part
    work_angle : (n,) between the torch and the first face in rad; ``travel_angle``: of the settings, in rad
    """

    seam: Seam
    places: Places
    positions: Array
    tangents: Array
    n1: Array
    n2: Array
    bisector: Array
    torch: Array
    curvature: Array
    opening: Array
    gap: Array
    work_angle: Array
    travel_angle: float

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def length(self) -> float:
        """Of the seam in mm."""
        return float(self.places.arc_length[-1])


def stations(weldment: Weldment, seam: Seam, settings: SeamSettings) -> Stations:
    """Sample a seam.

    Raises
    ------
    RefusedError : an edge has no direction, or the faces no bisector
    """
    return stations_at(weldment, seam, sample(weldment, seam, settings.step, settings.chord), settings)


def stations_at(weldment: Weldment, seam: Seam, places: Places, settings: SeamSettings) -> Stations:
    """The stations of a seam at given places of its edges."""
    rows: list[list[Array]] = []
    for number, stretch in enumerate(seam.stretches):
        here = beside(weldment, stretch, places.fraction[places.stretch == number])
        between = frames.angle_between(here.n1, here.n2)
        opening = np.pi - between if _is_concave(weldment, stretch) else np.pi + between
        forwards = 1.0 if stretch.end > stretch.start else -1.0
        rows.append([here.positions, forwards * here.tangents, here.n1, here.n2, here.curvature, opening,
                     signed_gap(weldment, stretch.other, here.positions)])
    columns: list[Array] = [np.concatenate(column) for column in zip(*rows, strict=True)]
    positions, tangents, n1, n2, curvature, opening, gap = columns
    try:
        bisector = frames.torch_frames(tangents, n1, n2)
    except RefusedError as error:
        raise RefusedError(f"{seam.name}: {error}") from error
    torch = frames.leaning(bisector, settings.work_angle, settings.travel_angle)
    away = np.where(np.einsum("ij,ij->i", bisector[:, :, 1], n1) >= 0.0, 1.0, -1.0)
    return Stations(seam, places, positions, tangents, n1, n2, bisector, torch, curvature, opening, gap,
                    0.5 * opening + away * settings.work_angle, settings.travel_angle)


@dataclass(frozen=True)
class Beside:
    """Places on one edge: position, direction towards growing fractions, curvature, and the normals of two faces."""

    positions: Array
    tangents: Array
    curvature: Array
    n1: Array
    n2: Array


def beside(weldment: Weldment, stretch: Stretch, fractions: Array) -> Beside:
    """The edge of a stretch and the faces that it joins, at fractions (n,) of the edge."""
    curve = weldment.curve(stretch.edge, fractions)
    own = weldment.topology.edge_faces[stretch.edge]
    n1, n2 = (weldment.normals_beside(face, stretch.edge, fractions) if face in own
              else weldment.nearest((face,), curve.points).normals for face in stretch.faces)
    return Beside(curve.points, curve.tangents, curve.curvatures, n1, n2)


def _is_concave(weldment: Weldment, stretch: Stretch) -> bool:
    """Whether the faces open to the air by less than 180°: a joint of two parts does, an edge of one part may."""
    if stretch.other:
        return True
    middle = np.array([0.5 * (stretch.start + stretch.end)])
    point = weldment.curve(stretch.edge, middle).points[0]
    first, second = (weldment.normals_beside(face, stretch.edge, middle)[0] for face in stretch.faces)
    # Off the edge, in the plane of the second face: it lies where the first face's normal points only in a hollow edge.
    aside = first - (first @ second) * second
    length = np.linalg.norm(aside)
    if length < 1e-6:
        return False
    ahead, behind = weldment.nearest((stretch.faces[1],), point + _ASIDE / length * np.array([aside, -aside])).distances
    return bool(ahead < behind)


def signed_gap(weldment: Weldment, faces: tuple[int, ...], points: Array) -> Array:
    """Distance in mm of points (n, 3) from the nearest of the faces, negative behind it; NaN without faces."""
    if not faces:
        return np.full(len(points), np.nan)
    nearest = weldment.nearest(faces, points)
    outside = np.einsum("ij,ij->i", points - nearest.points, nearest.normals)
    return np.where(outside < 0.0, -nearest.distances, nearest.distances)
