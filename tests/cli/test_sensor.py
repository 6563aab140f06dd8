# SPDX-License-Identifier: LGPL-2.1-or-later
"""``./ffds sensor measure``, and ``register --sensor`` with what it wrote."""
from __future__ import annotations

import json

import numpy as np


def test_measure_and_use(ffds, plate, tmp_path):
    model, scan = plate
    random = np.random.default_rng(1)
    flat = np.column_stack([random.uniform((0, 0), (60, 40), (8000, 2)), random.normal(0, 0.05, 8000)])
    np.savetxt(tmp_path / "flat.xyz", flat, fmt="%.6f")
    done = ffds("sensor", "measure", "--flat", "flat.xyz", "--out", "p.json", "--name", "mine")
    assert done.returncode == 0 and "mine: white noise 0.0" in done.stdout
    profile = json.loads((tmp_path / "p.json").read_text())
    assert abs(profile["sigma"] - 0.05) < 4 * 0.05 / np.sqrt(2 * 8000) and profile["sigma_c"] == 0
    for name in ("p.json", "structured-light"):
        done = ffds("register", model, scan, "--out", "x.step", "--report", "r.json", "--sensor", name)
        assert done.returncode == 0, done.stderr
        sensor = json.loads((tmp_path / "r.json").read_text())["scan"]["sensor"]
        assert sensor["name"] == ("mine" if name == "p.json" else name)


def test_errors_are_one_sentence(ffds, plate):
    model, scan = plate
    job = ("register", model, scan, "--out", "x.step", "--sensor")
    for arguments, word in ((("sensor", "measure", scan, "--out", "p.txt"), ".json"),
                            (("sensor", "measure", "none.ply", "--out", "p.json"), "does not exist"),
                            ((*job, "none"), "does not exist"), ((*job, "paper", "--face", "Face6"), "whole part")):
        done = ffds(*arguments)
        assert done.returncode == 2 and word in done.stderr and len(done.stderr.splitlines()) == 1
