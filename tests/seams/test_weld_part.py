# SPDX-License-Identifier: LGPL-2.1-or-later
"""The real weld part: a pipe on a plate between two flats, four solids."""
from __future__ import annotations

import numpy as np
import Part
import pytest

from ffds_workbench.seams.plan import plan_seams


@pytest.fixture(scope="module")
def part(shared_data):
    return Part.read(str(shared_data / "weld_pipe_on_angle" / "nominal.step"))


def test_pipe_on_plate(part):
    """The plate's cut corner leaves 267° of the outer circle on it; radius 44.45, its centre 30.5 from the cut."""
    (seam,) = plan_seams(part, ["Edge42"], auto=0.1).seams
    distance = np.hypot(*(np.array([57.15, 57.15]) - seam.stations.positions[:, :2]).T)
    assert distance == pytest.approx(44.45, abs=1e-6)
    cut = abs(2 * 57.15 - (12.7 + 58.42)) / 2**0.5
    assert seam.stations.length == pytest.approx(44.45 * (2 * np.pi - 2 * np.arccos(cut / 44.45)), abs=0.1)
    assert seam.stations.torch[:, 2, 2] == pytest.approx(-(0.5**0.5), abs=1e-6)
    assert {stretch.kind for stretch in seam.stations.seam.stretches} == {"pipe"}


def test_plate_between_the_flats(part):
    found = plan_seams(part, auto=0.1).seams
    kinds = {seam.name: seam.stations.seam.kind for seam in found}
    # Plate on flat from above and below, on both flats; the flats butt against each other.
    assert [kinds[name] for name in ("Edge26", "Edge28", "Edge35", "Edge37")] == ["T"] * 4
    assert kinds["Edge22"] == "butt"


def test_deformed_by_a_known_warp(part, tools):
    built = tools.warped(part, tools.bumpy)
    (seam,) = plan_seams(built, ["Edge42"], auto=0.1, nominal=part).seams
    truth = tools.truth_of(tools.bumpy, seam.nominal)
    assert np.linalg.norm(seam.stations.positions - truth.points, axis=1).max() < 1e-4
    assert tools.degrees_between(seam.stations.bisector, truth.frames).max() < 0.02
    # At both ends the edge reaches over the plate's border by the 0.01 mm to which the border is sought.
    assert np.abs(seam.stations.gap).max() < 0.011
