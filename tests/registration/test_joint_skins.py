# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which skin of a sheet a scan point shows, where the scan brings no normals."""
import numpy as np
import pytest

pytest.importorskip("FreeCAD")
import Part

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import JointSettings
from ffds_workbench.registration.joint.problem import make_problem
from ffds_workbench.registration.joint.skins import candidate_outward_normals


@pytest.mark.parametrize(("thickness", "noise", "density"), [(2.0, 0.12, 3.0), (3.0, 0.13, 6.0), (1.0, 0.05, 12.0)])
def test_both_skins_of_a_thin_sheet_are_told_apart(thickness, noise, density):
    """A plate of 120 × 100 mm twisted by 0.6 mm, both skins seen with as many points per mm² as sheets are scanned."""
    size = np.array([120.0, 100.0])
    random = np.random.default_rng(4)
    count = int(density * size.prod())
    upper = np.repeat([False, True], count)
    at = random.uniform(0, 1, (2 * count, 2))
    twist = 0.6 * (2 * at[:, 0] - 1) * (2 * at[:, 1] - 1)
    scan = np.column_stack([at * size, upper * thickness + twist]) + random.normal(0, noise, (2 * count, 3))
    problem = make_problem(joint_part(read(Part.makeBox(*size, thickness))), scan, JointSettings(), {})
    chosen = np.random.default_rng(problem.settings.seed).permutation(len(scan))[: len(problem.sample)]
    assert (scan[chosen] == problem.sample).all()
    sides, told = candidate_outward_normals(problem, 3.0)
    right = np.sign(sides[0][:, 2]) == np.where(upper[chosen], 1.0, -1.0)
    # Around the rims normals turn: a neighbourhood is half a thickness wide, and 0.6 are to the next point with one.
    assert len(sides) == 1 and not told and right.mean() > 1 - 1.1 * thickness * 2 * size.sum() / size.prod()
