# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plans, verdicts and the command, on a plate as it is and with errors that are known."""
from __future__ import annotations

import csv
import json

import numpy as np
import Part
import pytest

from ffds_workbench.errors import InputError
from ffds_workbench.inspection.inspect import _verdict
from ffds_workbench.inspection.plan import CHARACTERISTICS, plan_of
from ffds_workbench.inspection.zones import least_tube, least_zone

FLAT = {"name": "top", "characteristic": "flatness", "of": "Face6", "tolerance": 0.1}


@pytest.mark.parametrize(("change", "said"), [
    ({"characteristic": "roundish"}, "unknown: use one of"), ({"of": ["Face1", "Face2"]}, "is of 1 face"),
    ({"tolerance": 0}, "above 0"), ({"tolerance": None}, "above 0"), ({"tolerance": "thin"}, "no number"),
    ({"datums": ["A"]}, "no datum A"), ({"limit": 1}, "'limit' is unknown"), ({"of": 6}, "name or a list"),
    ({"characteristic": "distance"}, "is of 2 faces"), ({"condition": "mmc"}, "need a 'size'"),
    ({"characteristic": "parallelism"}, "needs a datum"),
    ({"characteristic": "diameter", "tolerance": None}, "needs a 'tolerance'"),
    ({"characteristic": "diameter", "tolerance": None, "lower": 1, "upper": -1}, "'lower' is above"),
    ({"condition": "mmc", "size": 1}, "is for positions")])
def test_what_is_no_plan(change, said):
    with pytest.raises(InputError, match=said):
        plan_of({"items": [{key: value for key, value in {**FLAT, **change}.items() if value is not None}]})


@pytest.mark.parametrize("record", [None, [], {}, {"items": []}, {"items": [1]}, {"datums": 3, "items": [FLAT]}])
def test_what_is_nothing_like_a_plan(record):
    with pytest.raises(InputError):
        plan_of(record)


def test_the_schema_takes_what_is_read(shared_schema):
    shared_schema({"datums": {"A": "Face1"}, "items": [FLAT]})
    assert set(shared_schema.kinds) == set(CHARACTERISTICS)


@pytest.fixture
def shared_schema():
    """Checks a plan against the schema of the documentation."""
    jsonschema = pytest.importorskip("jsonschema")
    from ffds_workbench import RESOURCES

    schema = json.loads((RESOURCES / "docs" / "inspection_plan.schema.json").read_text("utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)

    def check(plan):
        jsonschema.Draft202012Validator(schema).validate(plan)

    check.kinds = schema["$defs"]["item"]["properties"]["characteristic"]["enum"]
    return check


@pytest.mark.parametrize(("low", "high", "verdict"), [(0.5, 0.9, "pass"), (0.5, 1.1, "undecided"), (1.1, 1.2, "fail"),
                                                      (-0.5, 0.5, "undecided"), (-0.5, -0.1, "fail"),
                                                      (-0.5, 1.5, "undecided")])
def test_verdicts(low, high, verdict):
    """ISO 14253-1: only what is certain is said, between 0 and 1."""
    assert _verdict(np.array([[low, high]] * 3), 0.0, 1.0) == verdict


def test_local_values_decide():
    """The mean keeps both limits; the lowest value breaks one."""
    intervals = np.array([[0.4, 0.6], [-0.3, -0.1], [0.8, 0.9]])
    assert _verdict(intervals, 0.0, 1.0) == "fail" and _verdict(intervals, None, 1.0) == "pass"


def test_zones_of_random_points_are_no_wider_than_any_other():
    """The minimum is not above 200 zones that are drawn around it, and its motion gives its width."""
    random = np.random.default_rng(0)
    residual, jacobian = random.standard_normal(500), random.standard_normal((500, 3))
    for mode, width in (("width", np.ptp), ("symmetric", lambda r: 2 * np.abs(r).max())):
        least, motion = least_zone(residual, jacobian, mode)
        assert width(residual + jacobian @ motion) == pytest.approx(least, abs=1e-8)
        others = motion + 0.1 * random.standard_normal((200, 3))
        assert min(width(residual + jacobian @ other) for other in others) >= least - 1e-9
    least, motion = least_zone(residual, np.hstack([jacobian, np.ones((500, 1))]), "contact")
    assert (residual + np.hstack([jacobian, np.ones((500, 1))]) @ motion).max() == pytest.approx(0.0, abs=1e-8)
    vectors, change = random.standard_normal((300, 3)), random.standard_normal((300, 3, 4))
    least, motion = least_tube(vectors, change)
    assert 2 * np.linalg.norm(vectors + change @ motion, axis=1).max() == pytest.approx(least, abs=1e-7)
    others = motion + 0.1 * random.standard_normal((200, 4))
    assert min(2 * np.linalg.norm(vectors + change @ other, axis=1).max() for other in others) >= least - 1e-9


@pytest.fixture(scope="module")
def files(plate, tmp_path_factory):
    """An as-built plate, 0.2 mm thicker, a report that knows some faces, and a plan."""
    folder = tmp_path_factory.mktemp("inspect")
    Part.makeBox(60, 40, 5.2).exportStep(str(folder / "as_built.step"))
    faces = [{"name": f"Face{k}", "lattice": [5, 5], "band": 0.01 if k > 4 else None} for k in range(1, 7)]
    (folder / "report.json").write_text(json.dumps({"faces": faces}), "utf-8")
    plan = {"items": [{"name": "thick", "characteristic": "distance", "of": ["Face5", "Face6"], "tolerance": 0.3},
                      {"name": "close", "characteristic": "distance", "of": ["Face5", "Face6"], "upper": 0.2},
                      {**FLAT, "name": "flat"}, {**FLAT, "name": "unseen", "of": "Face1"}]}
    (folder / "plan.json").write_text(json.dumps(plan), "utf-8")
    return plate[0], folder


def test_the_command(plate, files, ffds, tmp_path):
    """A scan is registered first; the bump is 1 mm high, and the top alone is seen."""
    model, folder = files
    plan = {"items": [{**FLAT, "name": "flat"}, {**FLAT, "name": "unseen", "of": "Face1"}]}
    (tmp_path / "plan.json").write_text(json.dumps(plan), "utf-8")
    done = ffds("inspect", model, plate[1], "--plan", "plan.json", "--out", "out")
    assert done.returncode == 0, done.stderr
    flat, unseen = json.loads((tmp_path / "out" / "inspection.json").read_text("utf-8"))["items"]
    assert flat["interval"][0] < 1.0 < flat["interval"][1] and flat["verdict"] == "fail"
    assert "The part: fail" in done.stdout
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"as_built.step", "report.json", "inspection.json",
                                                                    "inspection.csv", "index.html"}


def test_values_bands_and_verdicts(files, tmp_path):
    """Two planes known to 0.01 mm at every place: their distance is known to 0.014 mm at worst, where the places of
    each err together, and better where they do not."""
    from ffds_workbench import api

    model, folder = files
    report = json.loads((folder / "report.json").read_text("utf-8"))
    found = api.inspect_model(model, folder / "as_built.step", folder / "plan.json", report)
    thick, close, flat, unseen = found.inspection.items
    assert thick.value == pytest.approx(5.2) and thick.nominal == pytest.approx(5.0) and thick.verdict == "pass"
    assert 0.003 < thick.band < 0.0145
    assert close.verdict == "undecided" and "Face" in close.advice
    assert flat.value == pytest.approx(0.0, abs=1e-9) and flat.interval[0] == 0.0 and flat.verdict == "pass"
    assert unseen.verdict == "undecided" and unseen.band is None and "Face1 was not measured" in unseen.advice
    api.write_inspected(found, tmp_path)
    rows = list(csv.DictReader((tmp_path / "inspection.csv").open(encoding="utf-8")))
    assert [row["verdict"] for row in rows] == ["pass", "undecided", "pass", "undecided"]
    assert json.loads((tmp_path / "inspection.json").read_text("utf-8"))["verdict"] == "undecided"
    assert "undecided" in (tmp_path / "index.html").read_text("utf-8")
    exact = api.inspect_model(model, folder / "as_built.step", folder / "plan.json").inspection
    assert exact.exact and [item.band for item in exact.items] == pytest.approx([0.0] * 4, abs=1e-12)


@pytest.mark.parametrize(("measured", "said"), [
    (["as_built.step", "as_built.step"], "one as-built model"), (["report.json"], "Name either scans"),
    (["as_built.step", "plan.json", "report.json"], "Name either"), (["as_built.step", "plan.json"], "has no faces")])
def test_what_cannot_be_inspected(files, measured, said):
    from ffds_workbench.cli.main import command_line

    model, folder = files
    options = command_line().parse_args(["inspect", str(model), *(str(folder / name) for name in measured), "--plan",
                                         str(folder / "plan.json"), "--out", str(folder / "out")])
    with pytest.raises(InputError, match=said):
        options.run(options, lambda text: None)


def test_models_that_do_not_go_together(files, tmp_path):
    from ffds_workbench import api

    model, folder = files
    Part.makeCylinder(5, 5).exportStep(str(tmp_path / "other.step"))
    with pytest.raises(InputError, match="6 faces and the as-built one 3"):
        api.inspect_model(model, tmp_path / "other.step", folder / "plan.json")
