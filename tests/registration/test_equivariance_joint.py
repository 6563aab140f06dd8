# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint solve gives the same shape in any unit, any frame and any order, and of a mirrored part the mirrored one.

The solve has no length of its own: in another unit all its steps are the same to rounding, 1e-4 of the noise with all
that the lattices' condition makes of it. In another frame or order it draws other points for its first steps. It stops
when a step is below 0.2 of the noise, and so far apart may two ways to the same shape end.
"""
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("FreeCAD")
import FreeCAD
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings, register_joint
from ffds_workbench.registration.motions import apply

NOISE, THICKNESS, DENSITY = 0.05, 3.0, 3.0
TURNED = np.array(FreeCAD.Rotation(FreeCAD.Vector(1, 2, 3), 77).toMatrix().A).reshape(4, 4)
STOPS = JointSettings().schedule[-1].enough
PLACES = np.array([0.2, 0.5, 0.8])


def bracket():
    """An angle of sheet with a hole, 60 × 40 × 30 mm."""
    base = Part.makeBox(60, 40, THICKNESS).fuse(Part.makeBox(THICKNESS, 40, 30)).removeSplitter()
    return base.cut(Part.makeCylinder(6, 20, FreeCAD.Vector(35, 18, -5))).Solids[0]


def scan_of(shape):
    """Random points on the sides that look up and to +x, moved by a bend and a twist, with noise along them."""
    random = np.random.default_rng(4)
    vertices, triangles = shape.tessellate(0.05)
    corners = np.array([tuple(v) for v in vertices])[np.array(triangles)]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.linalg.norm(normal, axis=1)
    seen = np.where(normal @ [1.0, 0.3, 1.2] > 0.1 * area, area, 0.0)
    chosen = random.choice(len(corners), int(DENSITY * seen.sum()), p=seen / seen.sum())
    weight = random.dirichlet(np.ones(3), len(chosen))
    points = np.einsum("nc,ncx->nx", weight, corners[chosen])
    points += (random.normal(0, NOISE, len(chosen)) / (2 * area[chosen]))[:, None] * normal[chosen]
    x, y, z = points.T
    return points + np.column_stack([0.02 * z, 4e-4 * z * x, 3e-4 * (x - 20) ** 2 + 2e-4 * x * y])


@pytest.fixture(scope="module")
def case():
    shape = bracket()
    return joint_part(read(shape)), scan_of(shape)


def mapped(part, function):
    """The part with its points mapped by an affine function."""
    faces = tuple(replace(face, surface=replace(face.surface, control_points=function(
        face.surface.control_points.reshape(-1, 3)).reshape(face.surface.control_points.shape))) for face in part.faces)
    return replace(part, faces=faces, edges=tuple(replace(edge, points=function(edge.points)) for edge in part.edges))


def as_built(part, scan):
    """Places on all faces of the result: (faces, 9, 3)."""
    result, places = register_joint(part, scan), []
    for face, field in zip(part.faces, result.displacements, strict=True):
        u0, u1, v0, v1 = face.surface.range
        uv = np.stack(np.meshgrid(u0 + PLACES * (u1 - u0), v0 + PLACES * (v1 - v0)), axis=-1).reshape(-1, 2)
        places.append(face.surface(uv) + field(uv))
    return np.array(places)


@pytest.fixture(scope="module")
def found(case):
    return as_built(*case)


@pytest.mark.parametrize("scale", [0.1, 0.3, 3.0, 10.0, 30.0])
def test_in_any_size(case, found, scale):
    part, scan = case
    other = as_built(mapped(part, lambda points: scale * points), scale * scan) / scale
    assert np.abs(other - found).max() < 1e-4 * NOISE


def test_in_any_frame(case, found):
    part, scan = case
    motion = TURNED.copy()
    motion[:3, 3] = 3000.0, -1200.0, 800.0
    other = as_built(mapped(part, lambda points: apply(motion, points)), apply(motion, scan))
    assert np.abs(apply(np.linalg.inv(motion), other.reshape(-1, 3)).reshape(other.shape) - found).max() < STOPS * NOISE


def test_in_any_order_of_the_points(case, found):
    part, scan = case
    other = as_built(part, scan[np.random.default_rng(1).permutation(len(scan))])
    assert np.abs(other - found).max() < STOPS * NOISE


def test_in_any_order_of_the_faces(case, found):
    part, scan = case
    order = np.random.default_rng(2).permutation(len(part.faces))
    number = np.argsort(order)
    edges = tuple(replace(edge, faces=tuple(int(number[face]) for face in edge.faces)) for edge in part.edges)
    other = replace(part, faces=tuple(part.faces[k] for k in order), edges=edges,
                    solids=tuple(np.sort(number[solid]) for solid in part.solids))
    assert np.abs(as_built(other, scan) - found[order]).max() < STOPS * NOISE


def test_of_a_mirrored_part(case, found):
    part, scan = case
    mirror = np.array([-1.0, 1.0, 1.0])
    other = mapped(part, lambda points: mirror * points)
    faces = tuple(replace(face, outward=-face.outward) for face in other.faces)
    edges = tuple(replace(edge, left=tuple(not left for left in edge.left)) for edge in other.edges)
    other = replace(other, faces=faces, edges=edges)
    assert np.abs(mirror * as_built(other, mirror * scan) - found).max() < STOPS * NOISE
