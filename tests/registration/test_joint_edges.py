# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges in the joint solve: on which side of them their faces lie, and poles, where there is no angle."""
import numpy as np
import pytest

pytest.importorskip("FreeCAD")
import Part
from FreeCAD import Vector

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.topology import edge_traces
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings, register_joint
from ffds_workbench.registration.joint.problem import make_problem

NOISE = 0.08


def half_capsule():
    """A cylinder with a hemisphere, cut through its axis: two edges end in the pole, one of them a former seam."""
    capsule = Part.makeCylinder(10, 30).fuse(Part.makeSphere(10, Vector(0, 0, 30))).removeSplitter()
    return capsule.common(Part.makeBox(40, 40, 80, Vector(-20, 0, -20))).Solids[0]


def slit_plate():
    """A plate with a slit of 0.3 mm, whose bottom is narrower than a cell."""
    return Part.makeBox(50, 40, 2).cut(Part.makeBox(0.3, 0.3, 2, Vector(20, 0, 0))).Solids[0]


def rounded_box():
    """A box with all edges and corners rounded."""
    box = Part.makeBox(40, 30, 15)
    return box.makeFillet(4, box.Edges)


SHAPES = {"half capsule": half_capsule, "slit plate": slit_plate, "rounded box": rounded_box,
          "cavity": lambda: Part.makeBox(40, 40, 80, Vector(-20, -20, -20)).cut(half_capsule()).Solids[0],
          "tube": lambda: Part.makeCylinder(10, 30).cut(Part.makeCylinder(8, 30))}


def scan_of(shape, count, seed=1):
    """Points all over a shape with noise along its normals."""
    vertices, triangles = (np.array(item, dtype=float) for item in shape.tessellate(0.01))
    a, b, c = vertices[triangles.astype(int)].swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1)
    random = np.random.default_rng(seed)
    k = random.choice(len(area), count, p=area / area.sum())
    s, t = np.sqrt(random.random((count, 1))), random.random((count, 1))
    at = (1 - s) * a[k] + s * (1 - t) * b[k] + s * t * c[k]
    return at + random.normal(0, NOISE, (count, 1)) * normal[k] / area[k, None]


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_sides_of_edges_are_those_of_the_shape(shape):
    """OCCT's own distance: a step off an edge into a face stays on it, and a step out of it leaves it."""
    shape, step = shape(), 0.01
    problem = make_problem(joint_part(read(shape)), scan_of(shape, 2000), JointSettings(), {})
    edges = problem.couplings.edges
    for side, sign in ((edges.first, problem.sides.sign[0]), (edges.second, problem.sides.sign[1])):
        out = sign[:, None] * np.cross(edges.direction, side.nominal_normals)
        for k in np.flatnonzero(edges.angled & (edges.first.face != edges.second.face))[5::11]:
            face = shape.Faces[side.face[k]]
            inwards, outwards = (face.distToShape(Part.Vertex(*(side.nominal[0, k] + way * step * out[k])))[0]
                                 for way in (-1, 1))
            # Off by the curvature alone, step² / 2R with radii of 4 mm and more, at the slit's corners by its end.
            assert inwards < 0.1 * step < 0.9 * step < outwards, (edges.edge[k], face.Surface)


def test_sides_do_not_hang_on_the_lattice():
    shape = slit_plate()
    part, scan = joint_part(read(shape)), scan_of(shape, 20000)
    coarse, fine = (make_problem(part, scan, JointSettings(), dict.fromkeys(range(len(part.faces)), finer))
                    for finer in (1, 3))
    assert (coarse.sides.sharp == fine.sides.sharp).all() and (coarse.sides.sign == fine.sides.sign).all()


@pytest.mark.parametrize(("name", "uses"), [("half capsule", 1), ("cavity", 1), ("tube", 2)])
def test_a_former_seam_is_no_seam(name, uses):
    """Booleans leave the far curve of a seam in the file; a face has an edge as often as its wires do."""
    shape = SHAPES[name]()
    traces = [len(edge_traces(face, edge, np.linspace(0, 1, 5))) for face in shape.Faces for edge in face.Edges]
    assert max(traces) == uses


@pytest.mark.parametrize("shape", [half_capsule, rounded_box])
def test_poles_do_not_pull(shape):
    """Undeformed parts whose edges end in the poles of spheres stay where they are."""
    shape = shape()
    part = joint_part(read(shape))
    result = register_joint(part, scan_of(shape, 30000))
    off = np.concatenate([np.linalg.norm(face.displacement(face.uv), axis=1) for face in result.faces])
    # σ √(dof/n): some 300 degrees of freedom and 30,000 points leave 0.008 mm rms, priors some less; three times that.
    assert off.mean() < 3 * NOISE * np.sqrt(300 / 30000)


def test_a_narrow_wall_that_is_seen_is_no_end_of_the_scan():
    """The points of a wall of 1 mm lie within four times the noise beside the skins' edges: no border is drawn through
    the outermost of them."""
    size = np.array([40.0, 25.0, 1.0])
    part = joint_part(read(Part.makeBox(*size)))
    scan = scan_of(Part.makeBox(*size), 30000)
    result = register_joint(part, scan)
    for face, geometry in zip(result.faces, part.faces, strict=True):
        place = geometry.surface(face.uv)
        axis = int(np.argmin(np.ptp(place, axis=0)))
        outwards = np.sign(place[:, axis].mean() - size[axis] / 2) * face.displacement(face.uv)[:, axis].mean()
        # Half of a wall's points lie within its margin: the mean of so many is sure to σ / √n; four times that.
        assert abs(outwards) < 4 * NOISE / np.sqrt(max(face.points, 1)), face.name
