# SPDX-License-Identifier: LGPL-2.1-or-later
"""The accuracy and speed benchmarks write their tables; their figures are those of single runs."""
import json

from ffds_workbench.benchmark import accuracy, speed, speed_whole
from ffds_workbench.benchmark.accuracy_study import accuracy_cases
from ffds_workbench.benchmark.accuracy_study.accuracy_lines import lines
from ffds_workbench.benchmark.simulated.parts import FAMILIES


def test_accuracy(tmp_path, monkeypatch):
    monkeypatch.setattr(accuracy_cases, "CASES", tmp_path / "absent")
    text = accuracy.run(tmp_path, lambda message: None, seeds=0, sheets={"A": 1, "D": 2})
    data = json.loads((tmp_path / "accuracy.json").read_text())
    assert data["sheet"]["A"]["robust"]["mean"] < 0.01 < data["sheet"]["A"]["ffds"]["mean"]
    assert "| A: noise alone" in text and "| Sheet D, p95" in text


def test_family_cases_are_spread():
    names = accuracy_cases.family_cases(24)
    assert len({seed for _, _, seed, _ in names}) == 24
    assert {family for family, *_ in names} == set(FAMILIES)
    for family in FAMILIES:
        own = [name for name in names if name[0] == family]
        assert len({warp for _, warp, _, _ in own}) == 4 and len({kind for *_, kind in own}) >= 2


def test_a_case_without_the_judge(tmp_path, monkeypatch):
    """The truth's own points judge where evaluate.py is absent; the line is that of the family, the bands' is loose."""
    monkeypatch.setattr(accuracy_cases, "SHARED", tmp_path / "absent")
    row = accuracy_cases.run_case(("free-form-panel", "twist", 1, "clean"))
    assert row["judge"] == "truth" and row["topology"]
    assert row["visible"]["mean"] < 0.008 and row["edges"]["mean"] < 0.1
    observed = row["bands"]["observed"]
    assert observed["held"] > 0.85 * observed["places"]


def test_lines():
    """Counts are pooled over the cases, not shares averaged; what is over its line is not met."""
    def row(case: str, mean: float, held: int) -> dict:
        block = {"mean": mean, "p95": 2 * mean, "max": 3 * mean}
        flags = {flag: {"places": 100, "held": held} for flag in accuracy_cases.FLAGS}
        return {"case": case, "family": case.split("-")[0], "kind": "white", "visible": block, "hidden": block,
                "edges": block, "thickness": block, "gap": 0.0, "tolerance": 1e-5, "topology": True, "certificate": [],
                "bands": flags}

    found = {line.what: line for line in lines({}, [row("b-mix", 0.0065, 94), row("e-twist", 0.0065, 98)])}
    assert found["b-mix, visible, mm"].met and not found["e-twist, visible, mm"].met
    observed = found["95 % bands, observed, white noise"]
    assert observed.found == 0.96 and observed.met


def test_a_guess_where_nothing_tells_the_skin_has_to_say_so():
    def line(what: str, *rows: dict) -> bool:
        return next(item for item in lines({}, rows) if what in item.what).met

    name = "/".join(map(str, accuracy_cases.WITHOUT_NORMALS))
    untold = {"case": name, "family": "free-form-panel", "kind": "one-view"}
    assert not line("though their scans tell enough", {**untold, "refused": "The scan shows one skin."})
    wrong = {**untold, "visible": {"mean": 1.7}, "gap": 0.0, "tolerance": 0.0, "topology": True, "certificate": []}
    assert not line("on the wrong one", wrong | {"unsure": 0.0}) and line("on the wrong one", wrong | {"unsure": 2.0})


def test_speed(tmp_path):
    text = speed.run(tmp_path, lambda message: None, sizes=(20_000, 40_000), repeats=2)
    assert "robust, cylinder" in text
    assert json.loads((tmp_path / "speed.json").read_text())["builds"]["k-d tree"]["builds"] == 1.0


def test_speed_of_a_whole_part(monkeypatch):
    monkeypatch.setattr(speed_whole, "_STARTS", 1)
    data = speed_whole.measure(lambda message: None, sizes=(10_000,), faces=(1, 4), repeats=1)
    row = data["sizes"][0]
    assert row["points"] == 10_000
    assert 0 < row["written"] < row["ended"] and row["peak_megabytes"] > 50
    assert [len(table.rows) for table in speed_whole.section(data).tables] == [1, 2]
