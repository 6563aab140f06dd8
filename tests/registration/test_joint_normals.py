# SPDX-License-Identifier: LGPL-2.1-or-later
"""The normals of a scan tell which skin of a thin sheet it shows, as far as they are to be trusted."""
from __future__ import annotations

import numpy as np
import Part
import pytest

from ffds_workbench.brep.joint_part import joint_part
from ffds_workbench.brep.workpiece import read
from ffds_workbench.registration.joint import register_joint

SIZE, NOISE = np.array([60.0, 50.0, 2.0]), 0.05
UP = np.array([0.0, 0.0, 1.0])
PART = joint_part(read(Part.makeBox(*SIZE)))


def seen_from_above(shift: float) -> np.ndarray:
    """The upper side but for a border of 3 mm, moved up: nothing else tells that it is not the lower one."""
    generator = np.random.default_rng(3)
    points = np.column_stack([generator.uniform(3, SIZE[:2] - 3, (30_000, 2)), np.full(30_000, SIZE[2] + shift)])
    return points + generator.normal(0, NOISE, (30_000, 1)) * UP


def sensed(count: int, outward: np.ndarray = UP, degrees: float = 8.0) -> np.ndarray:
    """Normals that are off by as many degrees in each direction across them, as those from noisy points are."""
    normals = outward + np.random.default_rng(4).normal(0, np.deg2rad(degrees), (count, 3))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def random_signs(count: int) -> np.ndarray:
    return np.random.default_rng(5).choice([-1.0, 1.0], (count, 1))


def moved(result) -> float:
    """How far all faces moved up, in mm."""
    return float(np.mean([face.displacement(face.uv)[:, 2].mean() for face in result.faces]))


# The mean of thousands of points is far better known than this: 0.05 mm / √30000.
EXACT = 0.01


@pytest.mark.parametrize("inwards", [1.0, 1.15])
def test_normals_tell_what_points_do_not(inwards):
    """Half a thickness inwards both skins are as near, a little farther the wrong one is: the bands say so."""
    points = seen_from_above(-inwards)
    result = register_joint(PART, points, scan_normals=sensed(len(points)))
    assert moved(result) == pytest.approx(-inwards, abs=EXACT)
    assert result.unsure == pytest.approx(0.0 if inwards == 1.0 else SIZE[2])


def test_normals_of_no_sign_tell_nothing():
    points = seen_from_above(-1.0)
    result = register_joint(PART, points, scan_normals=random_signs(len(points)) * sensed(len(points)))
    assert abs(moved(result)) == pytest.approx(1.0, abs=EXACT) and result.unsure == pytest.approx(SIZE[2])


@pytest.mark.parametrize("wrong", ["inwards", "no sign", "along the sheet"])
def test_wrong_normals_change_nothing_where_points_tell(wrong):
    points = seen_from_above(-0.3)
    normals = {"inwards": sensed(len(points), -UP), "no sign": random_signs(len(points)) * sensed(len(points)),
               "along the sheet": sensed(len(points), np.array([1.0, 0.0, 0.0]))}[wrong]
    plain, result = register_joint(PART, points), register_joint(PART, points, scan_normals=normals)
    assert moved(plain) == pytest.approx(-0.3, abs=EXACT)
    for face, other in zip(plain.faces, result.faces, strict=True):
        np.testing.assert_array_equal(face.displacement(face.uv), other.displacement(face.uv))
    assert result.unsure == 0.0


def test_normals_that_all_point_upwards_do_not_turn_the_lower_side():
    """Both skins are seen, moved by a quarter of the thickness: the lower one's normals contradict it."""
    upper = seen_from_above(-0.5)
    points = np.concatenate([upper, upper - SIZE[2] * UP])
    result = register_joint(PART, points, scan_normals=sensed(len(points)))
    assert moved(result) == pytest.approx(-0.5, abs=EXACT)


def test_a_fifth_of_the_scan_has_no_normals():
    points = seen_from_above(-1.0)
    normals = sensed(len(points))
    normals[points[:, 0] < 14] = 0.0
    assert moved(register_joint(PART, points, scan_normals=normals)) == pytest.approx(-1.0, abs=EXACT)
