# SPDX-License-Identifier: LGPL-2.1-or-later
"""OCCT's BREP text as records: parsed and printed again it is the same shape, digit by digit."""
from __future__ import annotations

import numpy as np
import Part
import pytest
from FreeCAD import Placement, Rotation, Vector

from ffds_workbench.brep.occt_text.curves import Line, Spline, print_curve, read_curve
from ffds_workbench.brep.occt_text.instances import Locations, inverse, product, walk
from ffds_workbench.brep.occt_text.records import Curve3d, dump, parse
from ffds_workbench.brep.occt_text.rewriting import surface_text
from ffds_workbench.errors import RefusedError
from ffds_workbench.registration.splines import SplineSurface, clamped_knots

PLACED = Placement(Vector(40, 5, 3), Rotation(Vector(1, 2, 3), 50))


def _twice() -> Part.Shape:
    """One solid at two places: shared shapes with locations."""
    drilled = Part.makeBox(10, 20, 30).cut(Part.makeCylinder(3, 50, Vector(5, 10, -5)))
    second = drilled.copy()
    second.Placement = PLACED
    return Part.Compound([drilled, second])


def _placed() -> Part.Shape:
    shape = Part.makeBox(10, 20, 30)
    shape = shape.makeFillet(2, shape.Edges)
    shape.Placement = PLACED
    return shape


SHAPES = {"box": Part.makeBox(1, 2, 3), "cone": Part.makeCone(0, 5, 10), "torus": Part.makeTorus(10, 3),
          "placed": _placed(), "twice": _twice(),
          "tilted cut": Part.makeCylinder(5, 20).cut(Part.makeBox(20, 20, 20, Vector(-10, -10, 12), Vector(0.3, 0, 1)))}


def _sections(shape: Part.Shape) -> tuple:
    brep = parse(shape.exportBrepToString())
    return brep.locations, brep.curves_2d, brep.curves_3d, brep.surfaces, brep.root, len(brep.shapes)


def _assert_round_trip(shape: Part.Shape) -> None:
    again = Part.Shape()
    again.importBrepFromString(dump(parse(shape.exportBrepToString())))
    counts = [[len(getattr(s, kind)) for kind in ("Solids", "Shells", "Faces", "Wires", "Edges", "Vertexes")]
              for s in (shape, again)]
    assert counts[0] == counts[1]
    for mine, theirs in zip(again.Vertexes, shape.Vertexes, strict=True):
        assert (mine.Point - theirs.Point).Length < 1e-12  # a vertex is printed with 15 digits
    # OCCT normalises an axis when it reads one, so the second reading must be the first's fixed point.
    once = Part.Shape()
    once.importBrepFromString(shape.exportBrepToString())
    assert _sections(again) == _sections(once)


@pytest.mark.parametrize("name", SHAPES)
def test_round_trip(name):
    _assert_round_trip(SHAPES[name])


@pytest.mark.parametrize("name", ["Axis_of_bearing.brep", "Ball.brep", "Bottom.brep", "CrankArm.brep", "Pump_Nut.brep",
                                  "bottle.brep", "boxed_sphere.step", "linkrods.step", "screw.step"])
def test_round_trip_of_shared_parts(name, shared_data):
    shape = Part.Shape()
    shape.read(str(shared_data / "parts" / name))
    _assert_round_trip(shape)


def test_a_damaged_text_is_refused():
    text = SHAPES["box"].exportBrepToString()
    with pytest.raises(RefusedError):
        parse(text.replace("V1", "V9"))
    with pytest.raises(RefusedError):
        parse(text.replace("Surfaces 6", "Surfaces 7"))


@pytest.mark.parametrize("name", SHAPES)
def test_instances_are_numbered_as_freecad_numbers_them(name):
    shape = SHAPES[name]
    brep = parse(shape.exportBrepToString())
    locations = Locations(brep.locations)
    instances = walk(brep, locations)
    assert len(instances.faces) == len(shape.Faces)
    for vertex, theirs in zip(instances.vertices, shape.Vertexes, strict=True):
        point = locations.matrix(vertex.place) @ np.array([*brep.shapes[vertex.shape].geometry.point, 1.0])
        np.testing.assert_allclose(point[:3], tuple(theirs.Point), atol=1e-12)
    for uses, face in zip(instances.face_uses, shape.Faces, strict=True):
        assert list(dict.fromkeys(use.edge for use in uses)) == [
            next(i for i, edge in enumerate(shape.Edges) if edge.isSame(mine)) for mine in face.Edges]


def test_chains_of_locations_cancel_as_in_occt():
    a, b = ((1, 1),), ((2, -1), (3, 2))
    assert product(product(a, b), inverse(product(a, b))) == ()
    assert product(a, ((1, 2),)) == ((1, 3),)


def test_curves_are_occts():
    """Every kind of curve record, against ``value`` of the edge's own curve; rounding only."""
    ellipse = Part.Ellipse(Vector(), 8, 4)
    parabola = Part.Parabola()
    parabola.Focal = 2
    spline = Part.BSplineCurve()
    angles = np.arange(8) * np.pi / 4
    spline.interpolate([Vector(8 * np.cos(t), 6 * np.sin(t), t) for t in angles], PeriodicFlag=True)
    rational = Part.makeCircle(3).toNurbs().Edges[0].Curve
    bezier = Part.BezierCurve()
    bezier.setPoles([Vector(0, 0, 0), Vector(1, 3, 0), Vector(4, 1, 2)])
    offset = Part.OffsetCurve(spline, 0.5, Vector(0, 0, 1))
    for curve, first, last in ((Part.Line(Vector(1, 2, 3), Vector(2, 4, 1)), -1, 2), (Part.Circle(), 0, 6),
                               (ellipse, 0, 6), (parabola, -2, 2), (Part.Hyperbola(), -1, 1), (bezier, 0, 1),
                               (spline, spline.FirstParameter, spline.LastParameter),
                                (rational, rational.FirstParameter, rational.LastParameter),
                               (offset, offset.FirstParameter, offset.LastParameter)):
        edge = curve.toShape(first, last)
        brep = parse(edge.exportBrepToString())
        item = next(item for shape in brep.shapes if shape.kind == "Ed"
                    for item in shape.geometry.representations if isinstance(item, Curve3d))
        t = np.linspace(item.first, item.last, 21)
        theirs = [tuple(edge.Curve.value(x)) for x in t]
        # Rounding; an offset curve's side is known to 1e-8.
        np.testing.assert_allclose(read_curve(brep.curves_3d[item.curve - 1], 3)(t), theirs, atol=1e-7)


def test_a_printed_curve_reads_back_the_same():
    knots = clamped_knots(0.0, 2.0, 6)
    spline = Spline(3, knots, np.random.default_rng(0).normal(size=(6, 3)), rational=False, periodic=False)
    line = Line(np.array([0.1, 0.2]), np.array([1.0, 0.0]))
    t = np.linspace(0, 2, 9)
    for curve, dimension in ((spline, 3), (line, 2)):
        np.testing.assert_array_equal(read_curve(print_curve(curve), dimension)(t), curve(t))


@pytest.mark.parametrize("periodic", [False, True])
def test_a_printed_surface_is_the_record_that_occt_prints(periodic):
    """The direct record against FreeCAD's B-spline API and OCCT's own printing of it."""
    points = np.random.default_rng(1).normal(size=(9, 6, 3))
    if periodic:
        points = np.concatenate([points, points[:3]])
        knots_u = np.arange(-3.0, 13.0)
    else:
        knots_u = clamped_knots(0.0, 9.0, 9)
    surface = SplineSurface(knots_u, clamped_knots(-1.0, 1.0, 6), points, periodic_u=periodic)
    poles = [[Vector(*point) for point in row] for row in (points[:9] if periodic else points).tolist()]
    flat = knots_u[3:-3] if periodic else knots_u
    arguments = [array.tolist() for direction in (flat, surface.knots_v)
                 for array in np.unique(direction, return_counts=True)]
    occt = Part.BSplineSurface()
    occt.buildFromPolesMultsKnots(poles, arguments[1], arguments[3], arguments[0], arguments[2], periodic, False, 3, 3)
    theirs = parse(occt.toShape().exportBrepToString()).surfaces[0]
    mine = surface_text(surface)
    np.testing.assert_allclose(np.array(mine.split(), float), np.array(theirs.split(), float), atol=1e-15)
    u, v = np.linspace(flat[0], flat[-1], 8)[:-1], np.linspace(-1, 1, 5)
    values = [[tuple(occt.value(a, b)) for b in v] for a in u]
    np.testing.assert_allclose(surface.on_grid(u, v), values, atol=1e-13)
