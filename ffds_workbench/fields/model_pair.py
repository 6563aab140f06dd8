# SPDX-License-Identifier: LGPL-2.1-or-later
"""The field between two models of the same topology, taken at the same parameters of corresponding faces and edges."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import Part

from ..brep import topology
from ..brep.continuity import side_lengths
from ..brep.rebuilt_faces import spline_surface
from ..brep.workpiece import Workpiece, WorkpieceFace
from ..errors import InputError
from ..registration.arrays import Array
from ..registration.trims import inside_trims
from .field import VectorField

_SPACINGS_PER_SIZE = 60.0
"""Places along an edge or a side that is as long as the part is large, at first (unit: time)."""
_LEAST_LINES, _LARGEST_LINES = 5, 129
"""Fewest and most places along an edge or a side of a face (unit: time and memory)."""
_TOLD = 2e-5
"""Of the size of the part: a displacement that places half as dense tell to this needs none denser (unit:
far below the noise of scanners)."""
_ON_EDGE = 1e-3
"""How far from its own edge, over the size of the part, an as-built face may have that edge's parameters
(unit: above the tolerances of files)."""


@dataclass(frozen=True)
class _Places:
    """Places on a face before and after, (n, 3) each in mm."""

    before: Array
    after: Array


def field_between(nominal: Workpiece, built: Workpiece) -> VectorField:
    """How the nominal model moves into the as-built one.

    Raises
    ------
    InputError : the models have not the same faces, edges and vertices, or a face has other parameters
    """
    refuse_other_topology(nominal, built)
    size = nominal.shape.BoundBox.DiagonalLength
    parts = []
    for own, other in zip(nominal.faces, built.faces, strict=True):
        pair = FacePair(own, other, size)
        parts.append(_joined([pair.on_edges(nominal, built), pair.inside()]))
    numbers = np.repeat(np.arange(1, len(parts) + 1), [len(part.before) for part in parts])
    places = _joined(parts)
    return VectorField(places.before, places.after - places.before, faces=numbers)


def refuse_other_topology(nominal: Workpiece, built: Workpiece) -> None:
    """Refuse models that have not the same faces, edges and vertices (InputError)."""
    if nominal.topology == built.topology:
        return
    for kind in ("solids", "faces", "wires", "edges", "vertices"):
        counts = nominal.topology.counts[kind], built.topology.counts[kind]
        if counts[0] != counts[1]:
            raise InputError(f"The models have not the same topology: {counts[0]} and {counts[1]} {kind}; a field is "
                             f"taken between a model and what was made from it.")
    raise InputError("The models have as many faces, edges and vertices, put together in another way: a field is taken "
                     "between a model and what was made from it.")


class FacePair:
    """A face before and after; ``size`` is that of the part in mm."""

    def __init__(self, before: WorkpieceFace, after: WorkpieceFace, size: float) -> None:
        self.before, self.after, self.size = before, after, size
        surface = after.own_surface
        plain = isinstance(surface, Part.BSplineSurface) and not (
            surface.isURational() or surface.isVRational() or surface.isUPeriodic() or surface.isVPeriodic())
        self._spline = spline_surface(surface) if plain else None

    def _places(self, uv: Array) -> _Places:
        return _Places(self.before.at(uv), self.moved(uv))

    def moved(self, uv: Array) -> Array:
        """The as-built face at parameters (n, 2)."""
        if self._spline is None:
            return self.after.at(uv)
        u0, u1, v0, v1 = self._spline.range
        return self._spline(np.clip(uv, (u0, v0), (u1, v1)))

    def refuse_other_parameters(self, nominal: Workpiece, built: Workpiece) -> None:
        """Refuse a pair of faces that have the same parameters at different places. Raises as `on_edges` does."""
        self.on_edges(nominal, built)

    def on_edges(self, nominal: Workpiece, built: Workpiece) -> _Places:
        """Along all edges of the face, their ends included.

        Raises
        ------
        InputError : the as-built face has these parameters elsewhere
        """
        found = []
        for edge in nominal.topology.face_edges[self.before.index]:
            curve = nominal.edges[edge]
            count = 2 if curve.Degenerated else _lines(curve.Length, self.size)
            fractions = np.linspace(0.0, 1.0, count)
            there = topology.points_on_edge(built.edges[edge], fractions)
            for trace in topology.edge_traces(self.before.face, curve, fractions):
                places = self._places(trace.uv)
                off = np.linalg.norm(places.after - there, axis=1).max()
                if off > _ON_EDGE * self.size:
                    raise InputError(f"{self.before.name} has other parameters in the as-built model, {off:.3g} mm "
                                     f"off at Edge{edge + 1}: take one that FFDS made, or give a mesh of each.")
                found.append(places)
        return _joined(found)

    def inside(self) -> _Places:
        """Within the trims, on a grid that follows how much the displacement varies."""
        box = self.before.box
        counts = [_lines(side, self.size) for side in side_lengths(self.before)]
        while True:
            u = np.linspace(box.u0, box.u1, counts[0])
            v = np.linspace(box.v0, box.v1, counts[1])
            uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
            places = self._places(uv)
            moved = (places.after - places.before).reshape(len(u), len(v), 3)
            finer = [_refined(count, np.moveaxis(moved, axis, 0), _TOLD * self.size)
                     for axis, count in enumerate(counts)]
            if finer == counts:
                break
            counts = finer
        geometry = self.before.geometry
        low = geometry.surface.range
        within = inside_trims(geometry, np.clip(u, low[0], low[1]), np.clip(v, low[2], low[3])).ravel()
        return _Places(places.before[within], places.after[within])


def _lines(length: float, size: float) -> int:
    return int(np.clip(np.ceil(length / size * _SPACINGS_PER_SIZE) + 1, _LEAST_LINES, _LARGEST_LINES))


def _refined(count: int, moved: Array, tolerance: float) -> int:
    """Twice as many lines where cubics through every second one do not tell the others: moved (lines, n, 3)."""
    if count > _LARGEST_LINES // 2:
        return count
    if len(moved) < 9:
        return 2 * count - 1
    known = moved[::2]
    told = (9.0 * (known[1:-2] + known[2:-1]) - known[:-3] - known[3:]) / 16.0
    off = np.linalg.norm(told - moved[3:-2:2][: len(told)], axis=2).max()
    return 2 * count - 1 if off > tolerance else count


def _joined(parts: list[_Places]) -> _Places:
    none = [np.empty((0, 3))]
    return _Places(np.concatenate(none + [part.before for part in parts]),
                   np.concatenate(none + [part.after for part in parts]))
