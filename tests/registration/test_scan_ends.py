# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a scan ends, from points at random on a strip whose end is known."""
import numpy as np
import pytest

from ffds_workbench.registration.scan_points import end_of_scan, outermost_points, weight_of_end

STATIONS, DENSITY, END = 4000, 12.0, 5.0


def ends(noise):
    """Ends found at many stations, each with its own random points, and what they are said to be uncertain by."""
    random = np.random.default_rng(3)
    number = random.poisson(DENSITY * END, STATIONS)
    station = np.repeat(np.arange(STATIONS), number)
    outward = random.uniform(0, END, number.sum()) + random.normal(0, 1.0, number.sum()) * noise
    outermost, counted = outermost_points(station, outward, STATIONS, 4)
    assert (counted == number).all()
    return end_of_scan(outermost, np.full(STATIONS, DENSITY), noise)


def test_the_outermost_points_come_first_and_stations_stay_apart():
    outermost, number = outermost_points(np.array([2, 0, 2, 2, 0]), np.array([-7.0, 1.0, 3.0, -7.0, 9.0]), 4, 3)
    np.testing.assert_array_equal(number, [2, 0, 3, 0])
    np.testing.assert_array_equal(outermost, [[9, np.nan, 3, np.nan], [1, np.nan, -7, np.nan],
                                              [np.nan, np.nan, -7, np.nan]])
    assert not outermost_points(np.zeros(0, dtype=np.intp), np.zeros(0), 2, 1)[1].any()


def test_the_end_is_unbiased_and_as_uncertain_as_it_says():
    """4000 ends: their mean is known to 1/√4000 of their spread, 2 %, twice which is allowed; the spread to 2 % too."""
    end, spread = ends(0.0)
    assert end.mean() == pytest.approx(END, abs=2 * spread.mean() / np.sqrt(STATIONS))
    assert np.std(end) == pytest.approx(spread.mean(), rel=0.05)


@pytest.mark.parametrize("noise", [0.1, 0.5])
def test_points_that_noise_carries_over_the_end_are_passed_over(noise):
    """The outermost of all lies a standard deviation or more outside: what is taken lies within half of one."""
    assert abs(ends(noise)[0].mean() - END) < 0.5 * noise


def test_an_end_far_inside_counts_as_uncertain_as_it_lies_inside():
    outside, inside = weight_of_end(np.array([3.0, -3.0]), np.full(2, 0.1), 1.0)
    assert outside == pytest.approx(100.0) and inside == pytest.approx(100.0 / (1 + 3.0**2))
