# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local edits: continuity along every edge, what stays, what is carried along, and the pieces the field is made of."""
from __future__ import annotations

from itertools import combinations

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from ffds_workbench.brep import workpiece
from ffds_workbench.brep.continuity.cutoff import SPACING, Cutoff, smooth_step
from ffds_workbench.brep.continuity.edge_samples import inside
from ffds_workbench.brep.continuity.local_field import local_displacements
from ffds_workbench.brep.continuity.radial_basis import interpolate, wendland
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.brep.topology import edge_traces
from ffds_workbench.errors import InputError, RefusedError
from ffds_workbench.registration.splines import SplineSurface, clamped_knots, greville
from ffds_workbench.report.boolean_check import boolean_checks
from ffds_workbench.report.certificate import Certificate, condition

FIDELITY = 4e-5
"""mm; the field may be this far from a registered displacement along an edge (field._CLOSE), on either side of it."""


def sheet() -> Part.Shape:
    """A plate of 60 × 40 × 3 mm with two holes; face and edge numbers are looked up, not assumed."""
    plate = Part.makeBox(60, 40, 3)
    for x, radius in ((15, 5), (42, 8)):
        plate = plate.cut(Part.makeCylinder(radius, 3, Vector(x, 20, 0)))
    return plate


def face_at(part: workpiece.Workpiece, point: tuple[float, float, float]) -> int:
    """The face on which a point lies."""
    return min(range(len(part.faces)), key=lambda i: part.faces[i].face.distToShape(Part.Vertex(Vector(*point)))[0])


def lattice(part: workpiece.Workpiece, face: int, function, count: int = 8) -> SplineSurface:
    """A displacement of a face: count × count control points with the values of a function at their places."""
    box = part.faces[face].box
    ku, kv = clamped_knots(box.u0, box.u1, count), clamped_knots(box.v0, box.v1, count)
    points = part.faces[face].on_grid(greville(ku), greville(kv))
    return SplineSurface(ku, kv, function(points.reshape(-1, 3)).reshape(points.shape))


def bulge(points: np.ndarray) -> np.ndarray:
    """Upwards by up to 2 mm, nowhere zero, with a little sideways."""
    x, y, _ = points.T
    up = 1.3 + 0.7 * np.sin(x / 9) * np.cos(y / 11)
    return np.stack([0.1 * up, 0.2 * np.cos(x / 15), up], axis=1)


def largest_disagreement(part: workpiece.Workpiece, displacements) -> tuple[float, float]:
    """Largest difference in mm of two moving faces at their edge, and largest motion beside a face that stays."""
    fractions = np.linspace(0, 1, 157)
    between, beside = [0.0], [0.0]
    for edge, faces in enumerate(part.topology.edge_faces):
        values = []
        for face in faces:
            if face in displacements:
                values += [displacements[face].evaluate(trace.uv, part.faces[face].at(trace.uv))
                           for trace in edge_traces(part.faces[face].face, part.edges[edge], fractions)]
        between += [np.linalg.norm(a - b, axis=1).max() for a, b in combinations(values, 2)]
        if any(face not in displacements for face in faces):
            beside += [np.linalg.norm(value, axis=1).max() for value in values]
    return max(between), max(beside)


def test_edges_stay_closed_and_the_edited_face_is_what_was_registered():
    part = workpiece.read(sheet())
    top = face_at(part, (3, 3, 3))
    displacement = lattice(part, top, bulge)
    moved = local_displacements(part, {top: displacement})
    between, beside = largest_disagreement(part, moved)
    assert between <= FIDELITY
    assert beside == 0.0
    uv = np.random.default_rng(0).uniform((0, 0), (60, 40), (500, 2)) + displacement.range[::2]
    np.testing.assert_allclose(moved[top].evaluate(uv, part.faces[top].at(uv)), displacement(uv), atol=1e-12)


def test_an_edge_too_long_to_be_held_beside_the_edited_face_holds_nothing_of_it():
    """The far edges of a large thin plate lie 20 times the displacement away, but to hold them there would take more
    samples than an edge gets: fewer reach as far as the edited face's own rim."""
    part = workpiece.read(Part.makeBox(400, 300, 2))
    top = face_at(part, (3, 3, 2))
    displacement = lattice(part, top, lambda points: np.broadcast_to([0.0, 0.0, 0.1], points.shape))
    moved = local_displacements(part, {top: displacement})
    uv = part.faces[top].trims[0]
    np.testing.assert_allclose(moved[top].evaluate(uv, part.faces[top].at(uv)), displacement(uv), atol=FIDELITY)
    assert max(largest_disagreement(part, moved)) <= FIDELITY


def test_the_far_side_of_a_sheet_is_carried_along():
    """3 mm behind a bulge of 2 mm: the field has lost at most a tenth there, so the thickness is kept to 0.2 mm."""
    part = workpiece.read(sheet())
    top, bottom = face_at(part, (3, 3, 3)), face_at(part, (3, 3, 0))
    displacement = lattice(part, top, bulge)
    moved = local_displacements(part, {top: displacement})
    assert len(moved) == len(part.faces)
    points = np.array([(x, y, 0.0) for x in (8.0, 28.0, 55.0) for y in (5.0, 35.0)])
    behind = moved[bottom].evaluate(np.zeros((len(points), 2)), points)
    np.testing.assert_allclose(behind, bulge(points), atol=0.2)


def test_a_small_bulge_leaves_the_far_side_exactly_alone():
    """0.3 mm is less than a fifth of 3 mm: only the walls adapt."""
    part = workpiece.read(sheet())
    top, bottom = face_at(part, (3, 3, 3)), face_at(part, (3, 3, 0))
    moved = local_displacements(part, {top: lattice(part, top, lambda points: 0.15 * bulge(points))})
    assert bottom not in moved
    assert largest_disagreement(part, moved)[1] == 0.0


def test_far_faces_are_not_named():
    steps = Part.makeBox(20, 20, 100).fuse(Part.makeBox(60, 20, 10, Vector(0, 0, -10))).removeSplitter()
    part = workpiece.read(steps)
    top = face_at(part, (10, 10, 100))
    moved = local_displacements(part, {top: lattice(part, top, lambda p: np.tile((0.0, 0.0, 1.0), (len(p), 1)))})
    assert face_at(part, (30, 10, -10)) not in moved
    assert face_at(part, (50, 10, 0)) not in moved
    assert largest_disagreement(part, moved) <= (FIDELITY, 0.0)


def test_a_frozen_neighbour_stays_and_the_edited_face_fades_towards_it():
    part = workpiece.read(Part.makeBox(60, 40, 20))
    top, wall = face_at(part, (30, 20, 20)), face_at(part, (0, 20, 10))
    displacement = lattice(part, top, bulge)
    moved = local_displacements(part, {top: displacement}, freeze=[wall])
    assert wall not in moved
    assert largest_disagreement(part, moved) <= (FIDELITY, 0.0)
    trace = edge_traces(part.faces[top].face, next(e for e in part.faces[top].face.Edges if e.BoundBox.XMax < 1),
                        np.linspace(0, 1, 50))[0]
    assert not moved[top].evaluate(trace.uv, trace.points).any()
    far = np.array([part.faces[top].own_surface.parameter(Vector(50, y, 20)) for y in (5, 20, 35)])
    np.testing.assert_allclose(moved[top].evaluate(far, part.faces[top].at(far)), displacement(far), atol=1e-12)


def test_contradictions_are_refused():
    part = workpiece.read(Part.makeBox(60, 40, 20))
    displacement = lattice(part, 0, bulge)
    with pytest.raises(InputError, match="Face1 cannot be deformed and frozen"):
        local_displacements(part, {0: displacement}, freeze=[0, 1])
    with pytest.raises(RefusedError, match="Every face is frozen"):
        local_displacements(part, {}, freeze=range(6))
    assert local_displacements(part, {}) == {}


def test_faces_registered_apart_meet_and_keep_their_interior():
    """0.1 mm apart at their edge: one field there; a quarter of the size away the correction is gone."""
    part = workpiece.read(Part.makeBox(60, 40, 20))
    top, side = face_at(part, (30, 20, 20)), face_at(part, (60, 20, 10))
    own = {top: lattice(part, top, bulge), side: lattice(part, side, lambda points: bulge(points) + (0.1, 0.0, -0.1))}
    moved = local_displacements(part, own)
    assert largest_disagreement(part, moved) <= (2 * FIDELITY, 0.0)
    uv = np.array([part.faces[top].own_surface.parameter(Vector(x, y, 20)) for x in (5, 20, 35) for y in (8, 32)])
    np.testing.assert_allclose(moved[top].evaluate(uv, part.faces[top].at(uv)), own[top](uv), atol=FIDELITY)


@pytest.mark.parametrize("shape", [Part.makeSphere(15), Part.makeCone(12, 0, 25), Part.makeCylinder(10, 30)],
                         ids=["sphere", "cone", "cylinder"])
def test_seams_and_poles_close_even_where_the_displacement_does_not(shape):
    """A lattice that knows nothing of its face's seam and pole: 0.2 mm apart there."""
    part = workpiece.read(shape)
    box = part.faces[0].box
    control = np.random.default_rng(1).uniform(-0.1, 0.1, (8, 8, 3)) + (0.2, 0.1, 0.3)
    displacement = SplineSurface(clamped_knots(box.u0, box.u1, 8), clamped_knots(box.v0, box.v1, 8), control)
    moved = local_displacements(part, {0: displacement})
    assert largest_disagreement(part, moved) <= (FIDELITY, 0.0)
    for edge in (edge for edge in part.faces[0].face.Edges if edge.Degenerated):
        trace = edge_traces(part.faces[0].face, edge, np.linspace(0, 1, 40))[0]
        at_pole = moved[0].evaluate(trace.uv, trace.points)
        assert np.ptp(at_pole, axis=0).max() < 1e-12


@pytest.mark.parametrize("shape", [sheet(), Part.makeCylinder(10, 30), Part.makeCone(12, 0, 25)],
                         ids=["sheet", "cylinder", "cone"])
def test_rebuilt_with_a_clean_certificate(shape):
    """Edge gaps ≤ 1e-4 mm, tolerance ≤ 1e-3 mm, same topology, valid, closed, no new Boolean error."""
    part = workpiece.read(shape)
    edited = len(part.faces) // 2
    displacement = lattice(part, edited, lambda points: 0.3 * bulge(points))
    result = rebuild(part, local_displacements(part, {edited: displacement}), 2e-5)
    before, after = boolean_checks((part.shape, result), 30)
    assert Certificate(condition(part.shape, before), condition(result, after)).problems() == []


def test_radial_field_reaches_its_tolerance_with_few_centres():
    """A quadratic over 100 mm to 1e-4 mm at all 900 points, and at points between as well as cubic accuracy gives."""
    x, y = np.meshgrid(np.linspace(0, 100, 30), np.linspace(0, 100, 30))
    points = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)

    def wanted(p):
        return np.stack([p[:, 0] * 0, p[:, 1] / 50, 2 * (p[:, 0] / 100) ** 2], axis=1)

    field = interpolate(points, wanted(points), np.full(900, 1e-4), 80.0, 900)
    assert len(field.centres) < 700
    assert np.linalg.norm(field(points) - wanted(points), axis=1).max() <= 1e-4
    between = np.random.default_rng(0).uniform((0, 0, 0), (100, 100, 0), (200, 3))
    assert np.linalg.norm(field(between) - wanted(between), axis=1).max() <= 1e-3
    assert not field(np.array([[0.0, 0.0, 80.0], [190.0, 50.0, 0.0]])).any()


def test_wendland_function_is_the_published_one():
    r = np.linspace(0, 1.2, 25)
    expected = np.where(r < 1, (1 - r) ** 6 * (35 * r**2 + 18 * r + 3) / 3, 0)
    np.testing.assert_allclose(wendland(r.copy()), expected, atol=1e-15)


def test_step_is_smooth_from_0_to_1():
    """Ends exact; third derivative continuous: its steps on a grid are at most 384, the fourth, times the step."""
    t = np.linspace(0, 1, 2001)
    values = smooth_step(t)
    assert values[0] == 0
    assert values[-1] == 1
    assert (np.diff(values) >= -1e-15).all()
    assert np.abs(np.diff(values, 4)).max() <= 384.0 / 2000**4 + 1e-14


def test_cutoff_is_exactly_0_on_the_edge_and_1_at_the_reach():
    length, reach = 50.0, 4.0
    count = int(np.ceil(length / (SPACING * reach))) + 1
    points = np.stack([np.linspace(0, length, count), np.zeros(count), np.zeros(count)], axis=1)
    steps = np.full(count, length / (count - 1))
    steps[[0, -1]] *= 0.5
    cutoff = Cutoff(points, steps, np.full(count, reach))
    along = np.random.default_rng(0).uniform(0, length, 300)

    def at(distance):
        return cutoff(np.stack([along, np.full(300, 0.6 * distance), np.full(300, 0.8 * distance)], axis=1))

    assert not at(0.0).any()
    assert not at(0.05 * reach).any()
    assert (at(reach) == 1).all()
    assert (at(2 * reach) == 1).all()
    assert np.ptp(at(0.5 * reach)[(along > 10) & (along < 40)]) < 1e-6


def test_even_odd_rule():
    square = np.array([(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)], dtype=float)
    hole = 1 + square / 2
    uv = np.array([(0.5, 0.5), (2, 2), (5, 2), (3.5, 2)])
    assert inside([square, hole], uv).tolist() == [True, False, False, True]
