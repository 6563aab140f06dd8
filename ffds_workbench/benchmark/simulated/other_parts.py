# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts for setting and for testing the verdict of the alignment; no accuracy that is reported is measured on them.

`CALIBRATION` families set its thresholds, `HELD_OUT` families tell its error rates. Sizes are drawn at random, in mm.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np
import Part
from FreeCAD import Placement, Rotation, Vector

Draw = Callable[[np.random.Generator], Part.Shape]


def zee(rng: np.random.Generator) -> Part.Shape:
    """A sheet bent twice, up and on, with a row of holes in the lower flange and a slot above."""
    t, width = rng.uniform(1.5, 3.0), rng.uniform(50, 80)
    low, rise, high = rng.uniform(30, 45), rng.uniform(25, 40), rng.uniform(20, 30)
    shape = _box(0, 0, 0, low, width, t).fuse(_box(low - t, 0, 0, t, width, rise)).fuse(
        _box(low - t, 0, rise - t, high, width, t)).removeSplitter()
    for share in (0.2, 0.45, 0.8):
        shape = shape.cut(_drill(0.4 * low, share * width, rng.uniform(2, 4)))
    return shape.cut(_box(low + 0.4 * high, 0.2 * width, -1, 5, 0.3 * width, rise + 5)).Solids[0]


def tray(rng: np.random.Generator) -> Part.Shape:
    """A sheet tray with rims of two heights, one of them missing, and a vent in its floor."""
    t, a, b = rng.uniform(1.5, 2.5), rng.uniform(70, 100), rng.uniform(50, 70)
    low, high = rng.uniform(12, 18), rng.uniform(24, 34)
    shape = _box(0, 0, 0, a, b, t).fuse(_box(0, 0, 0, a, t, low)).fuse(_box(0, b - t, 0, a, t, high)).fuse(
        _box(0, 0, 0, t, b, low)).removeSplitter()
    for k in range(3):
        shape = shape.cut(_box((0.3 + 0.12 * k) * a, 0.25 * b, -1, 0.06 * a, 0.4 * b, 2 * t + 1))
    return shape.Solids[0]


def ribbed_plate(rng: np.random.Generator) -> Part.Shape:
    """A cast plate with a boss off its middle and three ribs that run into it."""
    t, a, b = rng.uniform(5, 8), rng.uniform(70, 95), rng.uniform(60, 80)
    boss, height = rng.uniform(12, 17), rng.uniform(20, 32)
    x, y = 0.4 * a, 0.55 * b
    shape = _box(0, 0, 0, a, b, t).fuse(Part.makeCylinder(boss, height, Vector(x, y, 0)))
    for angle, length in ((10, 0.5 * a), (130, 0.32 * b), (250, 0.4 * b)):
        rib = _box(0, -2.5, t - 1, length, 5, 0.5 * height)
        rib.Placement = Placement(Vector(x, y, 0), Rotation(Vector(0, 0, 1), angle))
        shape = shape.fuse(rib)
    return shape.removeSplitter().cut(_drill(x, y, 0.55 * boss, 2 * height)).Solids[0]


def elbow(rng: np.random.Generator) -> Part.Shape:
    """A pipe bent by 60 to 100 degrees with a square flange at one end."""
    bend, radius, wall = rng.uniform(35, 50), rng.uniform(12, 17), rng.uniform(2.0, 3.5)
    turn, side, t = rng.uniform(60, 100), rng.uniform(45, 60), rng.uniform(5, 8)
    pipes = []
    for r in (radius, radius - wall):
        ring = Part.Face(Part.Wire(Part.makeCircle(r, Vector(bend, 0, 0), Vector(0, 0, 1))))
        pipes.append(ring.revolve(Vector(0, 0, 0), Vector(0, -1, 0), turn))
    flange = _box(bend - 0.5 * side, -0.5 * side, -t, side, side, t)
    shape = pipes[0].fuse(flange).removeSplitter().cut(pipes[1])
    shape = shape.cut(Part.makeCylinder(radius - wall, 3 * t, Vector(bend, 0, -2 * t)))
    for x, y in ((-1, -1), (1, -1), (1, 1)):
        shape = shape.cut(_drill(bend + 0.38 * side * x, 0.38 * side * y, 3.0, -2 * t, 3 * t))
    return shape.Solids[0]


def stepped_block(rng: np.random.Generator) -> Part.Shape:
    """A milled block with two steps, a pocket and a cross bore."""
    a, b, c = rng.uniform(70, 95), rng.uniform(45, 60), rng.uniform(35, 50)
    shape = _box(0, 0, 0, a, b, c).cut(_box(0.6 * a, -1, 0.65 * c, a, b + 2, c)).cut(
        _box(0.8 * a, -1, 0.35 * c, a, b + 2, c))
    shape = shape.cut(_box(0.12 * a, 0.2 * b, 0.6 * c, 0.35 * a, rng.uniform(0.3, 0.5) * b, c))
    return shape.cut(Part.makeCylinder(0.14 * c, 2 * b, Vector(0.7 * a, -1, 0.3 * c), Vector(0, 1, 0))).Solids[0]


def tee(rng: np.random.Generator) -> Part.Shape:
    """A rolled tee with a web that stands off the middle, notched at one end and drilled."""
    t, length = rng.uniform(3, 5), rng.uniform(80, 110)
    width, web = rng.uniform(45, 60), rng.uniform(35, 50)
    shape = _box(0, 0, 0, length, width, t).fuse(_box(0, 0.4 * width, 0, length, t, web)).removeSplitter()
    shape = shape.cut(_box(-1, -1, -1, rng.uniform(0.15, 0.25) * length, 0.4 * width + 1, 2 * t))
    for share in (0.35, 0.75):
        shape = shape.cut(Part.makeCylinder(4, 60, Vector(share * length, -1, 0.65 * web), Vector(0, 1, 0)))
    return shape.Solids[0]


def saddle_clip(rng: np.random.Generator) -> Part.Shape:
    """A sheet clip: half a tube with two flat ears of unequal length."""
    t, radius, width = rng.uniform(2.0, 3.5), rng.uniform(18, 26), rng.uniform(35, 55)
    left, right = rng.uniform(18, 24), rng.uniform(28, 38)
    arch = Part.makeCylinder(radius + t, width).cut(Part.makeCylinder(radius, width))
    arch.Placement = Placement(Vector(0, width, 0), Rotation(Vector(1, 0, 0), 90))
    arch = arch.common(_box(-2 * radius, 0, 0, 4 * radius, width, 2 * radius))
    shape = arch.fuse(_box(-radius - left, 0, 0, left, width, t)).fuse(
        _box(radius, 0, 0, right, width, t)).removeSplitter()
    shape = shape.cut(_drill(-radius - 0.55 * left, 0.4 * width, 4))
    return shape.cut(_box(radius + 0.5 * right, 0.3 * width, -1, 6, 0.4 * width, 3 * t)).Solids[0]


def gusset(rng: np.random.Generator) -> Part.Shape:
    """Two welded plates at a right angle with a three-cornered one between them, off the middle."""
    t, a, b, c = rng.uniform(4, 6), rng.uniform(55, 75), rng.uniform(45, 65), rng.uniform(50, 70)
    shape = _box(0, 0, 0, a, b, t).fuse(_box(0, 0, 0, t, b, c))
    corners = [Vector(t, 0.3 * b, t), Vector(0.9 * a, 0.3 * b, t), Vector(t, 0.3 * b, 0.85 * c)]
    rib = Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(Vector(0, t, 0))
    return shape.fuse(rib).removeSplitter().cut(_drill(0.6 * a, 0.75 * b, 5)).Solids[0]


def dome(rng: np.random.Generator) -> Part.Shape:
    """A pressed cap: part of a spherical shell on a flange with a cut-off side and two holes."""
    ball, t = rng.uniform(38, 50), rng.uniform(2.0, 3.0)
    depth, rim = rng.uniform(0.45, 0.6) * ball, rng.uniform(10, 16)
    mouth = float(np.sqrt(ball**2 - depth**2))
    cap = Part.makeSphere(ball).cut(Part.makeSphere(ball - t)).common(
        _box(-2 * ball, -2 * ball, depth, 4 * ball, 4 * ball, 2 * ball))
    flange = Part.makeCylinder(mouth + rim, t, Vector(0, 0, depth)).cut(
        Part.makeCylinder(mouth - 0.5 * t, t, Vector(0, 0, depth)))
    shape = cap.fuse(flange).removeSplitter().cut(
        _box(mouth + 0.3 * rim, -2 * ball, 0, 2 * ball, 4 * ball, 2 * ball))
    for angle in (80, 200):
        x, y = (mouth + 0.5 * rim) * np.array([np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))])
        shape = shape.cut(_drill(x, y, 3))
    return shape.Solids[0]


def fork(rng: np.random.Generator) -> Part.Shape:
    """A clevis: two cheeks with bores of two sizes on a shank."""
    a, b, gap = rng.uniform(35, 50), rng.uniform(35, 45), rng.uniform(14, 20)
    cheek, shank, radius = rng.uniform(8, 11), rng.uniform(30, 45), rng.uniform(9, 13)
    high = gap + 2 * cheek
    shape = _box(0, 0, 0, a, b, high).cut(_box(0.3 * a, -1, cheek, a, b + 2, gap))
    shape = shape.fuse(Part.makeCylinder(radius, shank + 1, Vector(1, 0.4 * b, 0.5 * high), Vector(-1, 0, 0)))
    shape = shape.cut(_drill(0.68 * a, 0.6 * b, 7, -1, cheek + 2))
    return shape.removeSplitter().cut(_drill(0.68 * a, 0.6 * b, 4.5, cheek + 1, high)).Solids[0]


def corrugated(rng: np.random.Generator) -> Part.Shape:
    """A sheet with two waves of unequal height and a corner cut off."""
    t, length, pitch = rng.uniform(1.5, 2.5), rng.uniform(60, 90), rng.uniform(24, 32)
    heights = rng.uniform(8, 12), rng.uniform(14, 20)
    x, z, at = [0.0], [0.0], 0.0
    for height in heights:
        x += [at + 0.3 * pitch, at + 0.5 * pitch, at + 0.9 * pitch, at + 1.1 * pitch]
        z += [0.0, height, height, 0.0]
        at += 1.1 * pitch
    x, z = [*x, at + 0.6 * pitch], [*z, 0.0]
    upper = [Vector(a, 0, c + t) for a, c in zip(x, z, strict=True)]
    lower = [Vector(a, 0, c) for a, c in zip(x, z, strict=True)]
    wire = Part.makePolygon([*upper, *lower[::-1], upper[0]])
    shape = Part.Face(wire).extrude(Vector(0, length, 0))
    corner = [Vector(at, length + 1, -1), Vector(at + pitch, length + 1, -1), Vector(at + pitch, 0.6 * length, -1)]
    return shape.cut(Part.Face(Part.makePolygon([*corner, corner[0]])).extrude(Vector(0, 0, 40))).Solids[0]


def lever(rng: np.random.Generator) -> Part.Shape:
    """A forged lever: two eyes of unequal size and height, joined by a tapered arm."""
    length, big, small = rng.uniform(70, 95), rng.uniform(15, 20), rng.uniform(9, 12)
    high, low, arm = rng.uniform(22, 30), rng.uniform(14, 18), rng.uniform(8, 11)
    corners = [Vector(0, 0.8 * big, 3), Vector(length, 0.7 * small, 3), Vector(length, -0.7 * small, 3),
               Vector(0, -0.8 * big, 3)]
    shape = Part.Face(Part.makePolygon([*corners, corners[0]])).extrude(Vector(0, 0, arm))
    shape = shape.fuse(Part.makeCylinder(big, high)).fuse(
        Part.makeCylinder(small, low, Vector(length, 0, 0))).removeSplitter()
    shape = shape.cut(_drill(0, 0, 0.55 * big)).cut(_drill(length, 0, 0.5 * small))
    return shape.cut(_box(-2, 0.4 * big, -1, 4, big, 2 * high)).Solids[0]


CALIBRATION: dict[str, Draw] = {"zee": zee, "tray": tray, "ribbed-plate": ribbed_plate, "elbow": elbow,
                                "stepped-block": stepped_block, "tee": tee}
HELD_OUT: dict[str, Draw] = {"saddle-clip": saddle_clip, "gusset": gusset, "dome": dome, "fork": fork,
                             "corrugated": corrugated, "lever": lever}


def _box(x: float, y: float, z: float, a: float, b: float, c: float) -> Part.Shape:
    return Part.makeBox(a, b, c, Vector(x, y, z))


def _drill(x: float, y: float, radius: float, z: float = -50.0, height: float = 200.0) -> Part.Shape:
    return Part.makeCylinder(radius, height, Vector(x, y, z))
