# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances against FreeCAD's exact ones, and balls against the solids that they stand for."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest

from ffds_workbench.robot.arms import read_arm
from ffds_workbench.robot.cells import Torch
from ffds_workbench.robot.clearance import Box, Cylinder, MeshDistance, Moving, Surroundings, along, triangles_of

TRIANGLES, STANDS_OUT = 0.05, 0.2
"""How far the triangles may be off the faces, and a solid may stand out between its balls, in mm."""


@pytest.fixture(scope="module")
def part() -> Part.Shape:
    """A tube on a plate, and a wedge: curved faces, contacts and sharp edges."""
    plate, tube = Part.makeBox(80, 80, 8, FreeCAD.Vector(-40, -40, -8)), Part.makeCylinder(20, 40)
    wedge = Part.makeWedge(0, 0, 0, 5, 5, 20, 20, 20, 15, 15, FreeCAD.Vector(60, 0, 0))
    return Part.makeCompound([plate, tube.cut(Part.makeCylinder(17, 40)).Solids[0], wedge])


@pytest.fixture(scope="module")
def around(part) -> Surroundings:
    names = [f"Face{number}" for number in range(1, len(part.Faces) + 1)]
    return Surroundings(MeshDistance(triangles_of(part), np.zeros(len(names))), names)


def exact(shape: Part.Shape, points: np.ndarray) -> np.ndarray:
    """FreeCAD's distances, negative inside a solid."""
    found = []
    for point in points.tolist():
        vertex, at = Part.Vertex(*point), FreeCAD.Vector(*point)
        inside = [solid for solid in shape.Solids if solid.isInside(at, 1e-7, False)]
        found.append(-min(vertex.distToShape(solid.Shells[0])[0] for solid in inside) if inside
                     else vertex.distToShape(shape)[0])
    return np.array(found)


def test_distances_and_bounds(part, around):
    points = np.random.default_rng(1).uniform((-60, -60, -30), (90, 60, 70), (400, 3))
    truth = exact(part, points)
    assert (truth < 0).sum() > 10
    mesh = around._mesh
    distances, faces = mesh.exact(points)
    assert distances == pytest.approx(truth, abs=TRIANGLES)
    for distance, face, point in zip(distances, faces, points, strict=True):
        if distance > 0.0:
            assert Part.Vertex(*point).distToShape(part.Faces[face])[0] == pytest.approx(distance, abs=TRIANGLES)
    lower, upper = mesh.bounds(points)
    assert (lower <= np.abs(truth) + TRIANGLES).all() and (upper >= np.abs(truth) - TRIANGLES).all()


def test_balls_stand_for_their_solid(part, around):
    """Random capsules against FreeCAD's distance of their axis; none nearer than it is, and off by 0.2 mm at most."""
    rng = np.random.default_rng(2)
    for _ in range(25):
        start = rng.uniform((-50, -50, 45), (80, 50, 90))
        end = start + rng.normal(0.0, 25.0, 3) + (0.0, 0.0, 20.0)
        line = Part.makeLine(FreeCAD.Vector(*start), FreeCAD.Vector(*end))
        truth = line.distToShape(part)[0] - 8.0
        balls = along(start, end, 8.0)
        found = around.nearness(balls.centres[None], balls.radii, 200.0).distances[0]
        assert -TRIANGLES <= found - truth <= STANDS_OUT + TRIANGLES


def test_box_and_cylinder(part):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]], (5, 6, 7)
    shape = Part.makeBox(10, 20, 30)
    shape.transformShape(FreeCAD.Matrix(*pose.ravel()))
    points = np.random.default_rng(3).uniform(-30, 60, (100, 3))
    box = Box(np.zeros(3), np.array([10.0, 20.0, 30.0]), pose)
    assert box.distances(points) == pytest.approx(exact(Part.makeCompound([shape.Solids[0]]), points), abs=1e-6)
    axis = FreeCAD.Vector(1, 2, 2)
    shape = Part.makeCylinder(7, 30, FreeCAD.Vector(3, 4, 5), axis)
    cylinder = Cylinder(np.array([3.0, 4.0, 5.0]), np.array([13.0, 24.0, 25.0]), 7.0)
    assert cylinder.distances(points) == pytest.approx(exact(Part.makeCompound([shape]), points), abs=1e-6)


@pytest.mark.parametrize("stick_out", [15.0, 20.0])
def test_torch_in_a_corner(stick_out):
    """Upright walls 90° apart, the torch on their bisector: its rim is nearest, (stick-out − radius) · sin 45° away."""
    corner = Part.makeBox(100, 100, 100).cut(Part.makeBox(90, 100, 90, FreeCAD.Vector(10, 0, 10)))
    names = [f"Face{number}" for number in range(1, len(corner.Faces) + 1)]
    torch = Torch(stick_out=stick_out)
    moving = Moving(read_arm("UR10e"), np.eye(4), torch.tcp, torch.about_the_wire, torch.beside_the_wire,
                    Surroundings(MeshDistance(triangles_of(corner), np.zeros(len(names))), names))
    tip = np.eye(4)
    half = 0.5**0.5
    tip[:3, :3] = np.array([[0, 1, 0], [half, 0, -half], [-half, 0, -half]]).T
    tip[:3, 3] = 10, 50, 10
    found = moving.wire(tip[None], 50.0)
    assert found.distances[0] == pytest.approx((stick_out - torch.nozzle_radius) * half, abs=0.2)
    face = corner.Faces[names.index(moving.surroundings.name(int(found.what[0])))]
    assert face.distToShape(Part.Vertex(10, 50, 10))[0] < 1e-9


def test_faces_stand_out_by_their_bands(part):
    names = [f"Face{number}" for number in range(1, len(part.Faces) + 1)]
    bands = np.full(len(names), np.nan)
    bands[5] = 0.7
    around = Surroundings(MeshDistance(triangles_of(part), bands), names)
    top = part.Faces[5].CenterOfMass
    assert top.z == pytest.approx(0.0)
    ball = np.array([[[35.0, 35.0, 10.0]], [[-35.0, 0.0, -20.0]]])
    found = around.nearness(ball, np.array([2.0]), 50.0)
    assert found.distances == pytest.approx([10.0 - 2.0 - 0.7, 12.0 - 2.0], abs=TRIANGLES)
    assert around.name(int(found.what[0])) == "Face6"
