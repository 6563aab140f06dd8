# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page on performance is generated, not written."""
from __future__ import annotations

import json

import pytest

from ffds_workbench.benchmark import summary
from ffds_workbench.errors import InputError


def test_section_replaces_what_stands_between_the_marks(tmp_path):
    further = {"from_100k_to_1m": 50.0, "from_1m_to_5m": 60.0, "ratio": 1.2}
    last = {"points": 5_000_000, "ffds": 0.3, "robust": 0.5, "kdtree": 2.5, "read": 0.005, "ffds_mb": 300,
            "robust_mb": 500}
    data = {"points": [last],
            "ns_per_further_point": dict.fromkeys(("ffds", "robust", "kdtree", "read"), further)}
    (tmp_path / "scaling.json").write_text(json.dumps(data))
    page = tmp_path / "page.md"
    page.write_text(f"before\n{summary.START}\nold\n{summary.END}\nafter\n")
    text = summary.run(tmp_path, lambda stage: None, page)
    assert "./ffds benchmark scaling" in text and "Not measured for this summary: accuracy, paper, peers" in text
    whole = page.read_text()
    assert "old" not in whole and "| ffds | 300 | 60.0 | 1.20 | 300 |" in whole
    assert whole.startswith("before\n") and whole.endswith("\nafter\n")


def test_whole_parts_by_what_the_scan_shows():
    def case(kind, mean):
        return {"kind": kind, **{place: {"mean": mean} for place in ("visible", "hidden", "edges")}}

    cases = [case("clean", 0.004), case("clean", 0.005), case("clean", 0.009), case("one-view", 0.006),
             {"kind": "one-view", "refused": "nothing tells the skin"}]
    bands = {"white/observed": {"places": 10, "share": 0.954}, "dirty/carried": {"places": 10, "share": 0.98}}
    text = summary.section({"accuracy": {"cases": cases, "bands": bands}})
    assert "| all views | 3 | 0.0050 (0.009) |" in text and "| one view | 1, 1 refused | 0.0060 (0.006) |" in text
    assert "observed 95 %" in text and "carried 98 %" in text


def test_without_figures_it_says_what_to_run(tmp_path):
    with pytest.raises(InputError, match="benchmark accuracy"):
        summary.run(tmp_path, lambda stage: None)
