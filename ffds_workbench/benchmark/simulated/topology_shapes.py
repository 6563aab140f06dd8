# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shapes of the topology benchmark, FreeCAD's primitives and CAD files, and three ways to move them."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import Part
from FreeCAD import Placement, Rotation, Vector

from ...brep.face_displacement import FaceDisplacement
from ...brep.workpiece import Workpiece, WorkpieceFace
from ...registration.arrays import Array
from ...registration.splines import DEGREE, SplineSurface, clamped_knots, greville

_LATTICE = 8
_BUMP = 0.025, 2.0
_WARP = 0.02


def primitives() -> Iterator[tuple[str, Part.Shape]]:
    """Shapes that FreeCAD makes by itself, one of each kind of surface and of each awkward feature."""
    box = Part.makeBox(40, 30, 20)
    filleted = box.makeFillet(4.0, box.Edges)
    circle = Part.Wire(Part.makeCircle(10, Vector(0, 0, 0)))
    profile = Part.Face(Part.Wire(Part.makePolygon([Vector(10, 0, 0), Vector(25, 0, 0), Vector(20, 0, 12),
                                                    Vector(10, 0, 0)])))
    spline = Part.BSplineCurve()
    spline.interpolate([Vector(0, 0, 0), Vector(15, 8, 0), Vector(30, -4, 0), Vector(45, 5, 0)])
    yield "box", box
    yield "cylinder", Part.makeCylinder(10, 30)
    yield "cone with apex", Part.makeCone(12, 0, 25)
    yield "cone", Part.makeCone(12, 6, 25)
    yield "sphere", Part.makeSphere(15)
    yield "torus", Part.makeTorus(20, 5)
    yield "wedge", Part.makeWedge(0, 0, 0, 5, 5, 30, 20, 40, 20, 25)
    yield "prism", Part.Face(Part.makePolygon([Vector(15 * np.cos(a), 15 * np.sin(a), 0) for a in
                                               np.linspace(0, 2 * np.pi, 7)])).extrude(Vector(0, 0, 30))
    yield "filleted box", filleted
    yield "loft", Part.makeLoft([circle, Part.Wire(Part.makeCircle(16, Vector(0, 0, 15))),
                                 Part.Wire(Part.makeCircle(8, Vector(0, 0, 35)))], True)
    yield "extruded spline", Part.Face(Part.Wire([spline.toShape(), *Part.makePolygon(
        [Vector(45, 5, 0), Vector(45, 30, 0), Vector(0, 30, 0), Vector(0, 0, 0)]).Edges])).extrude(Vector(0, 0, 20))
    yield "revolution", profile.revolve(Vector(0, 0, 0), Vector(0, 0, 1), 270)
    yield "offset", filleted.Faces[0].makeOffsetShape(1.0, 1e-6, fill=True)
    yield "box with holes", box.cut(Part.makeCylinder(4, 20, Vector(12, 15, 0))).cut(
        Part.makeCylinder(6, 40, Vector(28, 15, -5)))
    yield "fused", box.fuse(Part.makeCylinder(8, 40, Vector(20, 15, 0)))
    turned = filleted.copy()
    turned.Placement = Placement(Vector(80, 5, 3), Rotation(Vector(1, 1, 0), 30))
    yield "placed twice", Part.makeCompound([filleted, turned])
    yield "mirrored", box.cut(Part.makeCylinder(4, 20, Vector(12, 15, 0))).mirror(Vector(-5, 0, 0), Vector(1, 0, 0))


def files(data: Path) -> list[tuple[str, Path]]:
    """The CAD files of a data folder, by name: real parts, the weld part and the nominals of the cases."""
    parts = sorted(path for path in (data / "parts").glob("*") if path.suffix in (".step", ".brep"))
    nominals = sorted(data.glob("*/nominal.step")) + sorted(data.glob("cases/*/nominal.step"))
    return [(path.stem, path) for path in parts] + [(path.parent.name, path) for path in nominals]


def busiest_and_middle(workpiece: Workpiece) -> tuple[int, int]:
    """The face with most edges, and the face in the middle of the list."""
    edges = [len(edges) for edges in workpiece.topology.face_edges]
    return int(np.argmax(edges)), len(edges) // 2


def identity(workpiece: Workpiece) -> dict[int, FaceDisplacement]:
    """Every face made anew, where it is."""
    return {face.index: FaceDisplacement(lambda uv, points: np.zeros_like(points)) for face in workpiece.faces}


def warp(workpiece: Workpiece) -> dict[int, FaceDisplacement]:
    """A smooth bend and twist of the whole, 2 % of its size."""
    box = workpiece.shape.BoundBox
    field = _waves(np.array(tuple(box.Center)), box.DiagonalLength, _WARP * box.DiagonalLength, 2.0)
    return {face.index: FaceDisplacement(lambda uv, points: field(points)) for face in workpiece.faces}


def bump(face: WorkpieceFace) -> SplineSurface:
    """A displacement of one face that does not vanish at its boundary: 8 × 8 control points on waves in space."""
    box = face.box
    (knots_u, sites_u), (knots_v, sites_v) = (_direction(box.u0, box.u1, box.closed_u),
                                              _direction(box.v0, box.v1, box.closed_v))
    points = face.on_grid(sites_u, sites_v)
    corners = points.reshape(-1, 3)
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    field = _waves(corners.mean(axis=0), size, min(_BUMP[0] * size, _BUMP[1]), 6.0)
    return SplineSurface(knots_u, knots_v, field(corners).reshape(points.shape),
                         periodic_u=box.closed_u, periodic_v=box.closed_v)


def _direction(start: float, end: float, closed: bool) -> tuple[Array, Array]:
    """Flat knots of 8 control points, and where on the face each belongs."""
    if not closed:
        knots = clamped_knots(start, end, _LATTICE)
        return knots, greville(knots)
    step = (end - start) / _LATTICE
    knots = start + step * np.arange(-DEGREE, _LATTICE + DEGREE + 1)
    return knots, start + np.mod(greville(knots) - start, end - start)


def _waves(centre: Array, size: float, amplitude: float, turns: float) -> Callable[[Array], Array]:
    """A smooth field in space, of the given amplitude: about ``turns`` radians over the size."""
    def field(points: Array) -> Array:
        x, y, z = (turns * (points - centre) / size).T
        waves = np.stack([np.sin(y + 0.5 * z + 0.4), np.cos(x - 0.7 * z), np.sin(x + 0.8 * y - 0.3)], axis=1)
        return amplitude / np.sqrt(3.0) * waves
    return field
