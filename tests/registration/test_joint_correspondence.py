# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which cell a scan point belongs to and how high it lies, against a cylinder and a plate, where both are known."""
import numpy as np
import pytest

FreeCAD = pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings
from ffds_workbench.registration.joint.data import correspond
from ffds_workbench.registration.joint.problem import make_problem
from ffds_workbench.registration.joint.surfaces import normals

RADIUS, LENGTH = 20.0, 60.0


def frames_of(problem):
    return problem.frames(problem.cells.nominal)


def around(count, low, high, seed=0):
    """Angle, height along the axis and height above a cylinder of points at random, and the points."""
    random = np.random.default_rng(seed)
    angle, z, above = random.uniform([-np.pi, low, -0.5], [np.pi, high, 0.5], (count, 3)).T
    reach = RADIUS + above
    return angle, z, above, np.column_stack([reach * np.cos(angle), reach * np.sin(angle), z])


@pytest.fixture(scope="module")
def cylinder():
    part = joint_part(read(Part.makeCylinder(RADIUS, LENGTH)))
    return make_problem(part, around(20_000, 0.0, LENGTH)[3], JointSettings(), {})


def held_between(cylinder):
    """Heights in mm between which every place is farther from the border than the margin."""
    return cylinder.margin.max(), LENGTH - cylinder.margin.max()


def test_height_above_a_cylinder(cylinder):
    """h = R' − R; the second form takes off all but h φ²/2 · (1 + h/R) at an angle φ from the middle of the cell."""
    _, _, above, points = around(5000, *held_between(cylinder), seed=1)
    found = correspond(points, frames_of(cylinder), 1.0)
    cells_around = cylinder.lattices.faces[0].spans[0] * np.sqrt(cylinder.cells.inside.shape[1])
    assert len(found.point) == len(points)
    off = np.abs(found.height - above[found.point])
    assert off.max() < 0.5 / 2 * (np.pi / cells_around) ** 2 * (1 + 0.5 / RADIUS) * 1.01  # and higher orders


def test_points_beyond_the_gate_are_left_out(cylinder):
    _, _, above, points = around(5000, *held_between(cylinder), seed=2)
    found = correspond(points, frames_of(cylinder), 0.2)
    # Heights are off by 2e-4 mm at 0.2, see above; none of the seed's points lies so near the gate.
    assert set(found.point) == set(np.flatnonzero(np.abs(above) < 0.2))


@pytest.fixture(scope="module")
def plate():
    """A plate of 60 × 40 × 2 mm with a hole of 8 mm radius, scanned evenly on both skins."""
    shape = Part.makeBox(60.0, 40.0, 2.0).cut(Part.makeCylinder(8.0, 2.0, FreeCAD.Vector(30, 20, 0)))
    return make_problem(joint_part(read(shape)), on_skins(0.0, 30_000), JointSettings(), {})


def on_skins(shift, count):
    """Points of both skins, even over the whole rectangle, hole and all, moved by ``shift`` in mm: the upper ones
    first."""
    place = np.random.default_rng(3).uniform(0, [60, 40], (count, 2))
    return np.column_stack([place, np.repeat([2.0, 0.0], count // 2) + shift])


def test_no_point_counts_beyond_the_border_or_close_to_it(plate):
    points = on_skins(0.0, 6000)
    found = correspond(points, frames_of(plate), 1.0)
    from_hole = np.linalg.norm(points[:, :2] - [30, 20], axis=1) - 8.0
    from_sides = np.minimum(points[:, :2], [60, 40] - points[:, :2]).min(axis=1)
    distance, margin = np.minimum(from_hole, from_sides)[found.point], plate.margin.min()
    # The hole's pieces of a quarter of a cell differ from its circle by their sagitta.
    sagitta = (0.25 * largest_cell(plate)) ** 2 / (8 * 8.0)
    assert distance.min() > margin - 2 * sagitta
    # Round the hole a cell has its middle up to a diagonal away; beside the sides, those of the walls' small cells are
    # nearer to points within half a cell. The outermost row of cells holds points.
    side = largest_cell(plate)
    inside = np.flatnonzero((from_hole > margin + side * np.sqrt(2)) & (from_sides > margin + 0.5 * side))
    assert set(inside) <= set(found.point)
    assert (plate.distance.ravel()[found.cell] < 0.51 * side).any()


def normals_up(problem):
    """Component z of the outward normal of every cell, by its flat number."""
    return normals(problem.cells.nominal, problem.cells.outward)[0].reshape(-1, 3)[:, 2]


def largest_cell(problem):
    """The longer side of a cell in mm."""
    return float((problem.lattices.step * np.linalg.norm(problem.cells.nominal.tangents[:, 0], axis=2)).max()
                 / np.sqrt(problem.cells.inside.shape[1]))


@pytest.mark.parametrize("shift", [0.0, 1.4, 2.0, -1.6])
def test_points_keep_to_their_own_side_of_a_sheet(plate, shift):
    """However far the sheet has moved, by its thickness as well: what faces up is matched to the upper skin."""
    points = on_skins(shift, 6000)
    outward = np.column_stack([np.zeros((6000, 2)), np.repeat([1.0, -1.0], 3000)])
    found = correspond(points, frames_of(plate), 3.0, outward=outward)
    up = normals_up(plate)[found.cell]
    assert (np.abs(up) > 0.5).sum() > 0.75 * len(points)  # the rest lies over the hole and along borders, or on walls
    on_skin, facing = np.abs(up) > 0.5, outward[found.point, 2]
    assert (up * facing)[on_skin] == pytest.approx(1)
    # Up is out of the upper skin and into the lower one; planes have no second form.
    assert found.height[on_skin] == pytest.approx((shift * facing)[on_skin], abs=1e-9)


def test_the_wrong_side_is_found_without_normals(plate):
    """What the test above is good for."""
    found = correspond(on_skins(1.4, 6000), frames_of(plate), 3.0)
    up = normals_up(plate)[found.cell]
    assert ((up < -0.5) & (found.point < 3000)).sum() > 1000 or ((up > 0.5) & (found.point >= 3000)).sum() > 1000
