# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an alignment says to its user."""
from __future__ import annotations

import numpy as np
import Part

from ffds_workbench import api


def test_one_sided_scan_of_a_plain_plate_says_which_poses_and_what_to_do():
    """Its three half turns fit alike, and so does its other side, 3 mm away: nobody said from where it was seen."""
    top = np.column_stack([np.random.default_rng(0).uniform(0, (60, 40), (20_000, 2)), np.full(20_000, 3.0)])
    aligned = api.align_scan(Part.makeBox(60, 40, 3), top, "fine")
    text = aligned.table()
    assert aligned.alignment.verdict == "ambiguous"
    assert any(np.abs(pose.T_model_scan - np.eye(4)).max() < 0.1 for pose in aligned.alignment.poses)
    for words in ("turned by 180° about x", "turned by 180° about y", "turned by 180° about z", "mode fine"):
        assert words in text
