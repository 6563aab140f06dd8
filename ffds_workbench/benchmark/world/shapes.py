# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes that FreeCAD makes for the world benchmark, beside those of the topology benchmark."""
from __future__ import annotations

from collections.abc import Iterator

import Part
from FreeCAD import Vector

from ..simulated import topology_shapes


def primitives() -> Iterator[tuple[str, Part.Shape]]:
    """All of them, with their names."""
    yield from topology_shapes.primitives()
    yield "tube", Part.makeCylinder(30, 200).cut(Part.makeCylinder(27, 200))
    yield "hollow section", Part.makeBox(60, 40, 150).cut(Part.makeBox(54, 34, 150, Vector(3, 3, 0)))
    yield "lamp mount", lamp_mount()


def lamp_mount() -> Part.Shape:
    """An angle of 59 faces with what mounts of lamps have: rounded edges whose corners are spheres, so that edges end
    in poles; bores with chamfers; a slot; and a groove whose edges are 0.3 mm long, shorter than any cell."""
    mount = Part.makeBox(70, 40, 4).fuse(Part.makeBox(70, 4, 30)).removeSplitter()
    mount = mount.makeFillet(1.2, mount.Edges)
    for x in (10, 35, 60):
        mount = mount.cut(Part.makeCylinder(2.2, 10, Vector(x, 25, -3)))
        mount = mount.cut(Part.makeCone(2.2, 2.5, 0.3, Vector(x, 25, 3.7)))
        mount = mount.cut(Part.makeCylinder(1.6, 10, Vector(x, -3, 20), Vector(0, 1, 0)))
        mount = mount.cut(Part.makeCone(1.9, 1.6, 0.3, Vector(x, 0, 20), Vector(0, 1, 0)))
    slot = Part.makeBox(16, 5, 10, Vector(14, 31, -3))
    for x in (14, 30):
        slot = slot.fuse(Part.makeCylinder(2.5, 10, Vector(x, 33.5, -3)))
    return mount.cut(slot.removeSplitter()).cut(Part.makeBox(0.3, 6, 0.3, Vector(40, 30, 3.7)))
