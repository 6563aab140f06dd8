# SPDX-License-Identifier: LGPL-2.1-or-later
"""A welded frame of 1.1 m: all seams that are reached from above, one after the other, nothing touched on the way."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ffds_workbench import api
from ffds_workbench.robot.planning.transfers import between

FRAME = Path(__file__).resolve().parents[3] / "shared" / "data" / "cases" / "g-frame" / "nominal.step"


def test_the_seams_of_a_frame_come_in_an_order_without_a_collision():
    if not FRAME.exists():
        pytest.skip("the folder ../shared/data is not there")
    plan = api.plan_seams(api.read_model(FRAME), auto=0.5)
    above = tuple(seam for seam in plan.seams if seam.stations.torch[:, 2, 2].max() < -0.3)
    assert len(above) == 11
    base = np.array([[0.0, -1.0, 0.0, 564.0], [1.0, 0.0, 0.0, -850.0], [0.0, 0.0, 1.0, -200.0], [0.0, 0.0, 0.0, 1.0]])
    cell = replace(api.read_cell("KR 8 R1440-2"), base=base)
    robot, planned = api.plan_robot(replace(plan, seams=above), cell)
    assert [seam.verdict for seam in robot.seams] == ["pass"] * 11 and len(planned.seams) == 11
    assert sorted(robot.order) == [(number, 0) for number in range(11)]
    at = None
    for number, part in robot.order:
        piece = robot.seams[number].pieces[part]
        if at is not None:
            passed = [at, *piece.way, piece.approach]
            for start, end in zip(passed[:-1], passed[1:], strict=True):
                assert robot.moving.all(between(start, end), 5.0).distances.min() >= cell.clearance
        at = piece.retract
