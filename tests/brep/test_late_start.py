# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pcurves that start late: the STEP file of a rebuilt part passes the check for Boolean operations.

OCCT's own check of the shape read back is the truth.
"""
from __future__ import annotations

from pathlib import Path

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from ffds_workbench.benchmark.simulated import topology_shapes
from ffds_workbench.benchmark.simulated.families import through_step
from ffds_workbench.benchmark.simulated.parts import FAMILIES
from ffds_workbench.brep import workpiece
from ffds_workbench.brep.continuity.local_field import local_displacements
from ffds_workbench.brep.edges import PlacedCurve, Trace
from ffds_workbench.brep.model_files import model_file
from ffds_workbench.brep.model_files.model_file import Model
from ffds_workbench.brep.occt_text.curves import Line, Spline
from ffds_workbench.brep.occt_text.pcurves import Pcurve
from ffds_workbench.brep.pcurve_start import delay_pcurve_start
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.registration.splines import SplineSurface, clamped_knots


def _angle(folder: Path) -> Part.Shape:
    """An angle with a rounded inside corner and a bore through either wall, as it reads back from STEP."""
    angle = Part.makeBox(60, 40, 3).fuse(Part.makeBox(3, 40, 50)).removeSplitter()
    corner = next(edge for edge in angle.Edges if edge.CenterOfMass.distanceToPoint(Vector(3, 20, 3)) < 1e-6)
    angle = angle.makeFillet(4, [corner])
    angle = angle.cut(Part.makeCylinder(6, 20, Vector(35, 20, -5)))
    angle.cut(Part.makeCylinder(5, 20, Vector(-5, 20, 28), Vector(1, 0, 0))).exportStep(str(folder / "nominal.step"))
    return Part.read(str(folder / "nominal.step"))


@pytest.mark.parametrize("mode", ["one face", "all"])
def test_step_file_passes_the_boolean_check(mode, tmp_path):
    part = workpiece.read(_angle(tmp_path))
    if mode == "all":
        result = rebuild(part, topology_shapes.warp(part), 1e-5)
    else:
        face = topology_shapes.busiest_and_middle(part)[0]
        moved = local_displacements(part, {face: topology_shapes.bump(part.faces[face])})
        result = rebuild(part, moved, 1e-5)
    model_file.write(Model(result, "angle"), tmp_path / "angle.step")
    back = Part.read(str(tmp_path / "angle.step"))
    back.check(True)


def test_step_file_of_a_free_form_panel_passes_the_boolean_check(tmp_path):
    """Its long edges gape most on the face whose pcurve readers make anew, and worse, unless it is the late one."""
    panel = through_step(FAMILIES["free-form-panel"](np.random.default_rng(3))).shape
    part = workpiece.read(panel)
    model_file.write(Model(rebuild(part, topology_shapes.warp(part), 1e-5), "panel"), tmp_path / "panel.step")
    Part.read(str(tmp_path / "panel.step")).check(True)


def test_the_start_has_the_largest_distance():
    flat = SplineSurface(clamped_knots(0, 10, 4), clamped_knots(0, 10, 4),
                         np.stack(np.meshgrid(*[[0, 10 / 3, 20 / 3, 10]] * 2, [0.0], indexing="ij"), axis=-1)[:, :, 0])
    pcurve = Pcurve(Line(np.array([0.0, 5.0]), np.array([1.0, 0.0])), 0.0, 10.0, "")
    # A cubic that leaves the line by up to 0.75 e-5 mm, most between the reader's parameters.
    poles = np.array([[0, 5, 0], [10 / 3, 5, 1e-5], [20 / 3, 5, 1e-5], [10, 5, 0]])
    curve = PlacedCurve(Spline(3, np.repeat([0.0, 10.0], 4), poles, False, False), np.eye(4), 0.0, 10.0)
    later = delay_pcurve_start(Trace(flat, pcurve), curve, 0.75e-5, np.array([0.0, 5.0, 0.0]))
    distance = np.linalg.norm(later.at(np.linspace(0, 1, 5001)) - curve.at(np.linspace(0, 1, 5001)), axis=1)
    assert distance.argmax() == 0
    assert distance[0] == pytest.approx(1.3 * 0.75e-5, rel=1e-3)
    assert np.abs(later.at(np.linspace(0, 1, 101))[:, 1:] - [5.0, 0.0]).max() < 1e-12  # along itself


def test_an_edge_that_gapes_starts_where_it_did():
    flat = SplineSurface(clamped_knots(0, 10, 4), clamped_knots(0, 10, 4),
                         np.stack(np.meshgrid(*[[0, 10 / 3, 20 / 3, 10]] * 2, [0.0], indexing="ij"), axis=-1)[:, :, 0])
    line = Line(np.array([0.0, 5.0]), np.array([1.0, 0.0]))
    own = PlacedCurve(Line(np.array([0.0, 5.0, 1e-3]), np.array([1.0, 0.0, 0.0])), np.eye(4), 0.0, 10.0)
    assert delay_pcurve_start(Trace(flat, Pcurve(line, 0.0, 10.0, "")), own, 1e-3, np.array([0.0, 5.0, 1e-3])) is None
