# SPDX-License-Identifier: LGPL-2.1-or-later
"""Families of parts with sizes drawn at random: what the accuracy of a whole part is measured on."""
from __future__ import annotations

from dataclasses import dataclass

import FreeCAD
import numpy as np
import Part
from FreeCAD import Vector

from .profile import Array, Piece, Profile


@dataclass(frozen=True)
class FamilyPart:
    """A part of a family.

    Attributes
    ----------
    shape : the nominal model
    thickness : in mm, if the part is a sheet
    profile : the sheet's cross-section in (x, z), if it is bent; ``held``: the piece of it that springback leaves
    views : directions to cameras that together see most of it, (k, 3)
    """

    shape: Part.Shape
    views: Array
    thickness: float | None = None
    profile: Profile | None = None
    held: int = 0


def bracket(rng: np.random.Generator) -> FamilyPart:
    """An L-shaped sheet: one bend, two holes in one leg and one in the other."""
    thickness, radius = rng.uniform(2.0, 3.5), rng.uniform(4.0, 8.0)
    width = rng.uniform(55, 80)
    legs = rng.uniform(35, 55, 2)
    turn = np.deg2rad(rng.uniform(80, 100))
    profile = Profile((Piece(legs[0]), Piece(radius * turn, turn), Piece(legs[1])), thickness)
    shape = _extruded(profile, width)
    pair = [(0.45 * legs[0], 0.25 * width), (0.45 * legs[0], 0.75 * width)]
    shape = _drill(shape, profile, 0, pair, rng.uniform(3, 5))
    shape = _drill(shape, profile, 2, [(0.6 * legs[1], 0.5 * width)], rng.uniform(4, 7))
    return FamilyPart(shape, np.array([[-0.55, 0.2, 0.85], [-0.8, -0.35, -0.55]]), thickness, profile, 0)


def hat_channel(rng: np.random.Generator) -> FamilyPart:
    """A sheet with four bends, slots in the flanges and holes in the web."""
    thickness, radius = rng.uniform(1.8, 2.8), rng.uniform(4.0, 6.0)
    width = rng.uniform(90, 125)
    flange, wall, web = rng.uniform(14, 20), rng.uniform(18, 30), rng.uniform(26, 38)
    turn = np.deg2rad(rng.uniform(75, 88))
    arc = radius * turn
    pieces = (Piece(flange), Piece(arc, turn), Piece(wall), Piece(arc, -turn), Piece(web), Piece(arc, -turn),
              Piece(wall), Piece(arc, turn), Piece(flange))
    profile = Profile(pieces, thickness)
    shape = _extruded(profile, width)
    for piece in (0, 8):
        shape = _slot(shape, profile, piece, (0.5 * flange, rng.uniform(0.3, 0.7) * width), 2.5, 10.0)
    shape = _drill(shape, profile, 4, [(0.5 * web, 0.3 * width), (0.5 * web, 0.7 * width)], rng.uniform(3, 6))
    return FamilyPart(shape, np.array([[0.1, 0.15, 1.0], [-0.85, 0.3, 0.6], [0.8, -0.35, 0.6]]), thickness, profile, 4)


def rimmed_plate(rng: np.random.Generator) -> FamilyPart:
    """A flat plate with rounded corners, a rounded upper rim and holes."""
    thickness = rng.uniform(2.5, 4.0)
    a, b, corner = rng.uniform(60, 85), rng.uniform(60, 90), rng.uniform(6, 12)
    plate = Part.makeBox(a, b, thickness, Vector(-a / 2, -b / 2, -thickness / 2))
    plate = plate.makeFillet(corner, [e for e in plate.Edges if abs(e.tangentAt(e.FirstParameter).z) > 0.9])
    top = [e for e in plate.Edges if min(v.Z for v in e.Vertexes) > 0.4 * thickness]
    plate = plate.makeFillet(rng.uniform(0.35, 0.5) * thickness, top)
    for x, y in ((-0.25, 0.2), (0.2, -0.25)):
        drill = Part.makeCylinder(rng.uniform(4, 9), 3 * thickness, Vector(x * a, y * b, -1.5 * thickness))
        plate = plate.cut(drill)
    return FamilyPart(plate.Solids[0], np.array([[0.1, 0.15, 1.0], [-0.7, 0.3, 0.65]]), thickness)


def free_form_panel(rng: np.random.Generator) -> FamilyPart:
    """A lofted sheet between three curved sections."""
    thickness, a, b = rng.uniform(1.8, 3.0), rng.uniform(70, 95), rng.uniform(90, 125)
    rises = rng.uniform(4, 14, 3)
    wires = []
    for y, rise in zip((0.0, 0.5 * b, b), rises, strict=True):
        x = np.linspace(-a / 2, a / 2, 7)
        z = rise * (1 - (2 * x / a) ** 2) + 0.15 * rise * np.sin(3 * np.pi * x / a)
        lower, upper = _spline(x, y, z - thickness / 2), _spline(x, y, z + thickness / 2)
        sides = [Part.makeLine(lower.valueAt(lower.LastParameter), upper.valueAt(upper.LastParameter)),
                 Part.makeLine(upper.valueAt(upper.FirstParameter), lower.valueAt(lower.FirstParameter))]
        wires.append(Part.Wire([lower, sides[0], upper.reversed(), sides[1]]))
    return FamilyPart(Part.makeLoft(wires, True), np.array([[0.1, 0.15, 1.0], [-0.6, -0.45, 0.7]]))


def pipe_on_plate(rng: np.random.Generator) -> FamilyPart:
    """A pipe stub with a saddle cut that stands on a part of a thick tube: two solids."""
    tube, wall, length = rng.uniform(45, 65), rng.uniform(3, 5), rng.uniform(75, 95)
    half = rng.uniform(32, 37)
    ring = Part.makeCylinder(tube + wall, length).cut(Part.makeCylinder(tube, length))
    ring.Placement = FreeCAD.Placement(Vector(0, length, 0), FreeCAD.Rotation(Vector(1, 0, 0), 90))
    plate = ring.common(Part.makeBox(2 * half, length, 2 * tube, Vector(-half, 0, 0))).Solids[0]
    radius, bore = rng.uniform(14, 19), rng.uniform(2, 4)
    top = tube + wall + rng.uniform(20, 32)
    stub = Part.makeCylinder(radius, top, Vector(0, length / 2, 0)).cut(
        Part.makeCylinder(radius - bore, top, Vector(0, length / 2, 0)))
    saddle = Part.makeCylinder(tube + wall, 3 * length, Vector(0, 2 * length, 0), Vector(0, -1, 0))
    stub = stub.cut(saddle).Solids[0]
    shape = Part.makeCompound([plate, stub])
    return FamilyPart(shape, np.array([[0.2, -0.7, 0.75], [-0.75, 0.35, 0.6], [0.75, 0.45, 0.55]]))


def turned_part(rng: np.random.Generator) -> FamilyPart:
    """A flange with a torus fillet, a cone and a sphere on top: one revolution."""
    flange, height = rng.uniform(35, 45), rng.uniform(6, 10)
    fillet, low = rng.uniform(4, 7), rng.uniform(20, 26)
    slope = np.deg2rad(rng.uniform(62, 75))
    rise = rng.uniform(14, 24)
    c, s = np.cos(slope), np.sin(slope)
    # the fillet is tangent to the flange's top and to the cone
    start = (low + fillet, height)
    centre = np.array([start[0], height + fillet])
    end = centre - fillet * np.array([s, c])
    middle = centre - fillet * np.array([np.sin(slope / 2), np.cos(slope / 2)])
    up = end + rise * np.array([-c, s])
    sphere = up[0] / s
    ball = up[1] - sphere * c
    crown = (sphere * np.sin(slope / 2), ball + sphere * np.cos(slope / 2))
    at = [Vector(x, 0, z) for x, z in ((0, 0), (flange, 0), (flange, height), start, middle, end, up, crown,
                                       (0, ball + sphere))]
    wire = Part.Wire([Part.makeLine(at[0], at[1]), Part.makeLine(at[1], at[2]), Part.makeLine(at[2], at[3]),
                      Part.Arc(at[3], at[4], at[5]).toShape(), Part.makeLine(at[5], at[6]),
                      Part.Arc(at[6], at[7], at[8]).toShape(), Part.makeLine(at[8], at[0])])
    solid = Part.Face(wire).revolve(Vector(), Vector(0, 0, 1), 360)
    hole = Part.makeCylinder(rng.uniform(2, 3), 3 * height, Vector(0.5 * (flange + start[0]), 0, -height))
    return FamilyPart(solid.cut(hole).Solids[0], np.array([[0.2, -0.7, 0.75], [-0.75, 0.35, 0.6], [0.75, 0.45, 0.55]]))


FAMILIES = {"bracket": bracket, "hat-channel": hat_channel, "rimmed-plate": rimmed_plate,
            "free-form-panel": free_form_panel, "pipe-on-plate": pipe_on_plate, "turned-part": turned_part}


def _extruded(profile: Profile, width: float) -> Part.Shape:
    """The sheet of the profile, from y = 0 to y = width."""
    left, right = (_offset_edges(profile, side * profile.thickness / 2) for side in (1, -1))
    ends = [Part.makeLine(left[k].Vertexes[k].Point, right[k].Vertexes[k].Point) for k in (0, -1)]
    face = Part.Face(Part.Wire([ends[0], *right, ends[1], *left[::-1]]))
    return face.extrude(Vector(0, width, 0))


def _offset_edges(profile: Profile, n: float) -> list[Part.Edge]:
    edges = []
    for i, piece in enumerate(profile.pieces):
        s = np.array([0.0, 0.5, 1.0]) * piece.length
        xz = profile.point(s, np.full(3, n), np.full(3, i))
        at = [Vector(x, 0, z) for x, z in xz]
        edges.append(Part.makeLine(at[0], at[2]) if piece.turn == 0 else Part.Arc(*at).toShape())
    return edges


def _across(profile: Profile, piece: int, s: float) -> tuple[Vector, Vector, Vector]:
    """A point of the neutral line, the direction along it and the one across the sheet."""
    x, z = profile.point(np.array([s]), np.zeros(1), np.array([piece]))[0]
    heading = profile.frames()[piece][1]
    return (Vector(x, 0, z), Vector(np.cos(heading), 0, np.sin(heading)), Vector(-np.sin(heading), 0, np.cos(heading)))


def _drill(shape: Part.Shape, profile: Profile, piece: int, places: list[tuple[float, float]],
           radius: float) -> Part.Shape:
    for s, y in places:
        point, _, normal = _across(profile, piece, s)
        depth = 2 * profile.thickness
        shape = shape.cut(Part.makeCylinder(radius, 2 * depth, point + Vector(0, y, 0) - normal * depth, normal))
    return shape.Solids[0]


def _slot(shape: Part.Shape, profile: Profile, piece: int, place: tuple[float, float], radius: float,
          length: float) -> Part.Shape:
    point, along, normal = _across(profile, piece, place[0])
    middle = point + Vector(0, place[1], 0) - normal * (2 * profile.thickness)
    y = Vector(0, length / 2, 0)
    a, b, side = middle - y, middle + y, along * radius
    end_a, end_b = a - Vector(0, radius, 0), b + Vector(0, radius, 0)
    wire = Part.Wire([Part.Arc(a + side, end_a, a - side).toShape(), Part.makeLine(a - side, b - side),
                      Part.Arc(b - side, end_b, b + side).toShape(), Part.makeLine(b + side, a + side)])
    return shape.cut(Part.Face(wire).extrude(normal * (4 * profile.thickness))).Solids[0]


def _spline(x: Array, y: float, z: Array) -> Part.Edge:
    curve = Part.BSplineCurve()
    curve.interpolate([Vector(a, y, c) for a, c in zip(x, z, strict=True)])
    return curve.toShape()
