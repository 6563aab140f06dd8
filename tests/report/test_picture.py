# SPDX-License-Identifier: LGPL-2.1-or-later
"""The picture and the figures beside it."""
from __future__ import annotations

import matplotlib
import numpy as np
import pytest
from matplotlib.image import imread

from ffds_workbench.report.picture import Panel, draw, viewing_axes
from ffds_workbench.report.statistics import statistics


def test_figures_of_known_deviations():
    figures = statistics(np.array([-3.0, 1.0, 2.0]))
    assert figures is not None
    assert figures.as_dict() == pytest.approx({"mean": 2.0, "rms": np.sqrt(14 / 3), "p95": 2.9, "max": 3.0,
                                               "signed_mean": 0.0})
    assert statistics(np.empty(0)) is None


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (0, 0, 0)])
def test_the_view_is_orthonormal_and_on_the_scanned_side(direction):
    view = viewing_axes(np.array([direction, direction], dtype=float))
    np.testing.assert_allclose(view @ view.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(view) == pytest.approx(1)
    assert view[2] @ np.array(direction) > 0.8 or not any(direction)


@pytest.mark.parametrize("panels", [1, 2])
@pytest.mark.parametrize("spread", [0.0, 1e-9, 0.3, 1e4])
def test_any_size_of_deviation_is_drawn(tmp_path, monkeypatch, panels, spread):
    monkeypatch.setitem(matplotlib.rcParams, "axes.grid", True)  # as many a user has it, and the benchmarks' pages
    random = np.random.default_rng(0)
    points = random.uniform(0, 10, (200, 3))
    up, deviations = np.tile([0.0, 0.0, 1.0], (200, 1)), spread * random.normal(size=200)
    states = [Panel("State", points[k:], up[k:], deviations[k:], [points[:5]]) for k in range(panels)]
    draw(tmp_path / "p.png", "Title", states)
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    margin = imread(tmp_path / "p.png")[:, -5:]
    assert (margin == margin[0, 0]).all()  # the legend's words end before the picture does
