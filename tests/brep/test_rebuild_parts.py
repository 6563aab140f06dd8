# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rebuild on real CAD files, which are not clean: what counts is what the rebuild adds to the nominal's own gaps.

The large files of the folder take minutes and are left to ``./ffds benchmark topology``.
"""
from __future__ import annotations

import importlib.util
from pathlib import Path

import Part
import pytest

from ffds_workbench.brep import workpiece
from ffds_workbench.brep.rebuild import rebuild
from ffds_workbench.compat import write_step

_spec = importlib.util.spec_from_file_location("test_rebuild", Path(__file__).with_name("test_rebuild.py"))
shared_checks = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(shared_checks)

PARTS = ["parts/Ball.brep", "parts/Pump_Nut.brep", "parts/Pump_TopCover.brep",
         "parts/revolved_sphere.step", "parts/screw.step", "parts/sliced_cylinder.step", "parts/tet.step",
         "weld_pipe_on_angle/nominal.step", "cases/a-iso/nominal.step", "cases/b-springback/nominal.step",
         "cases/c-springback/nominal.step", "cases/d-bumps/nominal.step", "cases/e-twist/nominal.step",
         "cases/f-bend/nominal.step"]
SAMPLES = 65


@pytest.mark.parametrize("name", PARTS)
def test_a_warp_of_the_whole(name, shared_data, tmp_path):
    nominal = Part.read(str(shared_data / name))
    displacement = shared_checks.warp(nominal)
    result = rebuild(workpiece.read(nominal), shared_checks.everywhere(nominal, displacement))
    shared_checks.assert_same_topology(result, nominal)
    own = shared_checks.gap(nominal, SAMPLES)
    assert shared_checks.gap(result, SAMPLES) < min(2 * (own + shared_checks.GAP), own + 1e-4)
    # Where the nominal gapes beyond its tolerance, its gap is the line.
    assert shared_checks.tolerance(result) <= max(shared_checks.tolerance(nominal), 1e-3, own + 1e-4)
    write_step(result, tmp_path / "result.step")
    back = Part.read(str(tmp_path / "result.step"))
    assert back.isValid()
