# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kriging against displacements in closed form that are observed along the normals of a cube alone."""
from __future__ import annotations

import numpy as np
import pytest

from ffds_workbench.registration.joint.body_field.kriging import (FieldModel, Observations, Pose, condition,
                                                                  most_likely_model, overconfidence)

HALF, NOISE = 30.0, 0.01


def _cube(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Places on the faces of a cube, and their normals."""
    generator = np.random.default_rng(seed)
    place = generator.uniform(-HALF, HALF, (count, 3))
    normal = np.zeros((count, 3))
    normal[np.arange(count), generator.integers(3, size=count)] = generator.choice([-1.0, 1.0], count)
    return np.where(normal != 0, HALF * normal, place), normal


def _bulge(place: np.ndarray) -> np.ndarray:
    """A bump that moves sideways, as large as the cube."""
    weight = np.exp(-((place - (20.0, 10.0, 15.0)) ** 2).sum(axis=1) / (2 * 25.0**2))
    return weight[:, None] * (0.6, -0.9, 1.2)


def _observed(field, count: int = 900, seed: int = 1, body: np.ndarray | None = None) -> Observations:
    place, normal = _cube(count, seed)
    value = (normal * field(place)).sum(axis=1) + NOISE * np.random.default_rng(seed + 1).normal(size=count)
    body = np.zeros(count, dtype=np.intp) if body is None else body
    return Observations(place, normal, body, value, np.ones(count), np.zeros(count))


def test_sliding_follows_from_what_is_seen_along_the_normals():
    seen = _observed(_bulge)
    place, normal = _cube(200, 7)
    field = condition(most_likely_model(seen), seen, Pose.of(seen.place, seen.body), 1.0)
    body = np.zeros(200, dtype=np.intp)
    error, covariance = field.mean(place, body) - _bulge(place), field.covariance(place, body)
    slid = np.linalg.norm(np.where(normal != 0, 0.0, _bulge(place)), axis=1)
    # Along the normals alone nothing of it is seen: all would be lost. What is still lost, the covariance says below.
    assert np.linalg.norm(np.where(normal != 0, 0.0, error), axis=1).mean() < slid.mean() / 3
    # Three components: the mean of the squared error in its own covariance is 3. Errors are those of one field, few
    # independent numbers: within a factor of two.
    squared = np.einsum("nx,nxy,ny->n", error, np.linalg.inv(covariance), error)
    assert 0.5 * 3 < squared.mean() < 2 * 3


def test_the_likeliest_model_finds_the_noise():
    model = most_likely_model(_observed(_bulge))
    # Noises are tried in steps of ten in variance: half a step is a factor of √√10 = 1.8 in deviation.
    assert NOISE / 1.8 < np.sqrt(model.variance * model.noise) < 1.8 * NOISE


def test_bodies_that_move_by_themselves_are_told():
    body = (_cube(900, 1)[0][:, 0] > 0).astype(np.intp)

    def opposite(place: np.ndarray) -> np.ndarray:
        return np.where(place[:, :1] > 0, 1.0, -1.0) * (0.0, 0.5, 0.3)

    assert most_likely_model(_observed(opposite, body=body)).apart
    assert not most_likely_model(_observed(_bulge, body=body)).apart


def test_a_known_variance_counts():
    seen = Observations(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.zeros(1, dtype=np.intp), np.array([1.0]),
                        np.zeros(1), np.array([0.25]))
    far = Pose.of(np.full((2, 3), 1e3), np.zeros(2, dtype=np.intp))
    field = condition(FieldModel(smooth=True, apart=False, length=10.0, variance=0.75, noise=0.0), seen, far, 1.0)
    where = np.zeros((1, 3)), np.zeros(1, dtype=np.intp)
    # One observation of one number: mean = 1 · 0.75 / (0.75 + 0.25), variance = 1 / (1/0.75 + 1/0.25).
    assert field.mean(*where)[0] == pytest.approx([0.0, 0.0, 0.75])
    assert np.diag(field.covariance(*where)[0]) == pytest.approx([0.75, 0.75, 0.1875])


def test_turns_that_nothing_shows_stay_with_the_pose():
    """A sphere is turned by a field that only its turn tells of: seen along its normals it has not moved."""
    place, _ = _cube(300, 1)
    normal = place / np.linalg.norm(place, axis=1)[:, None]
    none = np.zeros(300, dtype=np.intp)
    seen = Observations(HALF * normal, normal, none, NOISE * np.random.default_rng(2).normal(size=300), np.ones(300),
                        np.zeros(300))
    model = FieldModel(smooth=True, apart=False, length=3 * HALF, variance=1.0, noise=NOISE**2)
    pose = Pose.of(seen.place, none)
    held, free = (condition(model, seen, pose, variance) for variance in (1e-4, 1e4))
    spread = [np.sqrt(np.trace(field.covariance(seen.place, none), axis1=1, axis2=2)).mean() for field in (held, free)]
    # Held to 0.01 mm about three axes; free, they are as uncertain as the field's slope of 1 / (3 HALF) over HALF is.
    assert spread[0] < 0.1 < spread[1]


def test_what_faces_do_not_share_is_not_trusted_across_them():
    """Strips of a plane, whose heights one smooth field describes, or one that is folded between them."""
    generator = np.random.default_rng(5)
    place = np.column_stack([generator.uniform(-HALF, HALF, (400, 2)), np.zeros(400)])
    strip = np.floor((place[:, 0] + HALF) / 10.0).astype(int)
    ratios = []
    for height in (0.5 * np.sin(place[:, 0] / 20.0), 0.1 * np.maximum(place[:, 0] - 20.0, 0.0)):
        value = height + 1e-4 * generator.normal(size=400)
        seen = Observations(place, np.tile([0.0, 0.0, 1.0], (400, 1)), np.zeros(400, dtype=np.intp), value,
                            np.ones(400), np.zeros(400))
        ratios.append(overconfidence(most_likely_model(seen), seen, strip))
    # Six strips, each of one or two independent shapes: a factor of 2 is chance; folded away by 0.5 mm on average.
    assert ratios[0] < 2.0 and ratios[1] > 3.0, ratios
