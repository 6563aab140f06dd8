# SPDX-License-Identifier: LGPL-2.1-or-later
"""The curve of an edge in a face's (u, v): the one the shape stores, or on a plane the edge's exact projection.

Pcurves are what keeps a deformed face's boundary: they stay as they are while the surface under them changes. Some of
OCCT's curve types are allowed on analytic surfaces only; those become cubics here.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...errors import RefusedError
from ...registration.arrays import Array
from .curve_fit import fit_curve
from .curves import Conic, Curve, Line, Spline, mapped, print_curve, read_curve
from .instances import Chain, EdgeUse, Instances, Locations, inverse, product
from .records import BrepText, Curve3d, CurveOnSurface, EdgeCurves, FaceSurface

_PLANE_TOLERANCE = 5e-7
"""Largest change, in mm in a plane, of a pcurve that has to become a cubic (theory: a few times Open CASCADE's
precision)."""
_CIRCLE = "2"


@dataclass(frozen=True)
class Pcurve:
    """A pcurve as it goes into the new text.

    Attributes
    ----------
    curve : the curve in (u, v)
    first, last : the edge's range on it
    record : index from 1 of the stored record, or the text of a new one
    """

    curve: Curve
    first: float
    last: float
    record: int | str


@dataclass(frozen=True)
class UsedEdge:
    """An edge in a face: its pcurve, or a seam's two ('+' use first), and the surface's place seen from the edge."""

    edge: int
    pcurves: tuple[Pcurve, ...]
    continuity: str
    place: Chain


class PcurveReader:
    """Reads the pcurves of a BREP text, each record once."""

    def __init__(self, brep: BrepText, locations: Locations, instances: Instances) -> None:
        self._brep, self._locations, self._instances = brep, locations, instances
        self._read: dict[int, Curve] = {}

    def face_edges(self, face: int) -> list[UsedEdge]:
        """The edges of a face, each once, with the pcurves the face uses."""
        uses: dict[tuple[int, Chain], list[EdgeUse]] = {}
        for use in self._instances.face_uses[face]:
            uses.setdefault((use.edge, use.place), []).append(use)
        return [self._used_edge(face, group) for group in uses.values()]

    def _used_edge(self, face: int, group: list[EdgeUse]) -> UsedEdge:
        surface = self._brep.shapes[self._instances.faces[face].shape].geometry
        assert isinstance(surface, FaceSurface)
        edge, place = group[0].edge, product(inverse(group[0].place), self._locations.chain(surface.location))
        curves = self._edge_curves(edge)
        stored = next((item for item in curves.representations if isinstance(item, CurveOnSurface)
                       and item.surface == surface.surface and self._locations.chain(item.location) == place), None)
        if stored is None:
            return UsedEdge(edge, (self._projected(face, edge, surface, place),), "", place)
        orientations = {use.orientation for use in group}
        if len(stored.pcurves) == 1 or orientations == {"+", "-"}:
            chosen = stored.pcurves
        else:
            chosen = (stored.pcurves[1 if "-" in orientations else 0],)
        pcurves = tuple(self._stored(index, stored.first, stored.last) for index in chosen)
        return UsedEdge(edge, pcurves, stored.continuity, place)

    def _edge_curves(self, edge: int) -> EdgeCurves:
        curves = self._brep.shapes[self._instances.edges[edge].shape].geometry
        assert isinstance(curves, EdgeCurves)
        return curves

    def _stored(self, index: int, first: float, last: float) -> Pcurve:
        if index not in self._read:
            self._read[index] = read_curve(self._brep.curves_2d[index - 1], 2)
        curve = self._read[index]
        kind = self._brep.curves_2d[index - 1].split(maxsplit=1)[0]
        if kind in "167":
            return Pcurve(curve, first, last, index)
        return allowed(curve, first, last)

    def _projected(self, face: int, edge: int, surface: FaceSurface, place: Chain) -> Pcurve:
        tokens = self._brep.surfaces[surface.surface - 1].split()
        while tokens[0] == "10":
            tokens = tokens[5:]
        item = next((item for item in self._edge_curves(edge).representations if isinstance(item, Curve3d)), None)
        if tokens[0] != "1" or item is None:
            raise RefusedError(f"Edge{edge + 1} has no curve in the (u, v) of Face{face + 1}: repair the shape first.")
        numbers = np.array(tokens[1:], dtype=float)
        axes, origin = numbers[6:].reshape(2, 3), numbers[:3]
        # From the curve's own coordinates into the surface's.
        matrix = self._locations.matrix(product(inverse(place), self._locations.chain(item.location)))
        linear, shift = axes @ matrix[:3, :3], axes @ (matrix[:3, 3] - origin)
        curve = read_curve(self._brep.curves_3d[item.curve - 1], 3)
        if isinstance(curve, Line | Conic | Spline):
            return allowed(mapped(curve, linear, shift), item.first, item.last)
        return cubic(lambda t: curve(t) @ linear.T + shift, item.first, item.last, curve.breaks())


def allowed(curve: Curve, first: float, last: float) -> Pcurve:
    """The curve itself where a B-spline surface may carry it, else a cubic.

    Lines, circles and clamped splines may stay. A left-handed circle may not: STEP has none.
    """
    match curve:
        case Conic() if curve.kind != _CIRCLE or np.linalg.det([curve.axis_x, curve.axis_y]) <= 0:
            pass
        case Line() | Conic() | Spline(periodic=False):
            return Pcurve(curve, first, last, print_curve(curve))
    return cubic(curve, first, last, curve.breaks())


def cubic(f: Callable[[Array], Array], first: float, last: float, breaks: Array) -> Pcurve:
    """A cubic through a curve given as a function, (n,) parameters to (n, dim)."""
    curve = fit_curve(f, first, last, breaks, _PLANE_TOLERANCE)
    return Pcurve(curve, first, last, print_curve(curve))
