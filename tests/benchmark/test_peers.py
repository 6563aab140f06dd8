# SPDX-License-Identifier: LGPL-2.1-or-later
"""The peers' clouds and worker; only what is at hand without installing anything."""
from __future__ import annotations

import numpy as np
import pytest

from ffds_workbench.benchmark import peers
from ffds_workbench.benchmark.paper_study.paper_case import true_distance
from ffds_workbench.benchmark.peer_study import peers_environment
from ffds_workbench.benchmark.simulated.sheet import scan


def test_clouds_are_what_they_say():
    clean, dirty, correlated = (np.random.default_rng(0).permutation(scan(kind, 1)) for kind in peers.CASES)
    assert len(clean) == 42_087 and true_distance(clean[:3000]).max() < 0.8      # 5.5 σ
    for cloud in (dirty, correlated):
        assert 0.86 * 42_087 < len(cloud) < 0.94 * 42_087      # a fifth gone, a tenth of clutter added
        assert 0.08 < np.mean(true_distance(cloud[:3000]) > 1.0) < 0.13


@pytest.mark.parametrize("name", ["robust", "ffds", "spline_fit"])
def test_worker_runs_what_is_at_hand(name):
    done = peers.work(name, peers_environment.here(), scan("A", 1, 5000), 60)
    assert not isinstance(done, str), done
    assert true_distance(done["moved"]).mean() < 0.5 and done["seconds"] > 0 and done["megabytes"] >= 0


def test_a_peer_that_cannot_be_had_is_named(tmp_path):
    (tmp_path / "taken").write_text("a file where the environment should be")
    missing = peers_environment.make(tmp_path / "taken", "", "no_such_module_of_ours")
    assert missing.python is None and "environment" in missing.missing
    assert isinstance(peers.work("no_such_method", peers_environment.here(), np.zeros((10, 3)), 30), str)
