# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints to poses and back: for every arm and branch, against the makers' own tables and an independent library."""
from __future__ import annotations

import math

import numpy as np
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.robot.arms import known_arms, read_arm
from ffds_workbench.robot.kinematics import distance_to_singularity, inverse, wrapped

ARMS = known_arms()
POSES = 2000


def random_joints(arm, count: int, seed: int = 1) -> np.ndarray:
    low, high = np.clip(arm.limits, -np.pi, np.pi).T
    return np.random.default_rng(seed).uniform(low, high, (count, 6))


@pytest.mark.parametrize("name", ARMS)
def test_every_branch_leads_back_to_its_pose(name):
    """To 1e-9 m and 1e-9 rad; a hundred times what rounding leaves of numbers of about 1000 mm, 1e-13 relative."""
    arm = read_arm(name)
    joints = random_joints(arm, POSES)
    poses = arm.chain.flange(joints)
    found = inverse(arm.family, poses)
    reached = ~np.isnan(found[..., 0])
    again = arm.chain.flange(np.nan_to_num(found))
    apart = np.abs(again - poses[:, None])
    assert apart[..., :3, 3][reached].max() < 1e-6  # mm
    assert apart[..., :3, :3][reached].max() < 1e-9
    # The joints that the pose was made from are one of the branches, unless rounding hides them at a singular pose.
    away = np.abs(wrapped(found - joints[:, None])).max(axis=2)
    safe = distance_to_singularity(arm.family, joints) > 0.01
    assert safe.mean() > 0.9
    assert np.nanmin(away, axis=1)[safe].max() < 1e-9
    assert reached.sum(axis=1).min() >= 2


@pytest.mark.parametrize("name", ARMS)
def test_branches_are_different_configurations_and_stay_so_along_a_path(name):
    arm = read_arm(name)
    start = random_joints(arm, 40, 3)
    start = start[distance_to_singularity(arm.family, start) > 0.2]
    poses, near = (arm.chain.flange(joints) for joints in (start, start + 1e-6))
    first, second = inverse(arm.family, poses), inverse(arm.family, near)
    both = ~np.isnan(first[..., 0] + second[..., 0])
    assert np.abs(wrapped(first - second))[both].max() < 1e-3
    pairs = np.abs(wrapped(first[:, :, None] - first[:, None])).max(axis=3) + 10.0 * np.eye(8)
    assert np.nanmin(pairs) > 1e-3


def test_distance_to_singularity_falls_to_zero_where_the_jacobian_loses_rank():
    """Against the smallest singular value of the numerical Jacobian of each arm at its known singular poses."""
    for name in ARMS:
        arm = read_arm(name)
        joints = random_joints(arm, 200, 5)
        sound = distance_to_singularity(arm.family, joints)
        for singular in (_straight_wrist(arm, joints), _stretched(arm, joints)):
            assert distance_to_singularity(arm.family, singular).max() < 1e-6
            # Against the poses beside it: 1e-6 of what they have, times the square root of the rounding of angles.
            assert _least_singular_value(arm, singular).max() < 1e-4 * np.median(_least_singular_value(arm, joints))
        assert np.median(sound) > 0.1


def _least_singular_value(arm, joints):
    step = 1e-6
    base = arm.chain.flange(joints)
    columns = []
    for i in range(6):
        moved = arm.chain.flange(joints + step * np.eye(6)[i])
        turn = moved[:, :3, :3] @ np.swapaxes(base[:, :3, :3], 1, 2)
        spin = 0.5 * np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0],
                               turn[:, 1, 0] - turn[:, 0, 1]], axis=1)
        columns.append(np.hstack([(moved - base)[:, :3, 3] / 1000.0, spin]) / step)
    return np.linalg.svd(np.stack(columns, axis=2), compute_uv=False)[:, -1]


def _straight_wrist(arm, joints):
    """Joint 5 where axes 4 and 6 are parallel."""
    result = joints.copy()
    w4, w5, w6 = arm.chain.directions[3:]
    result[:, 4] = -math.atan2(w6 @ np.cross(w5, w4), w6 @ w4)
    return result


def _stretched(arm, joints):
    """Joint 3 where the arm is straight: the wrist (or axis 4) is then farthest from axis 2."""
    result = joints.copy()
    y = arm.chain.directions[1]
    first = arm.family.elbow - arm.family.shoulder
    second = arm.family.fourth - arm.family.elbow
    first, second = first - (first @ y) * y, second - (second @ y) * y
    axis = arm.chain.directions[2]
    result[:, 2] = math.atan2(np.cross(second, first) @ axis, second @ first)
    return result


def test_what_cannot_be_reached_has_no_joints():
    arm = read_arm("UR10e")
    pose = np.eye(4)[None].copy()
    pose[0, :3, 3] = 3000.0, 0.0, 0.0
    assert np.isnan(inverse(arm.family, pose)).all()


@pytest.mark.parametrize("name", ARMS)
def test_against_an_independent_library(name):
    """PyKDL's chain of the same axes, joint by joint, to its own rounding."""
    kdl = pytest.importorskip("PyKDL", reason="PyKDL (Debian: python3-pykdl) is not installed")
    arm = read_arm(name)
    chain = kdl.Chain()
    for direction, point in zip(arm.chain.directions, arm.chain.points, strict=True):
        chain.addSegment(kdl.Segment(kdl.Joint()))
        chain.addSegment(kdl.Segment(kdl.Joint("j", kdl.Vector(*point), kdl.Vector(*direction), kdl.Joint.RotAxis)))
    home = arm.chain.home
    chain.addSegment(kdl.Segment(kdl.Joint(), kdl.Frame(kdl.Rotation(*home[:3, :3].ravel()),
                                                        kdl.Vector(*home[:3, 3]))))
    solver, frame = kdl.ChainFkSolverPos_recursive(chain), kdl.Frame()
    joints = random_joints(arm, 300, 7)
    poses = arm.chain.flange(joints)
    for row, pose in zip(joints, poses, strict=True):
        angles = kdl.JntArray(6)
        for i, angle in enumerate(row):
            angles[i] = angle
        solver.JntToCart(angles, frame)
        assert [frame.p[i] for i in range(3)] == pytest.approx(pose[:3, 3], abs=1e-6)
        assert [[frame.M[i, j] for j in range(3)] for i in range(3)] == pytest.approx(pose[:3, :3], abs=1e-9)


HAND = [
    # The flange's place where the makers draw it: with all joints at zero, worked out from the dimensions.
    ("FANUC ARC Mate 100iD", (0, 0, 0, 0, 0, 0), (75 + 700 + 75, 0, 450 + 640 + 195)),
    ("ABB IRB 1520ID", (0, 0, 0, 0, 0, 0), (160 + 723 + 200, 0, 453 + 590 + 200)),
    ("KUKA KR 8 R1440-2", (0, 0, 0, 0, 0, 0), (170 + 610 + 627 + 80, 0, 425 + 210)),
    # KUKA's usual home: upper arm upright, forearm level.
    ("KUKA KR 8 R1440-2", (0, -90, 90, 0, 0, 0), (170 + 627 + 80, 0, 425 + 610 + 210)),
    ("KUKA KR 10 R1420", (90, -90, 90, 0, 0, 0), (0, -(150 + 660 + 80), 450 + 610 + 20)),
    ("Yaskawa AR1440", (0, 0, 0, 0, 0, 0), (155 + 640 + 100, 0, 450 + 614 + 200)),
    ("UR10e", (0, 0, 0, 0, 0, 0), (-612.7 - 571.55, -174.15 - 116.55, 180.7 - 119.85)),
    ("UR10e", (0, -90, 0, -90, 0, 0), (0, -174.15 - 116.55, 180.7 + 612.7 + 571.55 + 119.85)),
]


@pytest.mark.parametrize(("name", "degrees", "place"), HAND)
def test_places_worked_out_by_hand(name, degrees, place):
    pose = read_arm(name).chain.flange(np.radians(np.array([degrees], dtype=float)))[0]
    assert pose[:3, 3] == pytest.approx(place, abs=1e-9)


def test_every_arm_says_where_its_figures_come_from():
    for name in ARMS:
        arm = read_arm(name)
        assert arm.sources and arm.unsure
        assert (arm.limits[:, 0] < arm.limits[:, 1]).all() and (arm.speeds > 1.0).all()
        # Its reach is that of the wrist or flange, as makers count it: 5 % cover what they round and mean.
        lengths = sum(arm.family.lengths) + np.hypot(*arm.family.shoulder[:2])
        assert arm.reach == pytest.approx(lengths, rel=0.13)


URDF = '<robot name="x"><joint name="f" type="fixed"><parent link="w"/><child link="b"/></joint>{joints}</robot>'


def urdf_of(arm) -> str:
    """The arm's axes as a URDF, each frame turned somehow; written from its own definition."""
    from scipy.spatial.transform import Rotation
    rng = np.random.default_rng(2)
    frames = [np.eye(4)]
    rows = []
    for i, (direction, point) in enumerate(zip(arm.chain.directions, arm.chain.points, strict=True)):
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = Rotation.random(random_state=int(rng.integers(99))).as_matrix(), point
        rows.append(row(i, "revolute", np.linalg.inv(frames[-1]) @ frame, frame[:3, :3].T @ direction, arm.limits[i]))
        frames.append(frame)
    rows.append(row(6, "fixed", np.linalg.inv(frames[-1]) @ arm.chain.home, np.zeros(3), (0, 0)))
    return URDF.format(joints="".join(rows))


def row(number, kind, pose, axis, limits) -> str:
    from scipy.spatial.transform import Rotation
    rpy = Rotation.from_matrix(pose[:3, :3]).as_euler("xyz")
    parent = f"l{number - 1}" if number else "b"
    return (f'<joint name="j{number}" type="{kind}"><origin xyz="{text(pose[:3, 3] / 1000.0)}" rpy="{text(rpy)}"/>'
            f'<parent link="{parent}"/><child link="l{number}"/><axis xyz="{text(axis)}"/>'
            f'<limit lower="{limits[0]:.17g}" upper="{limits[1]:.17g}" velocity="2" effort="1"/></joint>')


def text(values) -> str:
    return " ".join(f"{value:.17g}" for value in values)


@pytest.mark.parametrize("name", ["UR10e", "KUKA KR 10 R1420"])
def test_urdf(name, tmp_path):
    arm = read_arm(name)
    (tmp_path / "arm.urdf").write_text(urdf_of(arm))
    read = read_arm(tmp_path / "arm.urdf")
    joints = random_joints(arm, 100)
    assert read.chain.flange(joints) == pytest.approx(arm.chain.flange(joints), abs=1e-8)
    assert read.limits == pytest.approx(arm.limits) and read.speeds == pytest.approx(2.0)
    again = read.chain.flange(np.nan_to_num(inverse(read.family, arm.chain.flange(joints))))
    found = ~np.isnan(inverse(read.family, arm.chain.flange(joints))[..., 0])
    assert np.abs(again - arm.chain.flange(joints)[:, None])[found].max() < 1e-6


@pytest.mark.parametrize(("content", "says"), [
    (None, "cannot be read"), ("<robot", "no XML"), ("<model/>", "no URDF"), ("<robot/>", "0 turning joints"),
    ('<robot><joint name="${p}"/></robot>', "xacro"), ('<!DOCTYPE a><robot/>', "document type"),
    (URDF.format(joints='<joint type="revolute"><parent link="b"/><child link="c"/><origin xyz="1 2"/></joint>'),
     "1 turning")])
def test_bad_urdf_is_refused_in_one_sentence(content, says, tmp_path):
    path = tmp_path / "a.urdf"
    if content is not None:
        path.write_text(content)
    with pytest.raises(InputError, match=says):
        read_arm(path)


def test_unknown_names_list_what_there_is():
    with pytest.raises(InputError, match="There is no robot 'R2D2': name one of .*UR10e"):
        read_arm("R2D2")
    assert read_arm("kr8r1440-2").name == read_arm("KUKA KR 8 R1440-2 arc HW").name
