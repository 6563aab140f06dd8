# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a series tells, against processes whose truth is known."""
from __future__ import annotations

import numpy as np
import pytest

from ffds_workbench.series.told import (SeriesPlaces, capability, ewma_chart, find_change, find_modes, find_outliers,
                                        find_scatter, group_difference, means_chart, owner_scatter, scatter_chart)


@pytest.fixture(scope="module")
def places() -> SeriesPlaces:
    """A plate of 20 × 20 places, one half Face1 and the other Face2, and an edge that counts for nothing."""
    x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 20), np.linspace(0, 1, 20)))
    position = np.column_stack([x, y, np.zeros(400)])
    owner = np.where(x < 0.5, "Face1", "Face2").astype("<U8")
    owner[:10] = "Edge1"
    normal = np.tile([0.0, 0.0, 1.0], (400, 1))
    weight = np.full(400, 1 / 390)
    normal[:10], weight[:10] = 0.0, 0.0
    return SeriesPlaces(position, normal, weight, owner)


def shapes(places: SeriesPlaces) -> tuple[np.ndarray, np.ndarray]:
    """Two modes, along the normal, orthogonal over the surface but for what the grid leaves."""
    x, y = places.position[:, 0], places.position[:, 1]
    return np.sin(2 * np.pi * x), np.cos(np.pi * y)


def process(places: SeriesPlaces, parts: int, seed: int, noise: float = 0.01):
    """Displacements of parts with two modes of 0.3 and 0.1 mm and white measurement noise; scores and sigma."""
    random = np.random.default_rng(seed)
    scores = random.standard_normal((parts, 2)) * [0.3, 0.1]
    along = 0.5 + scores @ np.stack(shapes(places)) + noise * random.standard_normal((parts, len(places.owner)))
    moved = np.zeros((parts, len(places.owner), 3))
    moved[:, :, 2] = along
    return moved, scores, np.full(along.shape, noise)


def test_modes_are_found_within_five_per_cent(places):
    """Of 400 parts a variance is known to √(2/399) = 7 %, a size to 3.5 %: the truth is that of the drawn scores."""
    moved, scores, sigma = process(places, 400, 1)
    found = find_modes(moved, sigma, places)
    assert len(found.modes) == 2 and all(mode.certain for mode in found.modes)
    for mode, shape, drawn in zip(found.modes, shapes(places), scores.T, strict=True):
        truth = drawn.std(ddof=1) * np.sqrt((places.weight * shape**2).sum())
        assert mode.size == pytest.approx(truth, rel=0.05)
        own = mode.shape[:, 2] / np.sqrt((places.weight * mode.shape[:, 2] ** 2).sum())
        wanted = shape / np.sqrt((places.weight * shape**2).sum())
        assert abs((places.weight * own * wanted).sum()) > 0.995  # 5 % across: 1 − 0.05²/2
        assert abs(np.corrcoef(mode.scores, drawn)[0, 1]) > 0.99


def test_the_size_of_a_mode_is_in_its_interval(places):
    """95 % intervals: of 200, fewer than 182 hold the truth with a probability of 1 in 500 (binomial)."""
    few = SeriesPlaces(places.position[::4], places.normal[::4], places.weight[::4] / places.weight[::4].sum(),
                 places.owner[::4])
    truth, inside = 0.3 * np.sqrt((few.weight * shapes(few)[0] ** 2).sum()), 0
    for seed in range(200):
        moved, _, sigma = process(few, 40, seed)
        low, high = find_modes(moved, sigma, few).modes[0].interval
        inside += low <= truth <= high
    assert inside >= 182


def test_noise_alone_is_no_certain_mode(places):
    moved, _, sigma = process(places, 50, 3, noise=0.2)
    moved[:, :, 2] = 0.2 * np.random.default_rng(4).standard_normal(moved.shape[:2])
    assert not any(mode.certain for mode in find_modes(moved, sigma, places).modes)


def test_scatter_without_the_measurement(places):
    """Face1 of parts that scatter by 0.3, measured with 0.4: 0.3 is in the interval, 0.5 is what is seen."""
    random = np.random.default_rng(5)
    moved = np.zeros((200, 400, 3))
    moved[:, :, 2] = 0.3 * random.standard_normal((200, 1)) + 0.4 * random.standard_normal((200, 400))
    found = owner_scatter(find_scatter(moved, np.full((200, 400), 0.4), places), places)
    own = {owner.name: owner for owner in found}["Face1"]
    assert own.total == pytest.approx(0.5, rel=0.1) and own.measurement == pytest.approx(0.4)
    assert own.interval[0] < 0.3 < own.interval[1]
    unknown = owner_scatter(find_scatter(moved, np.full((200, 400), np.nan), places), places)[0]
    assert unknown.process is None and unknown.interval is None


@pytest.mark.parametrize("seed", range(5))
def test_a_step_is_located(seed):
    """A step of three standard deviations: the likelihood of a place k parts off falls by exp(−9k/2), so that ± 3 is
    missed in one of a million runs."""
    random = np.random.default_rng(seed)
    figures = random.standard_normal(200)
    figures[120:] += 3.0
    change = find_change(figures)
    assert change.kind == "step" and abs(change.at - 120) <= 3
    assert change.size == pytest.approx(3.0, abs=0.5)


def test_a_slope_is_told_from_a_step():
    random = np.random.default_rng(0)
    figures = 0.1 * random.standard_normal(200)
    figures[120:] += 0.05 * np.arange(1, 81)
    change = find_change(figures)
    assert change.kind == "drift" and abs(change.at - 120) <= 3
    assert change.size == pytest.approx(4.0, rel=0.05)


def test_steady_runs_do_not_change():
    """One in a hundred: 3 or more of 60 with a probability of 2 %; the seeds are fixed."""
    seen = sum(find_change(np.random.default_rng(seed).standard_normal(60)) is not None for seed in range(60))
    assert seen <= 2
    assert find_change(np.ones(50)) is None and find_change(np.arange(5.0)) is None


def test_cavities_are_told_apart():
    random = np.random.default_rng(1)
    figures = random.standard_normal(60)
    names = ["left", "right"] * 30
    assert not group_difference(figures, names).differ
    figures[1::2] += 2.0
    found = group_difference(figures, names)
    assert found.differ and found.means["right"] - found.means["left"] == pytest.approx(2.0, abs=0.8)
    assert group_difference(figures, ["one"] * 60) is None


@pytest.mark.parametrize("mean", [0.0, 0.2])
def test_cpk_is_in_its_interval(mean):
    """1000 repetitions of 50 parts: at least 93 %, three standard deviations of the count below 95 %."""
    truth, inside = (1.0 - mean) / 0.6, 0
    for seed in range(1000):
        found = capability(np.random.default_rng(seed).normal(mean, 0.2, 50), -1.0, 1.0)
        inside += found.cpk_interval[0] <= truth <= found.cpk_interval[1]
        assert found.cp_interval[0] < found.cp < found.cp_interval[1]
    assert inside >= 930
    assert capability(np.ones(20), -1, 1) is None and capability(np.arange(20.0), None, None) is None


def test_charts_know_their_constants():
    """c₄ of groups of five is 0.9400 (ISO 7870-2, table 2): A₃ = 1.427, B₄ = 2.089, B₃ = 0."""
    random = np.random.default_rng(2)
    figures = random.standard_normal(500)
    groups = figures.reshape(100, 5)
    mean_s = groups.std(axis=1, ddof=1).mean()
    means, scatter = means_chart(figures), scatter_chart(figures)
    assert means.high[0] - means.centre == pytest.approx(1.427 * mean_s, rel=1e-3)
    assert scatter.high[0] == pytest.approx(2.089 * mean_s, rel=1e-3) and scatter.low[0] == 0.0
    assert len(means.signals) <= 2
    figures[400:] += 2.0  # λ = 0.2 takes it up to the limit, 0.95 σ, in three or four parts
    assert any(400 <= signal < 410 for signal in ewma_chart(figures).signals)
    assert means_chart(figures[:9]) is None and ewma_chart(figures[:2]) is None


def test_an_outlier_is_named_with_its_face():
    random = np.random.default_rng(6)
    scores, means = random.standard_normal((40, 2)), 0.01 * random.standard_normal((40, 3))
    scores[7, 1], means[7, 2] = 12.0, 0.4
    first, *others = find_outliers(scores, means, np.array(["Face1", "Face2", "Face3"]))
    assert (first.part, first.where) == (7, "Face3") and first.off == pytest.approx(0.4, abs=0.05)
    assert len(others) <= 1


def test_sound_series_have_few_outliers():
    """One series in a hundred should name a part: of a hundred, more than 4 do so with a probability of 1 in 300."""
    named = sum(bool(find_outliers(np.random.default_rng(seed).standard_normal((40, 3)), np.zeros((40, 1)),
                                   np.array(["Face1"]))) for seed in range(100))
    assert named <= 4
