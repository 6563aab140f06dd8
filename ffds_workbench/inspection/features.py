# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces and edges as inspection sees them: as-built points, the nominal shape below, and draws of their errors."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..registration.arrays import Array, Index

Heights = Callable[[Array], tuple[Array, Array]]
"""Points (n, 3) to signed distances (n,) from the nominal surface and its unit normals (n, 3) below them."""
Offsets = Callable[[Array], tuple[Array, Array]]
"""Points (n, 3) to vectors (n, 3) from the nominal curve across it, and its unit tangents (n, 3)."""


@dataclass(frozen=True)
class ErrorField:
    """What is known of the errors of a feature's points.

    Attributes
    ----------
    basis : (n, k) how k independent errors of standard deviation 1 move each point, in mm
    directions : (n, c, 3) unit directions along which they do: one on a face, its normal; two across an edge
    """

    basis: Array
    directions: Array

    def draws(self, count: int, random: np.random.Generator) -> Array:
        """Errors (count, n, 3) in mm."""
        shape = count, self.basis.shape[1], self.directions.shape[1]
        sizes = np.einsum("nk,dkc->dnc", self.basis, random.standard_normal(shape), optimize=True)
        return np.einsum("dnc,ncx->dnx", sizes, self.directions, optimize=True)

    @property
    def sigma(self) -> Array:
        """Standard deviation (n,) along each direction, in mm."""
        return np.asarray(np.sqrt((self.basis**2).sum(axis=1)))

    def part(self, rows: Index) -> ErrorField:
        """That of some points."""
        return ErrorField(self.basis[rows], self.directions[rows])


@dataclass(frozen=True)
class InspectedFeature:
    """A face or an edge.

    Attributes
    ----------
    name : "Face3"
    kind : "plane", "cylinder", "surface", "line", "circle" or "curve", of the nominal shape
    points : (n, 3) on the as-built one, in mm
    heights : of points over the nominal surface; None for edges
    offsets : of points from the nominal curve; None for faces
    place, axis : (3,) a nominal point, and the unit normal of a plane, the axis of a cylinder or circle, or the
        direction of a line
    radius : nominal, of cylinders and circles
    outward : +1 where the material is inside of a cylinder (a shaft), −1 where it is outside (a hole)
    sections : of a cylinder: indices of the points of each section across its axis
    errors : of the points
    view : (3,) unit direction from which a scanner sees it best
    normals : (n, 3) outward unit normals at the points, of an edge those of its first face
    even : so many of the points, the first ones, are spread evenly; the others are on the border, where extremes are
    """

    name: str
    kind: str
    points: Array
    heights: Heights | None
    offsets: Offsets | None
    place: Array
    axis: Array
    radius: float
    outward: int
    sections: tuple[Index, ...]
    errors: ErrorField
    view: Array
    normals: Array
    even: int

    @property
    def is_edge(self) -> bool:
        return self.offsets is not None

    def thinned(self, most: int) -> InspectedFeature:
        """At most so many of its points, at equal steps, and its sections thinned alike."""
        if self.sections:
            step = max(1, -(-sum(map(len, self.sections)) // most))
            kept = [section[:: min(step, max(1, len(section) // 8))] for section in self.sections]
            rows = np.unique(np.concatenate(kept))
            sections = tuple(np.searchsorted(rows, section) for section in kept)
        else:
            rows, sections = np.arange(0, len(self.points), max(1, -(-len(self.points) // most))), ()
        return replace(self, points=self.points[rows], errors=self.errors.part(rows), sections=sections,
                       normals=self.normals[rows], even=int((rows < self.even).sum()))


def no_errors(count: int) -> ErrorField:
    """Of points whose errors are not known, or none."""
    return ErrorField(np.zeros((count, 1)), np.zeros((count, 1, 3)))
