# SPDX-License-Identifier: LGPL-2.1-or-later
"""The rooms of the alignment that decide, each by itself: proposals, evidence, verdict; and that no length is fixed.

Scans are drawn on shapes whose faces are known: a box, a plate, an L of two boxes. Truth is their geometry and the
motion that the test applies.
"""
from __future__ import annotations

from dataclasses import replace

import FreeCAD
import numpy as np
import Part
import pytest
from scipy.spatial.transform import Rotation

from ffds_workbench.brep import workpiece
from ffds_workbench.registration.motions import angle, apply, motion, shift
from ffds_workbench.registration.rigid import (AMBIGUOUS, FAILED, OK, RigidSettings, VerdictSettings, align, target_of)
from ffds_workbench.registration.rigid.evidence import Evidence, UnalignedScan, match_scan, weigh_match
from ffds_workbench.registration.rigid.search import propose, starts_of
from ffds_workbench.registration.rigid.verdict import Answer, alignment_of
from ffds_workbench.registration.scan_points import Sketch, TablePlane, sketch_of

A, B, C = 60.0, 40.0, 20.0
UP = np.array([0.0, 0.0, 1.0])


def target(shape: Part.Shape):
    part = workpiece.read(shape)
    return target_of([part.geometry(k) for k in range(len(part.faces))])


@pytest.fixture(scope="module")
def box():
    return target(Part.makeBox(A, B, C))


def step_shape(scale: float = 1.0) -> Part.Shape:
    """Two boxes that no motion maps onto themselves."""
    shape = Part.makeBox(70, 50, 8).fuse(Part.makeBox(20, 30, 35)).removeSplitter()
    shape.scale(scale)
    return shape


def step_scan(count: int = 20_000, noise: float = 0.1) -> np.ndarray:
    """Points on its faces but the lower one."""
    rng = np.random.default_rng(0)
    drawn = []
    for low, high in (((20, 0, 8), (70, 50, 8)), ((0, 30, 8), (20, 50, 8)), ((0, 0, 35), (20, 30, 35)),
                      ((20, 0, 8), (20, 30, 35)), ((0, 30, 8), (20, 30, 35)), ((70, 0, 0), (70, 50, 8)),
                      ((0, 0, 0), (0, 30, 35)), ((0, 0, 0), (20, 0, 35)), ((20, 0, 0), (70, 0, 8))):
        sides = np.sort(np.subtract(high, low))[1:]
        drawn.append(rng.uniform(low, high, (int(count * sides.prod() / 6000), 3)))
    points = np.concatenate(drawn)
    return points + rng.normal(0.0, noise, points.shape)


def sketch(points: np.ndarray, normals: np.ndarray) -> Sketch:
    """A sketch without noise."""
    return Sketch(points, normals, np.zeros(len(points), dtype=np.intp), 0.0, points, points)


def top(count: int) -> np.ndarray:
    return np.column_stack([np.random.default_rng(1).uniform(0, (A, B), (count, 2)), np.full(count, C)])


def weighed(part, points: np.ndarray, normals: np.ndarray, table: TablePlane | None = None, rounds=()) -> Evidence:
    scan = UnalignedScan(part, sketch(points, normals), table)
    return weigh_match(scan, np.eye(4), normals, match_scan(scan, np.eye(4), normals, rounds)[0])


def test_what_is_explained_is_the_share_that_lies_on_the_part(box):
    """A fifth of the points float 10 mm above; without noise the misfit is their share, as it is capped."""
    points = top(2000)
    points[:400] += 10.0 * UP
    found = weighed(box, points, np.tile(UP, (2000, 1)))
    assert found.explained == 0.8 and found.misfit == pytest.approx(0.2, abs=1e-6)


def test_normals_that_face_into_the_part_explain_nothing(box):
    points = top(500)
    found = weighed(box, points, np.tile(-UP, (500, 1)))
    assert found.explained == 0.0 and found.coverage == 0.0 and found.score < 0.0


def test_coverage_is_the_share_of_the_surface(box):
    """The top alone, to the 2 % of a binomial share of 2,500 samples and what reaches round its edges by 2.5 % of the
    box's size: 2 mm of a circumference of 200 mm."""
    total = 2 * (A * B + B * C + A * C)
    found = weighed(box, top(4000), np.tile(UP, (4000, 1)))
    assert found.coverage == pytest.approx(A * B / total, abs=0.02)
    # a camera a little off the vertical sees two walls as well
    assert found.missing < (A + B) * C / (A * B) and found.pierced == 0.0 and found.bent == 0.0


def test_half_of_the_top_is_missed_by_the_camera_that_sees_the_other_half(box):
    points = top(4000)
    found = weighed(box, points[points[:, 0] < A / 2], np.tile(UP, (np.count_nonzero(points[:, 0] < A / 2), 1)))
    assert found.missing > 0.8           # as much as is seen, less what reaches over the line by 2 mm of 30


def test_what_lies_behind_the_table_is_pierced(box):
    """A table at the height of 15: what lies below it by more than 4 % of the size, 3 mm, is the bottom and 12 of 20 mm
    of the walls."""
    total, walls = 2 * (A * B + B * C + A * C), 2 * (A + B) * C
    depth = 0.04 * np.sqrt(A * A + B * B + C * C)
    found = weighed(box, top(500), np.tile(UP, (500, 1)), TablePlane(UP, 15.0, 0.1, 0.1))
    assert found.pierced == pytest.approx((A * B + walls * (15.0 - depth) / C) / total, abs=0.03)


def test_a_bend_counts_by_how_far_it_moves(box):
    """A bend by 2 mm: its heights' root mean square, times √3 for three directions, of the box's size."""
    points = top(3000)
    height = 2.0 * ((points[:, 0] - A / 2) / (A / 2)) ** 2
    found = weighed(box, points + height[:, None] * UP, np.tile(UP, (3000, 1)),
                    rounds=box.settings.anywhere.rungs[0].rounds)
    moved = np.sqrt(np.mean(height**2)) / np.sqrt(A * A + B * B + C * C)
    assert found.explained > 0.99 and found.misfit < 0.1
    assert moved / np.sqrt(3) < found.bent < 1.1 * moved * np.sqrt(3)


def evidence(score: float, explained: float = 1.0, coverage: float = 0.5) -> Evidence:
    return Evidence(explained, 0.0, coverage, 0.0, 0.0, 0.0, score)


def verdict_of(part, found: Evidence):
    scan = UnalignedScan(part, sketch(top(200), np.tile(UP, (200, 1))), None)
    return alignment_of(scan, Answer(np.eye(4), found, scan.sketch.normals), [], 1.0)


def test_a_symmetric_part_is_ambiguous_and_a_poor_pose_fails(box):
    """A box has three half turns: four poses fit alike."""
    sure = verdict_of(box, evidence(1.0))
    assert sure.verdict == AMBIGUOUS and len(sure.poses) == 4 and sure.confidence == pytest.approx(0.25)
    least = box.settings.verdict.least_certainty
    assert verdict_of(box, evidence(2 * least - 1.0 + 1e-6)).verdict == AMBIGUOUS
    poor = verdict_of(box, evidence(2 * least - 1.0 - 1e-6))
    assert poor.verdict == FAILED and poor.confidence == 0.0 and len(poor.poses) == 1


def test_little_of_the_part_is_refused_with_what_to_do(box):
    few = verdict_of(box, evidence(1.0, coverage=0.05))
    assert few.verdict == FAILED and "only 5 % of the part" in few.reason and "scan more" in few.reason


def test_thresholds_are_settings(box):
    strict = replace(box, settings=RigidSettings(verdict=VerdictSettings(least_certainty=0.999)))
    assert verdict_of(box, evidence(0.99)).verdict == AMBIGUOUS and verdict_of(strict, evidence(0.99)).verdict == FAILED


def test_proposals_hold_the_pose():
    """Of 240, 40 and 12 proposals the last hold the motion to what their refinement converges from."""
    part, points = target(step_shape()), step_scan()
    moved = motion(Rotation.random(random_state=3).as_matrix(), np.array([200.0, -50.0, 30.0]))
    generator = np.random.default_rng(0)
    scan = UnalignedScan(part, sketch_of(apply(moved, points), generator), None)
    found = propose(scan, starts_of(scan, "anywhere"), part.settings.anywhere.stages, generator)
    near = [angle(pose @ moved, np.eye(4)) < 0.1 and shift(pose @ moved, np.eye(4), part.centre) < 0.03 * part.size
            for pose in found.poses]
    assert any(near) and len(found) <= 12
    # the signs turn the normals out of the part
    best = int(np.argmax(near))
    signs = found.signs[best][np.minimum(scan.sketch.piece, len(found.signs[best]) - 1)]
    normals = signs[:, None] * scan.sketch.normals
    places = apply(np.linalg.inv(moved), scan.sketch.points)
    outwards = np.einsum("ni,ni->n", normals @ moved[:3, :3], part.samples.normals[part.tree.query(places)[1]])
    assert np.mean(outwards[scan.sketch.piece == 0] > 0.0) > 0.95


@pytest.mark.parametrize(("mode", "scales"), [("fine", (0.1, 10.0, 30.0)), ("global", (30.0,))])
def test_no_length_is_fixed(mode, scales):
    """Part, scan, noise and start times a scale, from a part of 10 mm to one of 3 m: the same verdict and pose, to the
    pose's own uncertainty, which is σ/√n of 3,500 points, five times over: rounding decides which of the scan's points
    are looked at."""
    points, noise = step_scan(), 0.1
    turn = Rotation.from_rotvec((0.2, -0.3, 0.25)).as_matrix()
    for scale in (1.0, *scales):
        part = target(step_shape(scale))
        moved = motion(turn, scale * np.array([10.0, 5.0, -8.0]))
        found = align(part, apply(moved, scale * points), mode)
        assert found.verdict == OK and found.scale == 1.0
        pose = found.T_model_scan @ moved
        if scale == 1.0:
            first, share = pose, found.explained
        assert shift(pose, np.block([[first[:3, :3], scale * first[:3, 3:]], [np.zeros((1, 3)), np.ones((1, 1))]]),
                     part.centre) < scale * 5 * noise / np.sqrt(3500)
        assert angle(pose, first) < 5 * noise / np.sqrt(3500) / (0.3 * 90)
        assert found.explained == pytest.approx(share, abs=0.005)


def test_poses_of_a_nearly_symmetric_part_are_each_right():
    """A channel that a half turn maps onto itself but for its slots, which then lie 0.1 mm off, and a scan without one
    of its ends. It lies turned, where the slots pull the pose found off; the other pose is right all the same, to the
    line of 0.02 mm: thrice the noise over the root of a hundred points beside slots."""
    shape = Part.makeBox(100, 40, 25).cut(Part.makeBox(100, 34, 25, FreeCAD.Vector(0, 3, 3)))
    for x in (20.05, 50.05, 80.05):
        shape = shape.cut(Part.makeBox(4, 24, 10, FreeCAD.Vector(x - 2, 8, -3)))
    part = target(shape)
    points = part.everywhere.points[np.random.default_rng(0).integers(0, len(part.everywhere.points), 60_000)]
    points = points + np.random.default_rng(1).normal(0.0, 0.05, points.shape)
    turned = motion(np.diag([-1.0, -1.0, 1.0]), np.array([100.0, 40.0, 0.0]))
    found = align(part, apply(turned, points[points[:, 0] < 92.0]), "fine")
    assert found.verdict == AMBIGUOUS and len(found.poses) == 2
    assert min(shift(pose.T_model_scan @ turned, np.eye(4), part.centre) for pose in found.poses) < 0.02
