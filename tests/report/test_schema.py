# SPDX-License-Identifier: LGPL-2.1-or-later
"""The schema of the reports tells what they hold from what they must not; conftest holds every report against it."""
from __future__ import annotations

import copy

import numpy as np
import pytest

from ffds_workbench.report import record
from ffds_workbench.report.versions import versions

jsonschema = pytest.importorskip("jsonschema", reason="python3-jsonschema is not installed: reports are not checked")

FIGURES = {"mean": 0.1, "rms": 0.1, "p95": 0.2, "max": 0.3, "signed_mean": -0.05}
DEVIATION = {"faces": [{"name": "Face1", "points": 3, "deviation": FIGURES}], "deviation": FIGURES,
             "scan": {"points": 3, "dropped": 0, "noise": None, "unit": "mm"}, "timing": {"total": 1.0},
             "versions": versions()}


def test_versions_are_in_every_report(tmp_path):
    assert set(versions()) == {"ffds", "freecad", "occt", "numpy", "scipy"}
    assert versions()["numpy"] == np.__version__
    with pytest.raises(jsonschema.ValidationError):  # as conftest looks at it: these are no figures
        record.write({"what": "else"}, tmp_path / "r.json")
    assert '"versions"' in (tmp_path / "r.json").read_text()


@pytest.mark.parametrize("place, value", [
    (("versions",), None), (("scan", "points"), -1), (("scan", "unit"), "ft"), (("deviation", "rms"), "0.1"),
    (("faces", 0, "points"), 1.5), (("timing",), {})])
def test_a_report_that_is_none_is_told(check_report, place, value):
    report = copy.deepcopy(DEVIATION)
    check_report(report)
    parent = report
    for key in place[:-1]:
        parent = parent[key]
    if value is None:
        del parent[place[-1]]
    else:
        parent[place[-1]] = value
    with pytest.raises(jsonschema.ValidationError):
        check_report(report)
