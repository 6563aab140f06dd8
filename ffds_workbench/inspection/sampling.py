# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces and edges of an as-built model sampled, each with the nominal shape below it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import Part
from scipy.spatial import cKDTree

from ..brep.topology import points_on_edge
from ..brep.workpiece import Workpiece
from ..errors import InputError
from ..registration.arrays import Array, Index
from ..registration.face_geometry import FaceGeometry
from ..registration.uv_raster import Raster, make_raster
from .features import InspectedFeature, Heights, Offsets
from .fits import across, fit_line, fit_plane
from .known_errors import KnownErrors

_CELLS, _BORDER, _ON_EDGE = 4096, 600, 257
"""Places on a face, about its border and on an edge: a form error of a third of the face's length is met to a
thousandth of itself."""
_MOST_SECTIONS, _FEWEST_SECTION = 15, 8
_PLANE_WITHIN = 1e-6
"""What is plane or straight to this, in mm, is so: twice what a lattice may be off its surface, and less."""
_NEWTON = 6


@dataclass(frozen=True)
class PartPair:
    """A nominal part and the as-built one made of it, with what is known of the latter's errors.

    Raises
    ------
    InputError : they have not the same faces and edges
    """

    nominal: Workpiece
    built: Workpiece
    known: KnownErrors

    def __post_init__(self) -> None:
        for kind, a, b in (("faces", len(self.nominal.faces), len(self.built.faces)),
                           ("edges", len(self.nominal.edges), len(self.built.edges))):
            if a != b:
                raise InputError(f"The nominal model has {a} {kind} and the as-built one {b}: name the model that it "
                                 f"was made from.")

    def feature(self, name: str) -> tuple[InspectedFeature, Array]:
        """A face or an edge by its name, and its nominal points (n, 3) (InputError where there is none)."""
        if name.startswith("Edge"):
            number = name.removeprefix("Edge")
            if not number.isdigit() or not 1 <= int(number) <= len(self.nominal.edges):
                raise InputError(f"There is no {name}: the model has Edge1 to Edge{len(self.nominal.edges)}.")
            return self._edge(name, int(number) - 1)
        return self._face(name, self.nominal.index(name))

    def _face(self, name: str, index: int) -> tuple[InspectedFeature, Array]:
        geometry, nominal = self.built.geometry(index), self.nominal.geometry(index)
        raster = make_raster(geometry, _CELLS)
        grid = np.stack(np.meshgrid(raster.u, raster.v, indexing="ij"), axis=2).reshape(-1, 2)[raster.inside]
        uv = np.concatenate([grid, _border(geometry)])
        points = geometry.surface(uv)
        below = nominal.surface(uv)
        kind, place, axis, radius, heights = _nominal_shape(self.nominal.faces[index].own_surface, nominal, below)
        normals = heights(points)[1]
        outward = _outward(kind, nominal, place, axis)
        errors = self.known.of_face(name, uv, geometry.surface.range, points, normals)
        sections = _sections(raster, axis) if kind == "cylinder" else ()
        seen = normals.mean(axis=0)
        if np.linalg.norm(seen) < 0.1:  # all around: seen from across
            seen = normals[0]
        return InspectedFeature(name, kind, points, heights, None, place, axis, radius, outward, sections, errors,
                       seen / np.linalg.norm(seen), normals, len(grid)), below

    def _edge(self, name: str, index: int) -> tuple[InspectedFeature, Array]:
        fractions = np.linspace(0.0, 1.0, _ON_EDGE)
        below = points_on_edge(self.nominal.edges[index], fractions)
        points = points_on_edge(self.built.edges[index], fractions)
        kind, place, axis, radius, offsets = _nominal_curve(self.nominal.edges[index], below)
        tangents = offsets(points)[1]
        sides = np.stack([np.stack(across(tangent)) for tangent in tangents])
        errors = self.known.of_edge(name, fractions, sides)
        faces = self.nominal.topology.edge_faces[index]
        normals = _normals_on(self.nominal.geometry(faces[0]), below) if faces else sides[:, 0]
        seen = normals.mean(axis=0)
        return InspectedFeature(name, kind, points, None, offsets, place, axis, radius, 0, (), errors,
                       seen / max(float(np.linalg.norm(seen)), 1e-300), normals, len(points)), below


def _border(geometry: FaceGeometry) -> Array:
    """Parameters along the trims, about `_BORDER` of them, the corners among them."""
    found = []
    for trim in geometry.trims:
        steps = np.diff(np.vstack([trim, trim[:1]]), axis=0)
        between = max(1, _BORDER // len(trim))
        shares = np.arange(between) / between
        found.append((trim[:, None, :] + shares[:, None] * steps[:, None, :]).reshape(-1, 2))
    return np.concatenate(found)


def _nominal_shape(surface: Any, geometry: FaceGeometry, below: Array
                   ) -> tuple[str, Array, Array, float, Heights]:
    """Kind, place, axis, radius and heights of a nominal face."""
    if isinstance(surface, Part.Cylinder):
        place, axis, radius = np.array(tuple(surface.Center)), np.array(tuple(surface.Axis)), float(surface.Radius)
        place = place + ((below - place) @ axis).mean() * axis
        sign = _outward("cylinder", geometry, place, axis)

        def heights(points: Array) -> tuple[Array, Array]:
            flat = (points - place) - ((points - place) @ axis)[:, None] * axis
            distance = np.linalg.norm(flat, axis=1)
            return sign * (distance - radius), sign * flat / distance[:, None]

        return "cylinder", place, axis, radius, heights
    place, axis = fit_plane(below, _normals_on(geometry, below[:1])[0])
    if np.abs((below - place) @ axis).max() <= _PLANE_WITHIN:
        return "plane", place, axis, 0.0, lambda points: ((points - place) @ axis, np.tile(axis, (len(points), 1)))
    return "surface", place, axis, 0.0, lambda points: _foot_points(geometry, points)


def _outward(kind: str, geometry: FaceGeometry, place: Array, axis: Array) -> int:
    """+1 where the normal of a cylinder points away from its axis."""
    if kind != "cylinder":
        return 1
    raster = make_raster(geometry, 64)
    flat = raster.position - place
    flat = flat - (flat @ axis)[:, None] * axis
    return 1 if float(np.einsum("nx,nx->n", flat, raster.normal).mean()) > 0 else -1


def _sections(raster: Raster, axis: Array) -> tuple[Index, ...]:
    """Rows of the raster that run around an axis, as indices of the cells inside the trims."""
    height = (raster.position @ axis).reshape(raster.shape)
    around = 0 if np.ptp(height, axis=0).mean() < np.ptp(height, axis=1).mean() else 1
    number = np.full(len(raster.inside), -1, dtype=np.intp)
    number[raster.inside] = np.arange(int(raster.inside.sum()))
    rows = np.moveaxis(number.reshape(raster.shape), around, 1)
    found = [row[row >= 0] for row in rows]
    found = [row for row in found if len(row) >= _FEWEST_SECTION]
    kept = np.unique(np.linspace(0, len(found) - 1, min(len(found), _MOST_SECTIONS)).round().astype(int))
    return tuple(found[index] for index in kept) if found else ()


def _foot_points(geometry: FaceGeometry, points: Array) -> tuple[Array, Array]:
    """Heights (n,) over a surface and its outward normals (n, 3), by Newton's method from the nearest cell.

    Solved is (p − S) · S_u = (p − S) · S_v = 0 with the second derivatives.
    """
    surface = geometry.surface
    raster = make_raster(geometry, _CELLS)
    grid = np.stack(np.meshgrid(raster.u, raster.v, indexing="ij"), axis=2).reshape(-1, 2)
    uv = grid[cKDTree(raster.position).query(points)[1]]
    orders = {(a, b): surface.derivative(a, b) for a, b in ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2))}
    for _ in range(_NEWTON):
        off = points - surface(uv)
        at = {key: derivative(surface.inside(uv)) for key, derivative in orders.items()}
        s_u, s_v = at[1, 0], at[0, 1]
        g = np.stack([(off * s_u).sum(1), (off * s_v).sum(1)], axis=1)
        h11 = (s_u * s_u).sum(1) - (off * at[2, 0]).sum(1)
        h12 = (s_u * s_v).sum(1) - (off * at[1, 1]).sum(1)
        h22 = (s_v * s_v).sum(1) - (off * at[0, 2]).sum(1)
        determinant = h11 * h22 - h12**2
        determinant = np.where(np.abs(determinant) > 1e-300, determinant, 1e-300)
        step = np.stack([h22 * g[:, 0] - h12 * g[:, 1], h11 * g[:, 1] - h12 * g[:, 0]], axis=1) / determinant[:, None]
        uv = surface.inside(uv + step)
    normal = np.cross(orders[1, 0](uv), orders[0, 1](uv)) * geometry.outward
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    return ((points - surface(uv)) * normal).sum(1), normal


def _normals_on(geometry: FaceGeometry, points: Array) -> Array:
    return _foot_points(geometry, points)[1]


def _nominal_curve(edge: Part.Edge, below: Array) -> tuple[str, Array, Array, float, Offsets]:
    """Kind, place, axis, radius and offsets of a nominal edge."""
    curve = None if edge.Degenerated else edge.Curve
    if isinstance(curve, Part.Circle):
        centre, axis, radius = np.array(tuple(curve.Center)), np.array(tuple(curve.Axis)), float(curve.Radius)

        def of_circle(points: Array) -> tuple[Array, Array]:
            flat = (points - centre) - ((points - centre) @ axis)[:, None] * axis
            unit = flat / np.linalg.norm(flat, axis=1, keepdims=True)
            return points - centre - radius * unit, np.cross(axis, unit)

        return "circle", centre, axis, radius, of_circle
    place, direction = fit_line(below, below[-1] - below[0])
    flat = (below - place) - ((below - place) @ direction)[:, None] * direction
    if np.abs(flat).max() <= _PLANE_WITHIN:

        def of_line(points: Array) -> tuple[Array, Array]:
            off = points - place
            return off - (off @ direction)[:, None] * direction, np.tile(direction, (len(points), 1))

        return "line", place, direction, 0.0, of_line
    return "curve", place, direction, 0.0, lambda points: _on_curve(edge, points)


def _on_curve(edge: Part.Edge, points: Array) -> tuple[Array, Array]:
    """Vectors from the nearest points of a curve, and its unit tangents there; Open CASCADE projects."""
    curve, vector = edge.Curve, type(edge.Vertexes[0].Point)
    at = [curve.parameter(vector(*point)) for point in points.tolist()]
    nearest = np.array([tuple(curve.value(t)) for t in at])
    tangents = np.array([tuple(curve.tangent(t)[0]) for t in at])
    return points - nearest, tangents
