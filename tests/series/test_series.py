# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whole series of small plates: results, refusals, and what becomes of them when processes are killed."""
from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("distributed", reason="series need Dask")

ROOT = Path(__file__).resolve().parents[2]
FACE = ["--face", "Face6", "--workers", "1"]


@pytest.fixture(scope="module")
def scans(plate, tmp_path_factory) -> Path:
    """Four scans of the plate, each a little higher than the one before."""
    folder = tmp_path_factory.mktemp("scans")
    points = np.loadtxt(plate[1])
    for number in range(1, 5):
        np.savetxt(folder / f"part{number}.xyz", points + [0.0, 0.0, 0.1 * number], fmt="%.6f")
    return folder


@pytest.fixture(scope="module")
def finished(plate, scans, tmp_path_factory) -> Path:
    """A series whose client was killed when its first part was there, and that went on."""
    out = tmp_path_factory.mktemp("series") / "out"
    plan = {"items": [{"name": "top", "characteristic": "flatness", "of": "Face6", "tolerance": 1.5}]}
    (out.parent / "plan.json").write_text(json.dumps(plan), "utf-8")
    command = [str(ROOT / "ffds"), "series", str(plate[0]), str(scans), "--out", str(out), *FACE, "--plan",
               str(out.parent / "plan.json")]
    client = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    for _ in range(6000):
        if list(out.glob("*/part.json")) or client.poll() is not None:
            break
        time.sleep(0.02)
    os.kill(client.pid, signal.SIGKILL)
    client.wait()
    first = {path: path.stat().st_mtime_ns for path in out.glob("*/part.json")}
    assert first
    (scans / "part0.xyz").write_text("no scan at all\n")
    done = subprocess.run([*command, "--resume"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 3, done.stderr
    assert all(path.stat().st_mtime_ns == was for path, was in first.items()), "a part was done twice"
    return out


def test_every_part_has_ended_once(finished, check_report):
    record = json.loads((finished / "series.json").read_text("utf-8"))
    check_report(record)
    assert sorted(Path(part["scan"]).name for part in record["parts"]) == [f"part{k}.xyz" for k in range(5)]
    assert {part["name"]: part["exit"] for part in record["parts"]} == {"part0": 2} | dict.fromkeys(
        ["part1", "part2", "part3", "part4"], 0)
    assert all(bool(part["said"]) == bool(part["exit"]) for part in record["parts"])
    for part in record["parts"]:
        if not part["exit"]:
            assert (finished / part["name"] / "as_built.step").is_file()
            assert json.loads(Path(part["report"]).read_text("utf-8"))["topology"]["valid"]
    with sqlite3.connect(finished / "index.sqlite") as index:
        assert index.execute("SELECT count(*), count(exit), sum(exit) FROM parts").fetchone() == (5, 5, 2)
    assert {path.name for path in finished.iterdir()} == {
        *(f"part{k}" for k in range(5)), ".lock", "index.html", "index.sqlite", "mean_field.csv", "parts.csv",
        "places.npz", "series.json"}


def test_the_mean_is_that_of_the_parts(finished):
    """The bump is 1 mm high on parts 0.1, 0.2, 0.3 and 0.4 mm too high; the fit follows it to some hundredths."""
    field = np.genfromtxt(finished / "mean_field.csv", delimiter=",", names=True)
    top = field[(field["z"] == 5.0) & (np.hypot(field["x"] - 30, field["y"] - 20) < 25)]
    truth = 0.25 + np.exp(-((top["x"] - 30) ** 2 + (top["y"] - 20) ** 2) / (2 * 12**2))
    assert len(top) > 30 and np.abs(top["dz"] - truth).max() < 0.05
    mode = json.loads((finished / "series.json").read_text("utf-8"))["modes"][0]
    assert mode["share"] > 0.9
    scores = [mode["scores"][f"part{k}"] for k in range(1, 5)]
    assert np.abs(np.diff(scores)) == pytest.approx(0.7746, abs=0.05)  # of 0.1 to 0.4, over their deviation of 0.129


def test_every_part_is_inspected(finished):
    """The same bump of 1 mm on all of them; without bands (``--face``) nothing is certain."""
    [top] = json.loads((finished / "series.json").read_text("utf-8"))["characteristics"]
    assert list(top["values"]) == ["part1", "part2", "part3", "part4"] and top["verdicts"] == {"undecided": 4}
    assert list(top["values"].values()) == pytest.approx([1.0] * 4, abs=0.05)
    assert top["capability"]["cpk"] > 0
    assert {"index.html", "inspection.csv", "inspection.json"} <= {path.name for path in (finished / "part1").iterdir()}


def test_a_series_is_not_written_over(plate, finished):
    from ffds_workbench import api

    for faces, resume, said in ((["Face6"], False, "--resume"), (["Face5"], True, "other options")):
        with pytest.raises(api.InputError, match=said):
            api.series(plate[0], [plate[1]], finished, faces, resume=resume)


@pytest.mark.parametrize(("arguments", "said"), [
    (["SCAN", "--face", "Face9"], "no Face9"), (["missing.ply"], "does not exist"), ([], "No scan was named"),
    (["SCAN", "--workers", "0"], "0 workers make no sense"), (["SCAN", "--part-seconds", "-1"], "makes no sense"),
    (["--watch", "nowhere"], "does not exist")])
def test_bad_input_is_said_before_anything_is_made(plate, tmp_path, capsys, arguments, said):
    from ffds_workbench.cli.main import command_line
    from ffds_workbench.errors import InputError

    given = [str(plate[1]) if item == "SCAN" else item for item in arguments]
    options = command_line().parse_args(["series", str(plate[0]), *given, "--out", str(tmp_path / "out")])
    with pytest.raises(InputError, match=said):
        options.run(options, lambda text: None)
    assert not (tmp_path / "out").exists()
