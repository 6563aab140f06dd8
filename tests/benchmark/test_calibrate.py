# SPDX-License-Identifier: LGPL-2.1-or-later
"""The calibration of the alignment's verdict: its families, its threshold, and one round of it."""
from __future__ import annotations

import numpy as np

from ffds_workbench.benchmark import calibrate
from ffds_workbench.benchmark.calibrate import OTHER, OWN, VARIANT, VerdictCase, least_certainty
from ffds_workbench.benchmark.simulated.other_parts import CALIBRATION, HELD_OUT
from ffds_workbench.benchmark.simulated.parts import FAMILIES


def test_families_are_used_for_nothing_else_and_give_solids():
    assert not set(CALIBRATION) & set(HELD_OUT) and not (set(CALIBRATION) | set(HELD_OUT)) & set(FAMILIES)
    for draw in (*CALIBRATION.values(), *HELD_OUT.values()):
        shape = draw(np.random.default_rng(5))
        assert shape.ShapeType == "Solid" and shape.isValid() and 60 < shape.BoundBox.DiagonalLength < 180


def test_threshold_is_what_one_of_a_hundred_right_poses_falls_short_of():
    cases = [VerdictCase("a", "a", "rigid", OWN, True, value, False) for value in np.linspace(0.8, 1.0, 101)]
    cases += [VerdictCase("a", "b", "rigid", OTHER, False, 0.3, True), VerdictCase("a", "a", "", OWN, False, 0.1, True)]
    assert abs(least_certainty(cases) - 0.802) < 1e-12


def test_every_part_meets_its_own_scans_other_parts_and_variants(monkeypatch):
    seen = []
    monkeypatch.setattr(calibrate, "_verdict", lambda part, other, condition, shows, seed: seen.append(
        (part, other, shows)))
    parts = [f"{family}{number}" for number in range(7) for family in "abcdef"]
    calibrate.verdicts([_Part(name) for name in parts], 6, lambda text: None)
    for part, other, shows in seen:
        assert (part is other) == (shows == OWN) and (part.family == other.family) == (shows != OTHER)
    assert [sum(shows == kind for *_, shows in seen) for kind in (OWN, OTHER, VARIANT)] == [210, 210, 84]


class _Part:
    """A part that has a family and no scans."""

    def __init__(self, name: str) -> None:
        self.name, self.family = name, name[0]
