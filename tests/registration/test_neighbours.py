# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closest scan points without a tree: the same answers as scipy's k-d tree, whatever the cloud looks like."""
import numpy as np
import pytest
from scipy.spatial import cKDTree

from ffds_workbench.registration.face.neighbours import nearest_neighbours

RANDOM = np.random.default_rng(7)


def clouds() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    sheet = np.c_[RANDOM.uniform(0, 75, (20000, 2)), RANDOM.normal(0, 0.1, 20000)]
    grid = np.stack(np.meshgrid(np.linspace(0, 75, 20), np.linspace(0, 70, 20)), -1).reshape(-1, 2)
    below = np.c_[grid, np.full(400, -5.0)]
    return {
        "sheet": (sheet, below),
        "volume": (RANDOM.uniform(-50, 50, (20000, 3)), RANDOM.uniform(-60, 60, (300, 3))),
        "outlier 10 m away": (np.r_[sheet, [[1e4, -1e4, 1e4]]], below),
        "queries 10 m away": (sheet, below + 1e4),
        "large coordinates": (sheet + 1e6, below + 1e6),
        "a line": (np.c_[np.linspace(0, 100, 5000), np.zeros((5000, 2))], below),
        "two points": (sheet[:2], below),
        "one point": (sheet[:1], below),
        "one query": (sheet, below[:1]),
        "dense beside sparse": (np.r_[sheet, RANDOM.normal(0, 0.01, (30000, 3))], below),
    }


@pytest.mark.parametrize("name", list(clouds()))
def test_same_as_a_tree(name):
    scan, queries = clouds()[name]
    distances, indices = nearest_neighbours(scan, queries)
    expected, expected_indices = cKDTree(scan).query(queries)
    np.testing.assert_array_equal(distances, expected)
    np.testing.assert_array_equal(indices, expected_indices)


def test_ties_go_to_the_first_point():
    scan = np.repeat([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 5.0, 0.0]], 40, axis=0)
    distances, indices = nearest_neighbours(scan[::-1], np.zeros((1, 3)))
    assert distances[0] == 1.0
    assert indices[0] == 40


def test_all_points_equal():
    distances, indices = nearest_neighbours(np.ones((100, 3)), np.zeros((5, 3)))
    np.testing.assert_allclose(distances, np.sqrt(3))
    np.testing.assert_array_equal(indices, 0)


@pytest.mark.parametrize("ordered", [True, False], ids=["strip by strip", "at random"])
def test_a_scan_of_several_blocks(ordered):
    scan = np.c_[RANDOM.uniform(0, 75, (300_000, 2)), RANDOM.normal(0, 0.1, 300_000)]
    scan = np.round(scan[np.argsort(scan[:, 0])] if ordered else scan, 2)      # rounded: there are equal points
    queries = np.c_[RANDOM.uniform(-10, 85, (500, 2)), RANDOM.uniform(-5, 5, 500)]
    queries[:100] = scan[RANDOM.integers(0, len(scan), 100)]
    distances, indices = nearest_neighbours(scan, queries)
    np.testing.assert_array_equal(distances, cKDTree(scan).query(queries)[0])
    first = {tuple(point): k for k, point in reversed(list(enumerate(scan)))}
    np.testing.assert_array_equal(indices[:100], [first[tuple(query)] for query in queries[:100]])
