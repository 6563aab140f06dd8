# SPDX-License-Identifier: LGPL-2.1-or-later
"""The numbers of the live preview, without a window: coarse ones lie near the exact ones, and follow the settings.

The scan is a bump of 1 mm on a plate with a noise of 0.02 mm, which bounds what is left after the deformation.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np
import Part
import pytest

from ffds_workbench.gui.preview.patches import Preview, figures
from ffds_workbench.objects.job import Settings
from ffds_workbench.scan.cloud import PointCloud

NOISE = 0.02


def told(text: str) -> None:
    """Nobody listens."""


@pytest.fixture(scope="module")
def preview() -> Preview:
    random = np.random.default_rng(1)
    x, y = random.uniform((0, 0), (60, 40), (20000, 2)).T
    z = 5 + np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2)) + random.normal(0, NOISE, 20000)
    return Preview(Part.makeBox(60, 40, 5), PointCloud(np.stack([x, y, z], axis=1)))


@pytest.mark.parametrize("settings", [Settings(faces=("Face6",)), Settings()])
def test_coarse_and_exact_agree_to_the_noise(preview, settings):
    exact = preview.patches(settings, False, told)
    coarse = preview.patches(settings, True, told)
    for patches in (exact, coarse):
        before, _, after, p95, coverage = figures(patches)
        assert before > 0.2 and after < 2 * NOISE and p95 < 4 * NOISE and coverage > 0.1
    top = [next(patch for patch in patches if patch.name == "Face6").points for patches in (exact, coarse)]
    # Heights: how the top slides in itself one side of a plate hardly tells, and the coarse one leaves out what does.
    off = np.abs(top[0] - top[1])[:, 2]
    assert off.max() < 0.25 and off.mean() < 2 * NOISE


def test_a_stiff_part_stays_off_the_scan_and_comes_back(preview):
    soft, stiff = Settings(), Settings(stiffness=1e4)
    first = figures(preview.patches(soft, True, told))[2]
    for _ in range(4):
        off = figures(preview.patches(stiff, True, told))[2]
    assert off > 2 * first
    for _ in range(4):
        back = figures(preview.patches(soft, True, told))[2]
    assert back == pytest.approx(first, rel=0.1)


def test_frozen_faces_do_not_move(preview):
    patches = preview.patches(replace(Settings(), freeze=("Face5",)), True, told)
    bottom = next(patch for patch in patches if patch.name == "Face5")
    assert np.abs(bottom.points[:, 2]).max() < 1e-6
