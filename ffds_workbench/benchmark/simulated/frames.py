# SPDX-License-Identifier: LGPL-2.1-or-later
"""Welded frames of any size: two rails, cross tubes between them and gusset plates on top, solids that touch."""
from __future__ import annotations

import Part
from FreeCAD import Placement, Rotation, Vector

_PITCH, _WIDTH, _GAP = 110.0, 60.0, 560.0
"""Millimetres from cross tube to cross tube, across a tube, and from rail to rail."""
_CORNER, _WALL, _GUSSET = 8.0, 4.0, 6.0


def frame(solids: int) -> Part.Shape:
    """A frame of so many solids, at least four: every fourth of them a gusset, all but two others cross tubes.

    A tube has 18 faces and a gusset five; a frame of 8 solids is 0.6 m long, one of 40 solids 3.3 m.
    """
    gussets = solids // 4
    crosses = solids - 2 - gussets
    length = crosses * _PITCH
    rails = [_tube(length, Placement(Vector(0, y, 0), Rotation(Vector(0, 1, 0), 90))) for y in (0.0, _GAP)]
    between = _GAP - _WIDTH
    at = [(k + 0.5) * _PITCH for k in range(crosses)]
    tubes = [_tube(between, Placement(Vector(x, 0.5 * _WIDTH, 0), Rotation(Vector(1, 0, 0), -90))) for x in at]
    plates = [_plate(at[(k * crosses) // gussets], k % 2) for k in range(gussets)]
    return Part.makeCompound([*rails, *tubes, *plates])


def _tube(length: float, placement: Placement) -> Part.Shape:
    """A square hollow section from the origin along z, put into place."""
    outer, inner = _section(_WIDTH, _CORNER, length), _section(_WIDTH - 2 * _WALL, _CORNER - _WALL, length)
    tube = outer.cut(inner).Solids[0]
    tube.Placement = placement
    return tube


def _section(width: float, radius: float, length: float) -> Part.Shape:
    box = Part.makeBox(width, width, length, Vector(-0.5 * width, -0.5 * width, 0))
    return box.makeFillet(radius, [edge for edge in box.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.9])


def _plate(x: float, rail: int) -> Part.Shape:
    """A triangle on top of a cross tube and one of the rails."""
    corner, side = (Vector(x, 0, 0.5 * _WIDTH), 1) if rail == 0 else (Vector(x, _GAP, 0.5 * _WIDTH), -1)
    reach = 0.5 * _WIDTH + 90.0
    points = [corner + Vector(*step) for step in ((-40, 0, 0), (40, 0, 0), (0, side * reach, 0))]
    return Part.Face(Part.makePolygon([*points, points[0]])).extrude(Vector(0, 0, _GUSSET))
