# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places of a nominal model and of a STEP file that has edges and faces turned mark the same material points.

The rebuilt shape, which keeps the nominal's parameters, is the truth.
"""
from __future__ import annotations

import numpy as np
import Part
import pytest

from ffds_workbench.benchmark.simulated import topology_shapes
from ffds_workbench.brep import topology, workpiece
from ffds_workbench.brep.model_files import model_file
from ffds_workbench.brep.model_files.model_file import Model
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.seams.pairing import paired_face, paired_fractions
from ffds_workbench.seams.weldment import Weldment

READERS_MOVE = 1e-4
"""STEP readers begin and end edges where their vertices are nearest (mm)."""
WORLD = ("so_WaveShare_Mounting_Plate_SO101.step", "occ_bug24595_281390.stp", "odri_lower_leg_structure_fork.STEP")


def _triple(shape: Part.Shape, folder) -> tuple[Weldment, Weldment, Weldment]:
    """The nominal model, the rebuilt shape, and its STEP file as it reads back."""
    part = workpiece.read(shape)
    rebuilt = rebuild(part, topology_shapes.warp(part), 1e-5)
    model_file.write(Model(rebuilt, "part"), folder / "part.step")
    return Weldment.of(shape), Weldment.of(rebuilt), Weldment.of(Part.read(str(folder / "part.step")))


def _check(nominal: Weldment, rebuilt: Weldment, file: Weldment) -> None:
    at = np.array([0.2, 0.3, 0.9])
    for edge in range(len(nominal.edges)):
        if not nominal.topology.degenerate[edge]:
            there = topology.points_on_edge(file.edges[edge], paired_fractions(nominal, file, edge, at))
            assert np.abs(there - topology.points_on_edge(rebuilt.edges[edge], at)).max() < READERS_MOVE
    for face, own in enumerate(nominal.faces):
        paired = paired_face(nominal, file, face)
        u0, u1, v0, v1 = own.ParameterRange
        for a, b in ((0.3, 0.4), (0.8, 0.6)):
            u, v = u0 + a * (u1 - u0), v0 + b * (v1 - v0)
            there = file.faces[face].Surface.value(*paired.uv(u, v))
            assert there.distanceToPoint(rebuilt.faces[face].Surface.value(u, v)) < READERS_MOVE


@pytest.mark.parametrize("shape", [lambda: Part.makeBox(40, 30, 20), lambda: Part.makeSphere(15),
                                   lambda: Part.makeTorus(20, 5), lambda: Part.makeCone(12, 0, 25)],
                         ids=["box", "sphere", "torus", "cone"])
def test_places_are_the_same_material_points(shape, tmp_path):
    models = _triple(shape(), tmp_path)
    _check(*models)


def test_a_box_has_edges_and_faces_turned(tmp_path):
    nominal, _, file = _triple(Part.makeBox(40, 30, 20), tmp_path)
    assert nominal.topology.edge_starts != file.topology.edge_starts
    assert nominal.topology.reversed_faces != file.topology.reversed_faces


@pytest.mark.parametrize("name", WORLD)
def test_places_of_real_parts(shared_data, name, tmp_path):
    models = _triple(Part.read(str(shared_data / "world" / name)), tmp_path)
    _check(*models)
