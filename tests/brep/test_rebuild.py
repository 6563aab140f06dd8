# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rebuild on FreeCAD's primitives: topology, order, validity, gaps, tolerances, and that the points go where asked.

Tolerances: a face is within 2e-6 mm of nominal + displacement in either direction, an edge within half of that of the
mean of its faces or on one of them, so edges gape by at most about 5e-6 mm; 1e-5 is the line here. Pcurves start late
by 1.3 of the gap and what the start is off already, so along edges it is twice that, and twice what the nominal gapes.
The truth is the analytic displacement of points that FreeCAD gives on the nominal.
"""
from __future__ import annotations

import math

import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from ffds_workbench.brep import workpiece
from ffds_workbench.brep.face_displacement import FaceDisplacement
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.compat import write_step
from ffds_workbench.errors import RefusedError

GAP = 1e-5
PLACED = Placement(Vector(40, 5, 3), Rotation(Vector(1, 2, 3), 50))
STAYS = FaceDisplacement(lambda uv, points: np.zeros_like(points))


def _loft() -> Part.Shape:
    rings = [Part.Wire(Part.makeCircle(radius, Vector(0, 0, z))) for radius, z in ((5, 0), (3, 6), (6, 12))]
    return Part.makeLoft(rings, True, False)


def _profile() -> Part.Shape:
    curve = Part.BSplineCurve()
    curve.interpolate([Vector(4, 0, 0), Vector(6, 0, 3), Vector(3, 0, 6), Vector(5, 0, 10)])
    corners = [Vector(5, 0, 10), Vector(0, 0, 10), Vector(0, 0, 0), Vector(4, 0, 0)]
    lines = [Part.makeLine(a, b) for a, b in zip(corners[:-1], corners[1:], strict=True)]
    return Part.Face(Part.Wire([curve.toShape(), *lines]))


def _prism() -> Part.Shape:
    corners = [Vector(5 * math.cos(k * math.pi / 3), 5 * math.sin(k * math.pi / 3), 0) for k in range(7)]
    return Part.Face(Part.makePolygon(corners)).extrude(Vector(0, 1, 8))


def _filleted() -> Part.Shape:
    box = Part.makeBox(10, 20, 30)
    return box.makeFillet(2, box.Edges[:5])


def _drilled() -> Part.Shape:
    """Two crossing bores: closed faces, inner wires, and edges whose pcurves OCCT's intersection left behind."""
    box = Part.makeBox(10, 20, 30).cut(Part.makeCylinder(3, 50, Vector(5, 10, -5)))
    return box.cut(Part.makeCylinder(2, 50, Vector(-5, 10, 12), Vector(1, 0, 0)))


def _twice() -> Part.Shape:
    first = _drilled()
    second = first.copy()
    second.Placement = PLACED
    return Part.Compound([first, second])


def _placed() -> Part.Shape:
    shape = _filleted()
    shape.Placement = PLACED
    return shape


def _fused() -> Part.Shape:
    shape = Part.makeBox(10, 10, 10).fuse(Part.makeCylinder(3, 15, Vector(5, 5, 5)))
    return shape.fuse(Part.makeSphere(4, Vector(0, 0, 0))).removeSplitter()


SHAPES = {
    "box": lambda: Part.makeBox(10, 20, 30),
    "cylinder": lambda: Part.makeCylinder(5, 10),
    "cylinder sector": lambda: Part.makeCylinder(5, 10, Vector(1, 2, 3), Vector(1, 1, 1), 200),
    "cone with apex": lambda: Part.makeCone(0, 5, 10),
    "cone sector": lambda: Part.makeCone(5, 0, 10, Vector(), Vector(1, 0, 1), 270),
    "cut cone": lambda: Part.makeCone(0, 5, 10).cut(Part.makeCylinder(1.2, 30, Vector(0.3, -15, 1), Vector(0, 1, 0))),
    "sphere": lambda: Part.makeSphere(7),
    "sphere sector": lambda: Part.makeSphere(7, Vector(), Vector(0, 0, 1), -30, 60, 220),
    "torus": lambda: Part.makeTorus(10, 3),
    "torus sector": lambda: Part.makeTorus(10, 3, Vector(), Vector(0, 0, 1), -120, 100, 200),
    "wedge": lambda: Part.makeWedge(0, 0, 0, 2, 2, 10, 10, 10, 8, 8),
    "prism": _prism,
    "filleted": _filleted,
    "loft": _loft,
    "offset": lambda: _loft().makeOffsetShape(0.5, 1e-4),
    "revolution": lambda: _profile().revolve(Vector(), Vector(0, 0, 1), 360),
    "extrusion": lambda: _profile().extrude(Vector(1, 12, 0)),
    "drilled": _drilled,
    "fused": _fused,
    "two cylinders": lambda: Part.makeCylinder(5, 20, Vector(0, 0, -10)).common(
        Part.makeCylinder(5, 20, Vector(-10, 0, 0), Vector(1, 0, 0))),
    "mirrored": lambda: _drilled().mirror(Vector(), Vector(1, 0, 0)),
    "placed": _placed,
    "twice": _twice,
    "hollow": lambda: Part.makeSphere(10).cut(Part.makeSphere(6)),
    "shell": lambda: Part.Shell(Part.makeBox(4, 4, 4).Faces[:4]),
    "shared face": lambda: Part.makeBox(9, 9, 9).generalFuse([Part.makeBox(9, 9, 9, Vector(5, 5, 5))])[0],
}


BOOLEAN_CHECK = ("box", "cylinder", "cone with apex", "sphere", "torus", "revolution", "two cylinders")
"""It takes seconds on the others; ``./ffds benchmark topology`` runs it on all."""


def warp(shape: Part.Shape, amplitude: float = 0.02):
    """A smooth displacement of space, ``amplitude`` of the part's size."""
    box = shape.BoundBox
    centre, size = np.array(tuple(box.Center)), box.DiagonalLength

    def displacement(points: np.ndarray) -> np.ndarray:
        x, y, z = (1.4 * math.pi * (points - centre) / size).T
        return 0.5 * amplitude * size * np.stack(
            [np.sin(y + 0.3) * np.cos(z), np.sin(z + 0.1) + 0.3 * np.cos(x), np.cos(x + 0.5) * np.sin(y)], axis=1)

    return displacement


def everywhere(shape: Part.Shape, displacement) -> dict[int, FaceDisplacement]:
    return {i: FaceDisplacement(lambda uv, points: displacement(points)) for i in range(len(shape.Faces))}


def counts(shape: Part.Shape) -> list[int]:
    return [len(getattr(shape, kind)) for kind in ("Solids", "Shells", "Faces", "Wires", "Edges", "Vertexes")]


def gap(shape: Part.Shape, samples: int = 25) -> float:
    """Largest distance of an edge's curve from its faces at the same parameter, and of vertices from edge ends."""
    worst = 0.0
    for face in shape.Faces:
        face = face.reversed() if face.Orientation == "Reversed" else face
        for wire in face.Wires:
            for edge in wire.childShapes(True, True):
                if edge.Degenerated:
                    continue
                pcurve, first, last = face.curveOnSurface(edge)[:3]
                start, end = edge.ParameterRange
                for t in np.linspace(0, 1, samples):
                    uv = pcurve.value(first + t * (last - first))
                    point = face.Surface.value(uv.x, uv.y)
                    worst = max(worst, (point - edge.Curve.value(start + t * (end - start))).Length)
    for edge in shape.Edges:
        if not edge.Degenerated:
            ends = [edge.valueAt(t) for t in edge.ParameterRange]
            worst = max([worst] + [min((vertex.Point - end).Length for end in ends) for vertex in edge.Vertexes])
    return worst


def tolerance(shape: Part.Shape) -> float:
    return max(item.Tolerance for kind in (shape.Faces, shape.Edges, shape.Vertexes) for item in kind)


def boolean_errors(shape: Part.Shape) -> int:
    try:
        shape.check(True)
    except ValueError as error:
        return len(str(error).splitlines())
    return 0


def face_edges(shape: Part.Shape) -> list[list[int]]:
    """Edges of each face by index."""
    by_hash: dict[int, list[int]] = {}
    edges = shape.Edges
    for i, edge in enumerate(edges):
        by_hash.setdefault(edge.hashCode(), []).append(i)
    return [[next(i for i in by_hash[edge.hashCode()] if edges[i].isSame(edge)) for edge in face.Edges]
            for face in shape.Faces]


def assert_same_topology(result: Part.Shape, nominal: Part.Shape) -> None:
    assert counts(result) == counts(nominal)
    assert [shell.isClosed() for shell in result.Shells] == [shell.isClosed() for shell in nominal.Shells]
    assert result.isValid()
    assert face_edges(result) == face_edges(nominal)


def assert_points_moved(result: Part.Shape, nominal: Part.Shape, displacement) -> None:
    """Points of every face and vertex, by index, are at nominal + displacement."""
    for mine, theirs in zip(result.Faces, workpiece.read(nominal).faces, strict=True):
        box = theirs.box
        uv = np.random.default_rng(0).uniform((box.u0, box.v0), (box.u1, box.v1), (60, 2)).tolist()
        points = np.array([tuple(theirs.face.Surface.value(u, v)) for u, v in uv])
        moved = np.array([tuple(mine.Surface.value(u, v)) for u, v in uv])
        assert np.abs(moved - points - displacement(points)).max() < GAP
    before = np.array([tuple(vertex.Point) for vertex in nominal.Vertexes])
    after = np.array([tuple(vertex.Point) for vertex in result.Vertexes])
    assert np.abs(after - before - displacement(before)).max() < GAP + gap(nominal)


@pytest.mark.parametrize("name", SHAPES)
def test_a_warp_of_the_whole_keeps_everything_but_the_points(name, tmp_path):
    nominal = SHAPES[name]()
    displacement = warp(nominal)
    result = rebuild(workpiece.read(nominal), everywhere(nominal, displacement))
    assert_same_topology(result, nominal)
    assert_points_moved(result, nominal, displacement)
    assert gap(result) < 2 * (gap(nominal) + GAP)
    assert tolerance(result) <= max(tolerance(nominal), 1e-3)
    if name in BOOLEAN_CHECK:
        assert boolean_errors(result) <= boolean_errors(nominal)
    write_step(result, tmp_path / "result.step")
    write_step(nominal, tmp_path / "nominal.step")
    back = [Part.read(str(tmp_path / f"{which}.step")) for which in ("result", "nominal")]
    assert back[0].isValid()
    assert counts(back[0]) == counts(back[1])


@pytest.mark.parametrize("name", SHAPES)
def test_identity_approximates_every_face_again(name):
    nominal = SHAPES[name]()
    result = rebuild(workpiece.read(nominal), dict.fromkeys(range(len(nominal.Faces)), STAYS))
    assert_same_topology(result, nominal)
    assert_points_moved(result, nominal, np.zeros_like)
    assert all(type(face.Surface).__name__ == "BSplineSurface" for face in result.Faces)
    if nominal.Solids:
        assert result.Volume == pytest.approx(nominal.Volume, rel=1e-6)


def test_nothing_displaced_nothing_changes():
    nominal = _drilled()
    result = rebuild(workpiece.read(nominal), {})
    assert result.exportBrepToString() == nominal.copy().exportBrepToString()


def test_faces_that_are_not_named_keep_their_own_surface_and_edges():
    """A bump around one edge of a box: the two faces at the edge and the two at its ends move, the others do not."""
    nominal = Part.makeBox(10, 20, 30)
    corner = np.array([0.0, 10.0, 0.0])

    def bump(points: np.ndarray) -> np.ndarray:
        r = np.linalg.norm(points - corner, axis=1) / 6.0
        return np.array([0.3, 0.1, -0.2]) * (np.clip(1.0 - r, 0, None) ** 6 * (35 * r**2 + 18 * r + 3) / 3)[:, None]

    near = [i for i, face in enumerate(nominal.Faces) if face.distToShape(Part.Vertex(*corner))[0] < 1e-9]
    assert len(near) == 2
    part = workpiece.read(nominal)
    seeds = np.linspace(-30, 30, 121)
    moving = {i: FaceDisplacement(lambda uv, points: bump(points), seeds, seeds) for i in near}
    result = rebuild(part, moving)
    assert_same_topology(result, nominal)
    assert_points_moved(result, nominal, bump)
    assert boolean_errors(result) == 0
    for i, (mine, theirs) in enumerate(zip(result.Faces, nominal.Faces, strict=True)):
        assert type(mine.Surface).__name__ == ("BSplineSurface" if i in near else "Plane")
        assert i in near or mine.Surface.Position == theirs.Surface.Position
    splines = [i for i, edge in enumerate(result.Edges) if type(edge.Curve).__name__ == "BSplineCurve"]
    assert len(splines) == 1  # the edge between the two; their other edges keep their lines


def test_one_of_two_instances_moves_the_other_is_untouched():
    nominal = _twice()
    count = len(nominal.Faces) // 2
    displacement = warp(nominal)
    moving = {i: FaceDisplacement(lambda uv, points: displacement(points)) for i in range(count, 2 * count)}
    result = rebuild(workpiece.read(nominal), moving)
    assert_same_topology(result, nominal)
    for part, expected in zip(result.Solids, (np.zeros_like, displacement), strict=True):
        at = 0 if expected is np.zeros_like else 1
        assert_points_moved(part, nominal.Solids[at], expected)
    assert [type(face.Surface).__name__ for face in result.Faces[:count]] == [
        type(face.Surface).__name__ for face in nominal.Faces[:count]]
    assert (result.Solids[1].Placement.Base - nominal.Solids[1].Placement.Base).Length < 1e-12


def test_a_displacement_that_tears_off_a_face_that_stays_is_refused():
    nominal = Part.makeBox(10, 20, 30)
    shift = FaceDisplacement(lambda uv, points: np.full_like(points, 0.1))
    with pytest.raises(RefusedError, match="Face3 would tear off"):
        rebuild(workpiece.read(nominal), {2: shift})


def test_a_displacement_that_folds_a_face_is_refused():
    nominal = Part.makeBox(10, 20, 30)

    def fold(points: np.ndarray) -> np.ndarray:
        return np.stack([np.zeros(len(points)), 4.0 * np.sin(points[:, 1]), np.zeros(len(points))], axis=1)

    with pytest.raises(RefusedError, match="fold over"):
        rebuild(workpiece.read(nominal), everywhere(nominal, fold))


def test_a_turn_of_the_whole_is_no_fold():
    nominal = Part.makeCylinder(5, 10)
    turn = np.array([[0.5, -math.sqrt(0.75), 0], [math.sqrt(0.75), 0.5, 0], [0, 0, 1]])
    result = rebuild(workpiece.read(nominal), everywhere(nominal, lambda points: points @ turn.T - points))
    assert result.isValid()


def test_a_looser_tolerance_needs_fewer_control_points():
    nominal = Part.makeBox(10, 20, 30)
    part = workpiece.read(nominal)
    moving = everywhere(nominal, warp(nominal))
    poles = []
    for accuracy in (1e-3, 1e-6):
        result = rebuild(part, moving, accuracy)
        assert result.isValid()
        assert gap(result) < 3 * accuracy
        poles.append(sum(face.Surface.NbUPoles * face.Surface.NbVPoles for face in result.Faces))
    assert poles[0] < 0.3 * poles[1]
