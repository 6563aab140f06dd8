# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tools that make up for a spring-back with a formula."""
from __future__ import annotations

import json

import numpy as np
import Part
import pytest

from ffds_workbench import RESOURCES, api
from ffds_workbench.api import certified
from ffds_workbench.benchmark.compensation import Press, iterated
from ffds_workbench.errors import InputError, RefusedError


@pytest.fixture(autouse=True)
def no_boolean_checks(monkeypatch):
    """They go on beside the tests and are judged elsewhere."""
    monkeypatch.setattr(certified, "BOOLEAN_CHECK_SECONDS", 0.05)


@pytest.fixture(scope="module")
def bracket() -> Part.Shape:
    return api.read_model(RESOURCES / "examples" / "bracket.step").shape


def test_trials_converge(bracket):
    rows = iterated(bracket, 2, lambda text: None, spacing=2.0)
    # each trial leaves 15 % of what was off, the part of a change of the tool that springs back: 2 mm, 0.3, 0.045;
    # registration adds 0.05 mm / √(points per shape)
    assert rows[0]["max"] > 1.9
    assert rows[1]["p95"] < 0.16 * rows[0]["p95"] + 0.02
    assert rows[2]["p95"] < 0.16 * rows[1]["p95"] + 0.02


def test_scatter_is_told_from_what_is_common(bracket):
    press = Press(bracket, 1.5, response=0.0)
    bends = np.array([-0.4, 0.4])
    found = api.compensate(bracket, [press.scan(bracket, bend, 3) for bend in bends], isometry="off")
    # the spring-back lifts by s² (2 + bend) mm: its scatter is s² times the standard deviation of the bends, which the
    # ends, s = ±1, feel with all three components of the law: √(1 + 0.2² + 0.1²)
    assert np.concatenate(found.trial.scatter).max() == pytest.approx(bends.std(ddof=1) * 1.02, abs=0.1)
    off = np.abs(press.deviation(found.shape))  # the scatter cancels in the mean of both
    assert np.percentile(off, 95) < 0.04, off.max()  # 0.4 mm of each; 0.05 mm of noise / √(3000 points / 100 shapes)


def test_what_folds_is_named_and_nonsense_refused(bracket):
    press = Press(bracket, 2.0)
    scan = press.scan(bracket, 0.0, 1)
    with pytest.raises(RefusedError, match=r"tool cannot be made: Face\d+ would fold over"):
        api.compensate(bracket, [scan], factor=-60.0)
    with pytest.raises(InputError, match="--previous"):
        api.compensate(bracket, [scan], previous_scans=[scan])


def test_from_the_command_line(ffds, plate, tmp_path):
    done = ffds("compensate", *plate, "--factor", "-0.5", "--out", "t.step", "--report", "t.json")
    assert done.returncode == 0, done.stderr
    tool = Part.read(str(tmp_path / "t.step"))
    report = json.loads((tmp_path / "t.json").read_text())
    assert report["compensation"]["parts"] == 1 and report["topology"]["written"]["numbers_kept"]
    # the bump of 1 mm in the middle becomes a hollow of half of it; the registration of a 60 mm plate finds it to 0.03
    below = tool.Faces[5].distToShape(Part.Vertex(30, 20, 4.5))[0]
    assert below < 0.05
