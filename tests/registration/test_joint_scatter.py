# SPDX-License-Identifier: LGPL-2.1-or-later
"""The two variances of the heights, and what they are for: a scan with less noise gives a better result."""
import numpy as np
import pytest

from ffds_workbench.registration.joint.data.correspondence import Correspondence
from ffds_workbench.registration.joint.data.cell_heights import median_heights, tukey_mean_heights
from ffds_workbench.registration.joint.data.scatter import Scatter, model_noise, patch_sums, sensor_noise, spread

PER_SPAN, SPANS, POINTS = 6, 60, 8
CELLS = SPANS * PER_SPAN**2


def scan(sigma, shape=lambda u, v: 0 * u, seed=0, outliers=0.0, points=POINTS):
    """Cell and height of points over two faces of as many spans; ``shape`` of the place within a span, in mm."""
    random = np.random.default_rng(seed)
    cell = np.repeat(np.arange(CELLS), points)
    inner = cell % PER_SPAN**2
    u, v = (inner // PER_SPAN + 0.5) / PER_SPAN, (inner % PER_SPAN + 0.5) / PER_SPAN
    height = shape(u, v) + sigma[(cell // PER_SPAN**2) * 2 // SPANS] * random.normal(size=len(cell))
    gross = random.random(len(cell)) < outliers
    return cell, np.where(gross, random.uniform(-0.5, 0.5, len(cell)), height)


def means(cell, height):
    count = np.bincount(cell, minlength=CELLS).astype(float)
    return np.bincount(cell, height, CELLS) / count, count


FACE_OF_SPAN = np.arange(SPANS) * 2 // SPANS


def test_noise_of_each_face_is_measured_within_its_cells():
    sigma = np.array([0.02, 0.1])
    cell, height = scan(sigma, lambda u, v: 3.0 + u, outliers=0.0)
    mean, count = means(cell, height)
    found = sensor_noise(height, cell, mean, count, FACE_OF_SPAN[cell // PER_SPAN**2], sigma, 0.0)
    # 8640 points a face; the median absolute deviation is known to 1.17 σ / √n: 1.3 %, thrice that, and the shrinkage
    # towards the whole's of 50 in 8640.
    assert found == pytest.approx(sigma, rel=0.06)


def test_few_points_lean_on_the_whole_part():
    random = np.random.default_rng(0)
    off = np.abs(np.concatenate([random.normal(0, 0.1, 5000), [1e-4, 2e-4, 1e-4]]))
    face = np.r_[np.zeros(5000, dtype=int), [1, 1, 1]]
    found = spread(off, face, 3, 0.5)
    assert found[0] == pytest.approx(0.1, rel=0.05)
    assert found[1] > 0.09 and found[2] == pytest.approx(0.1, rel=0.05)


@pytest.mark.parametrize("noise", [0.13, 0.01, 0.0])
def test_what_a_lattice_cannot_follow_is_told_from_noise(noise):
    amplitude = 0.02
    cell, height = scan(np.full(2, noise), lambda u, v: amplitude * np.where(u < 0.5, 1.0, -1.0), points=40)
    mean, count = means(cell, height)
    found = model_noise(mean.reshape(SPANS, -1), count.reshape(SPANS, -1), FACE_OF_SPAN, np.full(2, noise))
    # Patches differ by 2 a across u and not at all across v: half the mean square of differences is a².
    # 240 differences of 360 points each at σ = 0.13: the variance is known to (σ²/n) √(2/240), well below a².
    assert found == pytest.approx(np.full(2, amplitude), rel=0.1)


def test_a_shape_held_off_the_scan_is_no_error_of_the_model():
    """The runaway of a scan without noise: points that weigh less the farther the shape has left them."""
    cell, height = scan(np.full(2, 1e-4), lambda u, v: 0.3 + 0 * u)
    shape = Correspondence(np.arange(len(cell)), cell, height, cell)
    start = Scatter(np.full(2, 1e-4), np.zeros(2), np.full(2, 0.1))
    values = tukey_mean_heights(shape, start, FACE_OF_SPAN, PER_SPAN**2, (1e-6, 1e-3))
    assert (values.count == POINTS).all() and values.height == pytest.approx(0.3, abs=1e-3)
    assert values.scatter.model == pytest.approx(1e-3) and values.scatter.sensor == pytest.approx(1e-4, rel=0.1)
    # A patch of 9 cells is worth 1/(σ²/n + τ²), whatever its distance.
    assert patch_sums(values.weight.reshape(SPANS, -1)) == pytest.approx(1e6, rel=0.01)


def test_outliers_do_not_count():
    sigma = np.full(2, 0.02)
    cell, height = scan(sigma, outliers=0.05)
    found = Correspondence(np.arange(len(cell)), cell, height, cell)
    start = Scatter(sigma, np.zeros(2), np.full(2, 0.1))
    values = tukey_mean_heights(found, start, FACE_OF_SPAN, PER_SPAN**2, (1e-6, 1e-6))
    # Outliers in ±0.5 mm, of which Tukey's biweight at 0.47 mm keeps some, are in a third of the cells and move their
    # means by a few hundredths; the standard deviation without robust weights would be 0.067.
    assert values.scatter.sensor == pytest.approx(sigma, rel=0.2)
    assert median_heights(found, start, FACE_OF_SPAN, PER_SPAN**2).height.std() < 2 * 0.02 / np.sqrt(0.64 * POINTS)
