# SPDX-License-Identifier: LGPL-2.1-or-later
"""Density and noise of scans of which both are known, and what a median of points is worth."""
import numpy as np
import pytest

from ffds_workbench.registration.joint.data import median_heights, scan_statistics
from ffds_workbench.registration.joint.data.correspondence import Correspondence
from ffds_workbench.registration.joint.data.scatter import Scatter
from ffds_workbench.registration.joint.problem import sample_of

DENSITY, NOISE = 16.0, 0.02
SIZE = np.array([60.0, 40.0])


def plane(seed=0, noise=NOISE):
    """Points at random in a plane that lies askew."""
    random = np.random.default_rng(seed)
    count = int(DENSITY * SIZE.prod())
    flat = np.column_stack([random.uniform(0, SIZE, (count, 2)), random.normal(0, noise, count)])
    turn = np.linalg.qr(np.random.default_rng(9).normal(size=(3, 3)))[0]
    return flat @ turn.T + [100.0, -50.0, 30.0]


def test_points_at_random_in_a_plane():
    found = scan_statistics(plane())
    # 800 neighbourhoods of 16, of which some 250 are apart: the density of one is known to 1/√15, its noise to 1/√26.
    assert found.density == pytest.approx(DENSITY, rel=0.06)
    assert found.noise == pytest.approx(NOISE, rel=0.05)


def test_points_on_a_grid():
    """As a camera sees them: 15 neighbours of a square grid lie within √5 of its pitch, where there are 20."""
    pitch = 0.25
    u, v = np.meshgrid(np.arange(0, 60, pitch), np.arange(0, 40, pitch))
    z = np.random.default_rng(1).normal(0, NOISE, u.size)
    found = scan_statistics(np.column_stack([u.ravel(), v.ravel(), z]))
    # The noise makes distances longer by half of (0.02 · √2 / 0.56)².
    assert found.density == pytest.approx(15 / (5 * np.pi * pitch**2), rel=2 * NOISE**2 / (5 * pitch**2))
    # Of the eight at √5, those that lie nearest in height are taken: 9 % too little, 12 % at the most.
    assert 0.88 * NOISE < found.noise < NOISE


@pytest.mark.parametrize("scale", [1e-3, 0.1, 1e3])
def test_units_do_not_matter(scale):
    one, other = scan_statistics(plane()), scan_statistics(scale * plane())
    assert other.density == pytest.approx(one.density / scale**2, rel=1e-6)
    assert other.noise == pytest.approx(one.noise * scale, rel=1e-6)
    # The spacing of single precision is a power of two.
    assert 0.5 <= other.resolution / (scale * one.resolution) <= 2.0


def test_a_scan_without_noise_has_that_of_its_numbers():
    found = scan_statistics(plane(noise=0.0).astype(np.float32).astype(float))
    assert found.noise >= found.resolution > 0
    # Rounded to single precision, 2⁻¹⁷ mm from 64 to 128 mm; evenly distributed, so its deviation is that over √12.
    assert found.resolution == pytest.approx(2.0**-17 / np.sqrt(12), rel=1e-9)
    assert found.noise < 2 * found.resolution


def test_few_points_are_enough():
    found = scan_statistics(plane()[:60])
    assert np.isfinite(found.density) and found.noise < NOISE * 3


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 10, 200])
def test_a_median_is_worth_no_more_than_it_says(count):
    """Its weight against its variance over many cells; exactly for one and two points, and 2/π for very many."""
    cells, sigma = 4000, 0.05
    height = np.random.default_rng(count).normal(0, sigma, cells * count)
    cell = np.repeat(np.arange(cells), count)
    found = Correspondence(np.arange(len(cell)), cell, height, cell)
    scatter = Scatter(np.array([sigma]), np.zeros(1), np.array([sigma]))
    values = median_heights(found, scatter, np.zeros(cells // 4, dtype=int), 4)
    worth = float(values.weight.mean() * values.height.var())
    # 4000 cells tell a variance to √(2/4000) = 2.2 %; a median of three is worth 0.743 of a mean, of four 0.838
    # (Kendall and Stuart, The Advanced Theory of Statistics 1, 14), and 0.64 is said of all.
    assert (1.0 if count < 3 else 0.64 / 0.838) - 3 * 0.022 < worth < 1.0 + 3 * 0.022
    assert (values.count == count).all()


def test_a_median_is_that_of_its_cell():
    """Cells in any order, some of them empty, with an even and an odd number of points, one of them gross."""
    cell = np.array([2, 0, 2, 0, 2, 0, 0])
    height = np.array([0.3, 5.0, 0.1, 0.2, 0.2, 0.1, 0.3])
    found = Correspondence(np.arange(7), cell, height, cell)
    values = median_heights(found, Scatter(np.ones(1), np.zeros(1), np.ones(1)), np.zeros(1, dtype=int), 4)
    assert values.height == pytest.approx([0.25, 0.0, 0.2, 0.0])
    assert values.weight[[1, 3]] == pytest.approx(0.0) and values.count == pytest.approx([4, 0, 3, 0])


def test_the_sample_fills_the_spans_of_large_parts():
    """As many points as twenty for each span, of which a frame has thousands, or all that there are."""
    scan = np.zeros((100_000, 3))
    assert len(sample_of(scan, 100, 0)) == 15_000
    assert len(sample_of(scan, 4000, 0)) == 80_000
    assert len(np.unique(sample_of(scan, 40_000, 0))) == 100_000
