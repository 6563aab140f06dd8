# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fields of separate faces that nearly agree close to a valid shape."""
import numpy as np
import pytest

pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.continuity.edge_closing import closing_displacements
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.brep.topology import edge_traces
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint.surfaces import build_lattices, solid_sizes, span_counts

MISMATCH = 2e-3
GAP = 1e-4


@pytest.fixture(scope="module")
def workpiece():
    box = Part.makeBox(50, 30, 4)
    return read(box.cut(Part.makeCylinder(6, 10, Part.Vertex(20, 15, -3).Point)))


def fields(workpiece, faces, common=(0.3, -0.2, 0.5)):
    """A common displacement plus a mismatch of each face's own."""
    geometry = tuple(workpiece.geometry(i) for i in range(len(workpiece.faces)))
    sizes = solid_sizes(geometry, [np.arange(len(geometry))])
    lattices = build_lattices(geometry, span_counts(geometry, sizes, 5.0, np.deg2rad(25), 1e-3))
    random = np.random.default_rng(4)
    points = MISMATCH / 3 * random.normal(size=(lattices.count, 3)) + np.array(common)
    return {index: lattices.spline(index, points) for index in faces}


def largest_gap(shape):
    """Largest distance of an edge's curve from the faces it bounds."""
    gap = 0.0
    fraction = np.linspace(0, 1, 41)
    for face in shape.Faces:
        for edge in face.Edges:
            for trace in edge_traces(face, edge, fraction):
                on_face = np.array([tuple(face.Surface.value(*uv)) for uv in trace.uv])
                gap = max(gap, np.linalg.norm(on_face - trace.points, axis=1).max())
    return gap


def test_all_faces_close(workpiece):
    displacements = closing_displacements(workpiece, fields(workpiece, range(len(workpiece.faces))))
    shape = rebuild(workpiece, displacements, 1e-5)
    assert shape.isValid() and shape.isClosed()
    assert largest_gap(shape) < GAP
    assert max(max(f.Surface.NbUPoles, f.Surface.NbVPoles) for f in shape.Faces) < 150


def test_edges_of_faces_that_stay_are_held(workpiece):
    displacements = closing_displacements(workpiece, fields(workpiece, [0, 1], common=(0, 0, 0)))
    staying = set(range(len(workpiece.faces))) - {0, 1}
    for face, displacement in displacements.items():
        for edge in workpiece.topology.face_edges[face]:
            if staying & set(workpiece.topology.edge_faces[edge]):
                for trace in edge_traces(workpiece.faces[face].face, workpiece.edges[edge], np.linspace(0, 1, 21)):
                    moved = displacement.evaluate(trace.uv, workpiece.faces[face].at(trace.uv))
                    # The fidelity of the correction, which is what the rebuild takes for standing still.
                    assert np.linalg.norm(moved, axis=1).max() < 1e-5
