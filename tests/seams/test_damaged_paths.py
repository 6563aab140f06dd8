# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whatever a taught path holds, it is carried along or refused in one sentence."""
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ffds_workbench.benchmark.fuzz import mutations, seeds
from ffds_workbench.errors import FfdsError, InputError
from ffds_workbench.seams.taught.carry import carry

hypothesis = pytest.importorskip("hypothesis")
from hypothesis import strategies

SEEDS = seeds.paths()
ALL = [content for contents in SEEDS.values() for content in contents]


def outcome(path: Path, content: bytes, plate) -> str:
    """What is said of a path; carried between equal models, it has finite numbers and stays where it is."""
    path.write_bytes(content)
    out = path.with_name(f"new{path.suffix}")
    try:
        result = carry(plate, plate, path, out)
    except FfdsError as error:
        assert "\n" not in str(error) and len(str(error)) < 300 + 2 * len(str(path))
        return str(error)
    # Numbers are written with six digits, and half of the last one goes for each of three coordinates.
    assert result.largest_shift < 1e-6 * max(1.0, result.poses) and out.stat().st_size
    return ""


@pytest.mark.parametrize("suffix", SEEDS)
def test_damage_of_every_kind(tmp_path, suffix):
    plate = seeds.plate()

    @hypothesis.settings(derandomize=True, deadline=None, database=None, max_examples=80)
    @hypothesis.given(strategies.integers(0, len(SEEDS[suffix]) - 1), strategies.integers(0, 2**32 - 1))
    def check(seed, state):
        damaged = mutations.mutated(SEEDS[suffix][seed], ALL, np.random.default_rng(state))
        outcome(tmp_path / f"Teach{suffix}", damaged, plate)

    for content in SEEDS[suffix]:
        assert outcome(tmp_path / f"Teach{suffix}", content, plate) == ""
    check()


@pytest.mark.parametrize("suffix", SEEDS)
def test_any_text(tmp_path, suffix):
    plate = seeds.plate()

    @hypothesis.settings(derandomize=True, deadline=None, database=None, max_examples=40)
    @hypothesis.given(strategies.binary(max_size=200) | strategies.text(max_size=100).map(str.encode))
    def check(content):
        outcome(tmp_path / f"Teach{suffix}", content, plate)

    check()


@pytest.mark.parametrize(("name", "text", "says"), [
    ("p.src", "DEF p()\nLIN {X 1e308,Y 0,Z 0}\nEND\n", "Line 2 .* without finite numbers"),
    ("p.csv", "x,y,z\n1e308,0,0\n", "without finite numbers"),
    ("p.src", "DEF p()\nLIN {X 1,\n\n" + "Y 2 " * 100 + "}\nEND\n", "Line 2 .* a part of a pose only"),
    ("p.csv", "x,y,z\n1,2,\"" + "3" * 200000 + "\n", "does not end")])
def test_numbers_that_make_no_sense(tmp_path, name, text, says):
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=says) as caught:
        carry(seeds.plate(), seeds.plate(), tmp_path / name, tmp_path / f"new{name[1:]}")
    assert "\n" not in str(caught.value)


def test_rows_that_end_early_are_carried(tmp_path):
    (tmp_path / "p.csv").write_text("x,y,z,note,gap\n20,50,0,a,0.1\n30,50,0\n")
    carry(seeds.plate(), seeds.plate(), tmp_path / "p.csv", tmp_path / "q.csv")
    assert (tmp_path / "q.csv").read_text().splitlines()[1:] == ["20.000000,50.000000,0.000000,a,",
                                                                 "30.000000,50.000000,0.000000"]
