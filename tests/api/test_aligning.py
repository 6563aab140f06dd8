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


def test_a_fine_alignment_stays_on_the_side_that_is_nearer():
    """One skin of a plate of 3 mm fits the other as well; the scan lies 0.8 mm from its own."""
    generator = np.random.default_rng(2)
    x, y = generator.uniform((0, 0), (80, 50), (20_000, 2)).T
    scan = np.stack([x, y, 2.2 + generator.normal(0, 0.05, len(x))], axis=1)
    found = api.align_scan(Part.makeBox(80, 50, 3), scan, mode="fine").alignment
    assert found.verdict == "ambiguous"
    # the noise of 0.05 mm over thousands of points, and a plate that may turn by a few of them over its width
    np.testing.assert_allclose(found.T_model_scan[2], [0, 0, 1, 0.8], atol=0.01)


def test_normals_turn_with_the_scan_and_are_written(tmp_path):
    """A box seen from three sides, moved: each normal is that of its side again, as far as the pose is known."""
    generator = np.random.default_rng(4)
    size, sides = np.array([60.0, 40.0, 20.0]), generator.integers(0, 3, 20_000)
    points, normals = generator.uniform(0, size, (20_000, 3)), np.eye(3)[sides]
    points[np.arange(20_000), sides] = size[sides]
    angle = np.deg2rad(5)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    scan = api.PointCloud(points @ turn.T + [1, -2, 0.5], normals=normals @ turn.T)
    aligned = api.align_scan(Part.makeBox(*size), scan, "fine")
    np.testing.assert_allclose(aligned.scan.normals, normals, atol=1e-3)
    api.write_alignment(aligned, tmp_path / "aligned.ply")
    np.testing.assert_allclose(api.read_scan(tmp_path / "aligned.ply").normals, aligned.scan.normals, atol=1e-12)
