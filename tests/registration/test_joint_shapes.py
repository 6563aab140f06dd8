# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes that priors must not hold back: a sheet that shears, one that is rolled tightly, and edges in the scan."""
import numpy as np
import pytest

FreeCAD = pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings, register_joint
from ffds_workbench.registration.joint.problem import make_problem

NOISE, DENSITY = 0.1, 12.0


def plate(length, width, thickness):
    return joint_part(read(Part.makeBox(length, width, thickness)))


def faces_of(size, generator, *, walls):
    """Points on the upper and lower side of a box, and on its ends across x where ``walls`` says so."""
    sides = [(2, 0.0), (2, size[2])] + ([(0, 0.0), (0, size[0])] if walls else [])
    points = []
    for axis, value in sides:
        area = np.prod(np.delete(size, axis))
        here = generator.uniform(0, size, (int(DENSITY * area), 3))
        here[:, axis] = value
        points.append(here)
    return points


def edge_errors(part, result, warp):
    """Mean distance of every as-built edge from the warped nominal one, across it."""
    errors = []
    for nominal, found in zip(part.edges, result.edges, strict=True):
        truth = warp(nominal.points)
        along = np.gradient(truth, axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        off = found.points - truth
        errors.append(np.linalg.norm(off - (off * along).sum(axis=1, keepdims=True) * along, axis=1).mean())
    return np.array(errors)


def test_walls_of_a_sheet_that_shears():
    size = np.array([60.0, 40.0, 4.0])

    def warp(points):
        """Shifted along z by a parabola over x: up to 0.2 rad of slope, with the end walls left upright."""
        return points + np.column_stack([np.zeros((len(points), 2)), 3.0 * (points[:, 0] / 30 - 1) ** 2])

    generator = np.random.default_rng(0)
    scan = np.concatenate([warp(side) + NOISE * generator.normal(size=(len(side), 1)) * [[axis == 0, 0, axis == 2]]
                           for side, axis in zip(faces_of(size, generator, walls=True), (2, 2, 0, 0), strict=True)])
    part = plate(*size)
    result = register_joint(part, scan)
    # A wall has 40 × 4 mm² × 12 = 1900 points: 0.1 √(10/1900) = 0.007 mm, ten times that along an edge 4 mm from the
    # next. Kirchhoff's normals would be 0.2 mm off.
    assert edge_errors(part, result, warp).mean() < 0.06
    assert not result.isometric


def test_a_tight_roll_seen_from_both_sides():
    size, radius = np.array([75.0, 50.0, 2.0]), 80.0

    def warp(points):
        angle, height = (points[:, 0] - size[0] / 2) / radius, points[:, 2] - size[2] / 2
        return np.column_stack([size[0] / 2 + (radius - height) * np.sin(angle), points[:, 1],
                                size[2] / 2 + radius - (radius - height) * np.cos(angle)])

    generator = np.random.default_rng(1)
    scan = np.concatenate([warp(side) for side in faces_of(size, generator, walls=False)])
    scan[:, 2] += generator.normal(0, NOISE, len(scan))
    part = plate(*size)
    result = register_joint(part, scan)
    assert result.isometric
    assert result.thickness[0] == pytest.approx(size[2], abs=0.005)
    # The ends of the sheet are told by where the scan ends alone, to some 0.05 mm each.
    assert edge_errors(part, result, warp).mean() < 0.05


def test_the_end_of_the_scan_tells_the_edge():
    size, shift = np.array([60.0, 40.0, 3.0]), np.array([0.6, -0.5, 0.0])
    generator = np.random.default_rng(2)
    top = faces_of(size, generator, walls=False)[1] + shift
    top[:, 2] += generator.normal(0, NOISE, len(top))
    part = plate(*size)
    motion = register_joint(part, top).solids[0].T_asbuilt_nominal
    # Some 130 edge samples of 0.1 mm tell the shift; the prior on the pose (1 mm) leaves 1 % of it.
    assert motion[:3, 3] == pytest.approx(shift, abs=0.05)


def test_one_skin_alone_is_told_by_what_is_nearer():
    """A shifted plate of which one skin is seen and nothing beside it: the other skin explains the scan as well.

    Shifted inwards by less than 3/8 of the thickness the nearer skin is taken; by half of it too, but as a guess, with
    bands as wide as the sheet is thick, which hold wherever the truth is.
    """
    size, noise = (60.0, 50.0, 2.0), 0.05
    part, generator = plate(*size), np.random.default_rng(3)
    count = 20_000
    seen = np.column_stack([generator.uniform(1.5, size[0] - 1.5, count), generator.uniform(1.5, size[1] - 1.5, count),
                            np.full(count, size[2])]) + generator.normal(0, noise, (count, 3)) * [0, 0, 1]
    for shift, unsure in ((-0.5, 0.0), (-0.85, size[2]), (-1.0, size[2])):
        result = register_joint(part, seen + [0, 0, shift])
        assert result.unsure == pytest.approx(unsure)
        for face in result.faces:
            off = np.abs(face.displacement(face.uv)[:, 2] - shift)
            assert off.mean() < (0.02 if shift > -1.0 else size[2] + 0.02)
            assert (face.bands >= unsure).all()


@pytest.mark.parametrize(("shape", "count"), [(Part.makeCylinder(15, 80).cut(Part.makeCylinder(12, 80)), 1),
                                              (Part.makeSphere(20), 3), (Part.makeBox(40, 30, 20), 0),
                                              (Part.makeCylinder(15, 80).cut(Part.makeBox(20, 4, 80)), 0)],
                         ids=["pipe", "ball", "box", "keyed shaft"])
def test_what_slides_in_itself_is_known(shape, count):
    scan = np.random.default_rng(6).uniform(0, 40, (2000, 3))
    assert len(make_problem(joint_part(read(shape.Solids[0])), scan, JointSettings(), {}).free_motions.texts) == count


def test_a_pipe_stays_where_it_was_about_its_axis():
    """Bent by a millimetre: the mean of the movement about the axis, of which no scan tells, is zero."""
    part = joint_part(read(Part.makeCylinder(15, 80).cut(Part.makeCylinder(12, 80)).Solids[0]))
    random = np.random.default_rng(6)
    angle, height = random.uniform(0, 2 * np.pi, 30000), random.uniform(0, 80, 30000)
    radius = np.where(np.arange(30000) % 3, 15.0, 12.0) + random.normal(0, 0.05, 30000)
    scan = np.column_stack([radius * np.cos(angle) + (height / 40 - 1) ** 2, radius * np.sin(angle), height])
    result = register_joint(part, scan)
    assert result.free_motions == ("Solid1 can turn about (0.00, 0.00, 1.00)",)
    around, along = np.linspace(0, 2 * np.pi, 40, endpoint=False), np.arange(1, 80)
    angle, height = (grid.ravel() for grid in np.meshgrid(around, along))
    for face, field in zip(part.faces, result.displacements, strict=True):
        if face.kind == "Cylinder":
            moved = field(np.column_stack([angle, height]))
            # It turned by tenths of a millimetre; what is left is the mean over the ends.
            assert abs((moved[:, 1] * np.cos(angle) - moved[:, 0] * np.sin(angle)).mean()) < 0.01


def rounded_plate():
    plate = Part.makeBox(40, 30, 3)
    return plate.makeFillet(0.5, plate.Edges)


@pytest.mark.parametrize("shape", [rounded_plate, lambda: Part.makeCylinder(3.5, 200).cut(Part.makeCylinder(0.5, 200))],
                         ids=["rounds", "tight bend"])
def test_rounds_are_no_skins_and_bends_are(shape):
    """Half a thickness inside the round of an edge there is no surface that could keep its lengths; inside the outer
    side of a bend, however tight, there is."""
    shape = shape()
    scan = np.random.default_rng(0).uniform(0, 40, (2000, 3))
    sheets = make_problem(joint_part(read(shape)), scan, JointSettings(), {}).couplings.pairs
    assert sheets.solid_thickness[0] == pytest.approx(3, rel=0.01)
    assert set(np.flatnonzero(sheets.of_face)) == set(np.argsort([-face.Area for face in shape.Faces])[:2])
