# SPDX-License-Identifier: LGPL-2.1-or-later
"""The alignment from picked points: the pose they ask for, and the fine alignment that goes on from there."""
from __future__ import annotations

import FreeCAD
import numpy as np
import Part
import pytest
from scipy.spatial.transform import Rotation

from ffds_workbench.errors import InputError
from ffds_workbench.objects import actions, scans
from ffds_workbench.registration.rigid.point_pairs import pose_of_pairs

PLACES = np.array([[0.0, 0.0, 0.0], [60.0, 5.0, 0.0], [10.0, 25.0, 8.0]])


def far_pose() -> np.ndarray:
    """Half a turn and a metre away: no fine alignment finds back from there by itself."""
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_rotvec([2.6, 0.9, -0.4]).as_matrix()
    pose[:3, 3] = [900.0, -300.0, 150.0]
    return pose


def moved(pose: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ pose[:3, :3].T + pose[:3, 3]


def test_exact_pairs_give_the_exact_pose():
    pose = far_pose()
    assert pose_of_pairs(PLACES, moved(pose, PLACES)) == pytest.approx(pose, abs=1e-9)


@pytest.mark.parametrize("on_scan, on_part, words", [
    (PLACES[:2], PLACES[:2], "three or more"), (PLACES * [1, 0, 0], PLACES, "on a line"),
    (PLACES, PLACES * [0, 1, 0], "on a line"), (PLACES[[1, 0, 2]], PLACES, "same order"),
    (PLACES / 1000, PLACES, "unit of the scan")])
def test_pairs_that_make_no_pose_are_refused(on_scan, on_part, words):
    with pytest.raises(InputError, match=words):
        pose_of_pairs(on_scan, on_part)


@pytest.fixture
def example():
    document = FreeCAD.newDocument("manual_alignment_test")
    document.UndoMode = 1
    part, scan = actions.load_example(document)
    original = scans.scan_points(scan)
    yield part, scan, original
    FreeCAD.closeDocument(document.Name)


def test_picks_three_millimetres_off_are_enough_to_start_from(example):
    part, scan, original = example
    picked = original[[np.argmax(original @ direction) for direction in ([1, 1, 0], [-1, 1, 0], [0, -1, 1])]]
    scans.set_points(scan, moved(far_pose(), original))
    on_scan = moved(far_pose(), picked)
    by_hand = picked + np.random.default_rng(5).uniform(-3.0, 3.0, picked.shape)
    actions.align_by_points(part, scan, on_scan.tolist(), by_hand.tolist(), refine=False)
    rough = np.linalg.norm(scans.scan_points(scan) - original, axis=1).mean()
    scans.set_points(scan, moved(far_pose(), original))
    actions.align_by_points(part, scan, on_scan.tolist(), by_hand.tolist())
    fine = np.linalg.norm(scans.scan_points(scan) - original, axis=1).mean()
    # The scan shows a part that is up to 2 mm out of shape: the rigid pose is known to about as much.
    assert fine < 1.0 < rough < 10.0


def test_a_refused_start_leaves_the_scan_where_it_was(example):
    part, scan, original = example
    with pytest.raises(InputError):
        actions.align_by_points(part, scan, PLACES[:2].tolist(), PLACES[:2].tolist())
    assert scans.scan_points(scan) == pytest.approx(original)


def test_the_side_that_was_picked_is_kept():
    """A scan of one side of a flat plate fits its other side as well; only the picks tell."""
    document = FreeCAD.newDocument("sides_test")
    try:
        plate = document.addObject("Part::Feature", "Plate")
        plate.Shape = Part.makeBox(60, 40, 5)
        x, y = np.random.default_rng(0).uniform((0, 0), (60, 40), (8000, 2)).T
        bump = np.exp(-((x - 30) ** 2 + (y - 20) ** 2) / (2 * 12**2))
        noise = np.random.default_rng(1).normal(0, 0.05, 8000)
        for side in (5.0, 0.0):
            scan = scans.add_scan(document, np.stack([x + 75, y, 5 + bump + noise], axis=1), "scan")
            on_scan = np.array([[90.0, 12, 5], [117, 12, 5], [90, 28, 5]])
            on_part = on_scan - [75 + 3, 2, 5 - side]
            actions.align_by_points(plate, scan, on_scan.tolist(), on_part.tolist())
            points = scans.scan_points(scan)
            # The bump lifts the mean by 0.35 mm, and the rigid pose may settle anywhere within it.
            assert points[:, 2].mean() == pytest.approx(side, abs=0.5)
    finally:
        FreeCAD.closeDocument(document.Name)
